//! How good layouts are: errors over the number of markers, in simulated takes of people and takes that the
//! layouts were not made for.

use std::sync::Arc;

use mimique_solver::MethodSpec;
use rayon::prelude::*;
use serde::Serialize;

use crate::error::LayoutError;
use crate::face::{Face, FacePart};
use crate::motion::{FaceMotion, PersonMotion};
use crate::progress::Progress;
use crate::rehearsal::{BankSolver, Conditions, Effort, Rehearsal, VertexGroup};

/// Blocks that a single take is cut into.
const BLOCKS: usize = 5;

/// What layouts are made for, and what they are judged by.
#[derive(Debug, Clone)]
pub struct Fold {
    /// What is left out: a take's name, or a part of it.
    pub name: String,
    /// The motion that layouts are made for, and that a regression learns from.
    pub learnt: FaceMotion,
    /// The motion that they are judged by.
    pub played: FaceMotion,
}

/// The folds of a motion: each take is left out in turn; a single one is cut into five blocks; where no motion
/// is known, other faces are drawn than those that layouts are made for.
pub fn folds(motion: &FaceMotion) -> Vec<Fold> {
    let with = |people: Vec<PersonMotion>| FaceMotion { people, ..motion.clone() };
    match &motion.people[..] {
        [] => vec![Fold {
            name: "independent shapes".to_owned(),
            learnt: motion.clone(),
            played: motion.clone(),
        }],
        [only] => {
            let frames = only.frames.len() / motion.basis.width;
            let border = |block: usize| block * frames / BLOCKS;
            let part = |from: usize, to: usize| only.part(from..to, motion.basis.width);
            (0..BLOCKS.min(frames))
                .map(|block| {
                    let (from, to) = (border(block), border(block + 1));
                    Fold {
                        name: format!("{}, frames {from} to {}", only.name, to.saturating_sub(1)),
                        learnt: with(vec![part(0, from).and(&part(to, frames))]),
                        played: with(vec![part(from, to)]),
                    }
                })
                .collect()
        }
        several => (0..several.len())
            .map(|out| {
                let mut rest = several.to_vec();
                let played = vec![rest.remove(out)];
                Fold { name: several[out].name.clone(), learnt: with(rest), played: with(played) }
            })
            .collect(),
    }
}

/// The setting of a judgement: a solver and what goes wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// The method, its parameters and smoothing.
    pub solver: MethodSpec,
    /// Noise and slip.
    pub conditions: Conditions,
}

/// The errors of a layout, millimetres.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Errors {
    /// Root mean square error of a vertex.
    pub per_vertex_mm: f64,
    /// Eq. 3.5 as it is printed: the sum over the vertices, not their mean.
    pub as_printed_mm: f64,
    /// 95 % of the frames are below this error of a vertex.
    pub of_95_percent_mm: f64,
    /// The part of the face with the largest error, and that error.
    pub worst_part: FacePart,
    /// See `worst_part`.
    pub worst_part_mm: f64,
    /// The error of the best and of the worst fold.
    pub folds_mm: [f64; 2],
}

/// Judges layouts by folds: rehearsals are set up once for each fold and trial.
pub struct Judge<'a> {
    face: &'a Face<'a>,
    folds: &'a [Fold],
    parts: Vec<FacePart>,
    /// All vertices, then those of each part.
    groups: Vec<VertexGroup>,
    seed: u64,
    effort: Effort,
}

impl<'a> Judge<'a> {
    /// Of a face and the folds of its motion.
    pub fn new(face: &'a Face<'a>, folds: &'a [Fold], effort: Effort, seed: u64) -> Self {
        let (mut parts, mut groups) = (Vec::new(), Vec::new());
        if let Some(fold) = folds.first() {
            let basis = &fold.played.basis;
            groups.push(VertexGroup::whole(basis));
            let moved = |v: &usize| face.reach[*v] >= crate::candidates::MOVED_M;
            let vertices: Vec<usize> = (0..face.skin.mesh.positions.len()).filter(moved).collect();
            for part in FacePart::ALL {
                let own: Vec<usize> =
                    vertices.iter().copied().filter(|&v| face.part(v) == part).collect();
                if !own.is_empty() {
                    parts.push(part);
                    groups.push(VertexGroup::of(basis, own));
                }
            }
        }
        Self { face, folds, parts, groups, seed, effort }
    }

