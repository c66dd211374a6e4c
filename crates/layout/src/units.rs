//! Markers that are chosen together: one, or a vertex and its mirror image.

use mimique_solver::{StandsFor, stands_for_pairs};

use crate::candidates::Candidates;
use crate::error::LayoutError;
use crate::face::{Face, PARTNER_M};
use crate::spacing::Spacing;

/// The share of allowed vertices that may have no partner on a symmetric face.
const WITHOUT_PARTNER: f64 = 0.1;

/// What may be chosen, and what must not stand together.
#[derive(Debug, Clone)]
pub struct Units<'a> {
    /// The face.
    pub face: &'a Face<'a>,
    /// The distances that markers keep.
    pub spacing: Spacing<'a>,
    /// Whether markers come in pairs.
    pub symmetric: bool,
    /// Vertices that have a marker already and keep it.
    pub kept: Vec<usize>,
    /// The vertices of each unit, its own first; those of the middle are alone.
    pub each: Vec<Vec<usize>>,
    /// The allowed vertices, ascending.
    pub allowed: Vec<usize>,
}

impl<'a> Units<'a> {
    /// Of the candidates of a face. Units that come too near to kept markers, or to themselves, are left out.
    ///
    /// # Errors
    /// [`LayoutError`]: no candidate, a face that is not symmetric.
    pub fn of(
        face: &'a Face<'a>,
        candidates: &Candidates,
        spacing: Spacing<'a>,
        symmetric: bool,
        kept: &[usize],
    ) -> Result<Self, LayoutError> {
        let counts = candidates.counts;
        if counts.moved == 0 {
            return Err(LayoutError::NoMotion);
        }
        if candidates.vertices.is_empty() {
            let (moved, seen, named) = (counts.moved, counts.seen, counts.named);
            return Err(LayoutError::EmptyRegion { moved, seen, named });
        }
        let allowed = candidates.vertices.clone();
        let is_allowed = |v: usize| allowed.binary_search(&v).is_ok();
        let mirror = &face.mirror;
        if symmetric {
            let alone = |v: &&usize| !mirror.has_partner(**v);
            let (without, of) = (allowed.iter().filter(alone).count(), allowed.len());
            if without as f64 > WITHOUT_PARTNER * of as f64 {
                return Err(LayoutError::Asymmetric { without, of, millimetres: 1e3 * PARTNER_M });
            }
        }
        let unit = |&v: &usize| -> Option<Vec<usize>> {
            if !symmetric || mirror.from_middle[v] == 0.0 {
                return Some(vec![v]);
            }
            let other = mirror.of[v];
            let left = mirror.from_middle[v] > 0.0;
            (left && is_allowed(other) && mirror.has_partner(v)).then(|| vec![v, other])
        };
        let mut each: Vec<Vec<usize>> = allowed.iter().filter_map(unit).collect();
        each.retain(|unit| {
            let itself = unit.len() < 2 || spacing.apart(unit[0], unit[1]);
            itself && unit.iter().all(|&v| spacing.apart_from_all(v, kept))
        });
        Ok(Self { face, spacing, symmetric, kept: kept.to_vec(), each, allowed })
    }

    /// Whether a unit may stand beside vertices that are chosen.
    pub fn fits(&self, unit: &[usize], chosen: &[usize]) -> bool {
        unit.iter().all(|&v| self.spacing.apart_from_all(v, chosen))
    }

    /// How many more markers a layout of `count` needs beside those that are kept.
    ///
    /// # Errors
    /// [`LayoutError::Kept`] where more are kept.
    pub fn wanted(&self, count: usize) -> Result<usize, LayoutError> {
        count.checked_sub(self.kept.len()).ok_or_else(|| LayoutError::Kept {
            what: format!(
                "{} markers are kept where {count} are wanted; ask for more, or take --method reduce",
                self.kept.len()
            ),
        })
    }