    /// The errors of layouts under a trial: for each layout its vertices in each fold. None where a layout
    /// cannot be solved.
    pub fn errors(
        &self,
        trial: &Trial,
        layouts: &[Vec<&[usize]>],
        progress: &dyn Progress,
    ) -> Vec<Option<Errors>> {
        let solver = Arc::new(BankSolver::new(self.face, &trial.solver));
        let rehearsals: Vec<Rehearsal<'_>> = (self.folds.iter())
            .map(|fold| {
                Rehearsal::with_solver(
                    self.face,
                    &fold.played,
                    Some(&fold.learnt),
                    solver.clone(),
                    trial.conditions,
                    self.effort,
                    // Other hands and other noise than those that layouts are sought with.
                    self.seed ^ 0x006a_7564_6765,
                )
            })
            .collect();
        layouts
            .par_iter()
            .map(|by_fold| {
                let squares = self.squares(&rehearsals, by_fold);
                progress.step();
                squares.ok().map(|squares| self.summary(&squares))
            })
            .collect()
    }

    /// The squares of a layout in all folds; a regression's kernel is found in the first.
    fn squares(
        &self,
        rehearsals: &[Rehearsal<'_>],
        by_fold: &[&[usize]],
    ) -> Result<Vec<Vec<Vec<f64>>>, LayoutError> {
        let first = rehearsals.iter().zip(by_fold).next();
        let kernel = first.map_or(Ok(None), |(rehearsal, markers)| rehearsal.kernel(markers))?;
        rehearsals
            .iter()
            .zip(by_fold)
            .map(|(rehearsal, markers)| rehearsal.square_errors_with(markers, &self.groups, kernel))
            .collect()
    }

    /// Errors over the frames of all folds: for each fold, for each group, a number for each frame.
    fn summary(&self, squares: &[Vec<Vec<f64>>]) -> Errors {
        let basis = &self.folds[0].played.basis;
        let root = |squares: &[f64]| {
            1e3 * (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
        };
        let by_fold: Vec<&[f64]> = squares.iter().map(|groups| groups[0].as_slice()).collect();
        let all = by_fold.concat();
        let mut sorted = all.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let at = (0.95 * (sorted.len().max(1) - 1) as f64).round() as usize;
        let of_part = |g: usize| {
            root(&squares.iter().flat_map(|groups| &groups[g]).copied().collect::<Vec<f64>>())
        };
        let worst = (self.parts.iter().enumerate())
            .map(|(place, part)| (*part, of_part(place + 1)))
            .reduce(|worst, next| if next.1 > worst.1 { next } else { worst })
            .unwrap_or((FacePart::Mouth, 0.0));
        let per_vertex = root(&all);
        let of_folds: Vec<f64> = by_fold.iter().map(|squares| root(squares)).collect();
        Errors {
            per_vertex_mm: per_vertex,
            as_printed_mm: per_vertex * (basis.vertices() as f64).sqrt(),
            of_95_percent_mm: 1e3 * sorted.get(at).copied().unwrap_or(0.0).sqrt(),
            worst_part: worst.0,
            worst_part_mm: worst.1,
            folds_mm: [
                of_folds.iter().copied().fold(f64::INFINITY, f64::min),
                of_folds.iter().copied().fold(0.0, f64::max),
            ],
        }
    }
}

/// The least number of markers whose error is within a tenth of the least of all; the first of `(markers, error)`
/// that is.
pub fn enough(curve: &[(usize, f64)]) -> Option<usize> {
    let least = curve.iter().map(|(_, error)| *error).fold(f64::INFINITY, f64::min);
    enough_for(curve, 1.1 * least)
}

/// The least number of markers whose error is at most that wanted.
pub fn enough_for(curve: &[(usize, f64)], wanted: f64) -> Option<usize> {
    curve.iter().filter(|(_, error)| *error <= wanted).map(|(markers, _)| *markers).min()
}