    /// What the vertices of the half that is clustered stand for (all of them where markers are single), with
    /// the vertices.
    pub fn clustered(&self) -> (Vec<usize>, Vec<StandsFor>) {
        let mirror = &self.face.mirror;
        let offered = |stands_for: &StandsFor| {
            let vertices = stands_for.vertices();
            let whole = vertices.iter().all(|v| self.allowed.binary_search(v).is_ok());
            whole && vertices.iter().all(|&v| self.spacing.apart_from_all(v, &self.kept))
        };
        let kept = |stands_for: StandsFor| match offered(&stands_for) {
            true => stands_for,
            false => StandsFor::Nothing,
        };
        if !self.symmetric {
            let vertices = self.allowed.clone();
            let each = vertices.iter().map(|&v| kept(StandsFor::One(v))).collect();
            return (vertices, each);
        }
        let paired = |v: &usize| {
            mirror.from_middle[*v] == 0.0
                || mirror.has_partner(*v) && self.allowed.binary_search(&mirror.of[*v]).is_ok()
        };
        let half: Vec<usize> = (self.allowed.iter().copied())
            .filter(|&v| mirror.from_middle[v] >= 0.0)
            .filter(paired)
            .collect();
        let positions = &self.face.skin.mesh.positions;
        let minimum = self.spacing.minimum();
        let each = stands_for_pairs(&half, positions, &mirror.from_middle, &mirror.of, minimum);
        let each = each.into_iter().map(kept).collect();
        (half, each)
    }

    /// Exactly `count` markers of units in their order: the last ones go, and where a single marker is missing
    /// or units are, the free unit that is farthest from all others comes. Where what was chosen stands in the
    /// way of so many, the last of it make room for markers packed closely.
    ///
    /// # Errors
    /// [`LayoutError::TooMany`] where so many do not fit.
    pub fn exactly(
        &self,
        mut chosen: Vec<Vec<usize>>,
        count: usize,
    ) -> Result<Vec<Vec<usize>>, LayoutError> {
        let wanted = self.wanted(count)?;
        let mut dropped: Vec<Vec<usize>> = Vec::new();
        // Clusters keep their markers apart on one side of the face; their mirror images may come nearer.
        let mut taken = self.kept.clone();
        chosen.retain(|unit| {
            let fits = self.fits(unit, &taken);
            taken.extend(unit.iter().filter(|_| fits));
            fits
        });
        while markers(&chosen) > wanted {
            dropped.extend(chosen.pop());
        }
        let first = chosen.clone();
        while markers(&chosen) < wanted {
            let room = wanted - markers(&chosen);
            let taken: Vec<usize> = chosen.iter().flatten().chain(&self.kept).copied().collect();
            let again = dropped.iter().position(|u| u.len() <= room && self.fits(u, &taken));
            match again {
                // A single one in the middle takes the place of half a pair.
                Some(place) => chosen.push(dropped.remove(place)),
                None => match self.farthest_from(&taken, room) {
                    Some(unit) => chosen.push(unit.clone()),
                    None => return self.packed(first, count),
                },
            }
        }
        Ok(chosen)
    }

    /// The free unit of at most `room` markers that is farthest from all that are taken, the first of equal ones.
    fn farthest_from(&self, taken: &[usize], room: usize) -> Option<&Vec<usize>> {
        let near = |v: usize| {
            let far = |t: &usize| (self.face.place(v) - self.face.place(*t)).length();
            taken.iter().map(far).fold(f64::INFINITY, f64::min)
        };
        let distance =
            |unit: &Vec<usize>| unit.iter().map(|&v| near(v)).fold(f64::INFINITY, f64::min);
        self.each
            .iter()
            .filter(|u| u.len() <= room && self.fits(u, taken))
            .map(|unit| (distance(unit), unit))
            .reduce(|best, next| if next.0 > best.0 { next } else { best })
            .map(|(_, unit)| unit)
    }

    /// As many of the first units as may stay, and the others packed: the first free one in the order of the
    /// vertices, then the next.
    fn packed(
        &self,
        chosen: Vec<Vec<usize>>,
        count: usize,
    ) -> Result<Vec<Vec<usize>>, LayoutError> {
        let wanted = self.wanted(count)?;
        let mut most = 0;
        for keep in [3, 2, 1, 0].map(|quarters| quarters * chosen.len() / 4) {
            let mut units = chosen[..keep].to_vec();
            let mut taken: Vec<usize> = units.iter().flatten().chain(&self.kept).copied().collect();
            for unit in &self.each {
                let room = wanted - markers(&units);
                if unit.len() <= room && self.fits(unit, &taken) {
                    taken.extend(unit);
                    units.push(unit.clone());
                }
            }
            if markers(&units) == wanted {
                return Ok(units);
            }
            most = most.max(taken.len());
        }
        let millimetres = (1e4 * self.spacing.minimum()).round() / 10.0;
        Err(LayoutError::TooMany { fit: most, wanted: count, millimetres })
    }
}

/// The markers of some units.
fn markers(units: &[Vec<usize>]) -> usize {
    units.iter().map(Vec::len).sum()
}
