//! A method's task, and what it answers.

use std::fmt;
use std::str::FromStr;

use mimique_solver::{
    Criterion, OperatorOptions, PivotedQr, SurfaceGreedy, farthest_first, motion_rows,
};
use serde::Serialize;

use super::{clusters, greedy, reduce, rehearse};
use crate::error::LayoutError;
use crate::motion::FaceMotion;
use crate::progress::Progress;
use crate::rehearsal::Rehearsal;
use crate::units::Units;

/// How places are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Layouts tried in simulated takes.
    Rehearse,
    /// A vertex for each cluster of trajectories (thesis 3.6).
    Kmeans,
    /// One after the other, each where it lowers the expected error most.
    Greedy,
    /// Pivoted QR of the modes of the motion.
    Qr,
    /// One after the other, each where the thin-shell surface is farthest off.
    Shell,
    /// One after the other, each where the nearest marker is farthest.
    Farthest,
    /// A given layout without the markers that are missed least (thesis 3.5.2).
    Reduce,
}

/// What a method is to do.
pub struct Task<'t, 'a> {
    /// What may be chosen.
    pub units: &'t Units<'a>,
    /// The motion that the layout is for.
    pub motion: &'t FaceMotion,
    /// Simulated takes, for the methods that try layouts.
    pub rehearsal: &'t Rehearsal<'a>,
    /// Standard deviations of sensor noise and of a marker's place, metres.
    pub noise: f64,
    /// See `noise`.
    pub slip: f64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Told of every step.
    pub progress: &'t dyn Progress,
}

/// Markers in the order in which they were chosen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chosen {
    /// The vertices of each unit, in order; kept markers are the first.
    pub units: Vec<Vec<usize>>,
    /// The clusters that found no room, of the clustering that was taken.
    pub without_room: Vec<usize>,
}

/// What a method adds to its name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Choice {
    /// For `reduce`: the markers that are thinned.
    pub start: Vec<usize>,
    /// For `rehearse`: how long it looks.
    pub rehearse: rehearse::RehearseOptions,
    /// For `kmeans`: how many starts.
    pub clusters: clusters::ClusterOptions,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Rehearse,
        Self::Kmeans,
        Self::Greedy,
        Self::Qr,
        Self::Shell,
        Self::Farthest,
        Self::Reduce,
    ];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Rehearse => "rehearse",
            Self::Kmeans => "kmeans",
            Self::Greedy => "greedy",
            Self::Qr => "qr",
            Self::Shell => "shell",
            Self::Farthest => "farthest",
            Self::Reduce => "reduce",
        }
    }

    /// So many markers.
    ///
    /// # Errors
    /// [`LayoutError`], first of all more markers than fit.
    pub fn choose(
        self,
        task: &Task<'_, '_>,
        count: usize,
        choice: &Choice,
    ) -> Result<Chosen, LayoutError> {
        if count < 4 {
            return Err(LayoutError::TooFew(count));
        }
        let (units, mut without_room) = (task.units, Vec::new());
        let wanted = units.wanted(count)?;
        let chosen = match self {
            Self::Rehearse => return rehearse::rehearse(task, count, &choice.rehearse),
            Self::Reduce => return reduce::reduce(task, count, &choice.start),
            Self::Kmeans => {
                let found = clusters::clustered(task, wanted, &choice.clusters);
                without_room = found.without_room;
                found.units
            }
            Self::Greedy => greedy::greedy(task, wanted, &greedy::EXPECTED_ERROR),
            Self::Qr => pivoted_qr(task, wanted),
            Self::Shell => shell(task, wanted)?,
            Self::Farthest => farthest(task, wanted),
        };
        let mut chosen = units.exactly(chosen, count)?;
        let mut all: Vec<Vec<usize>> = units.kept.iter().map(|&v| vec![v]).collect();
        all.append(&mut chosen);
        Ok(Chosen { units: all, without_room })
    }
}

impl Chosen {
    /// The vertices in order.
    pub fn vertices(&self) -> Vec<usize> {
        self.units.concat()
    }
}

/// The unit that is left with the largest rows of the scaled modes, then the next.
fn pivoted_qr(task: &Task<'_, '_>, wanted: usize) -> Vec<Vec<usize>> {
    let (units, motion) = (task.units, task.motion);
    let moment = motion.second_moment();
    let rows = units
        .each
        .iter()
        .map(|unit| motion_rows(&motion.basis.at(unit), motion.basis.width, &moment));
    let mut qr = PivotedQr::new(rows.collect(), motion.basis.width);
    one_by_one(units, wanted, |chosen, room| {
        let found =
            qr.largest(&|u| units.each[u].len() <= room && units.fits(&units.each[u], chosen))?;
        qr.take(found);
        Some(found)
    })
}

/// The unit where the surface of those before is farthest from its motion, then the next.
fn shell(task: &Task<'_, '_>, wanted: usize) -> Result<Vec<Vec<usize>>, LayoutError> {
    let (units, motion) = (task.units, task.motion);
    let mesh = &units.face.skin.mesh;
    let (deltas, width) = (&motion.basis.deltas, motion.basis.width);
    let rows = motion_rows(deltas, width, &motion.second_moment());
    let options = OperatorOptions::default();
    let held = mesh.unmoved(UNMOVED_M);
    let mut surface = SurfaceGreedy::new(mesh, &held, &options, rows, 3 * width)?;
    let mut failed = None;
    for &v in &units.kept {
        surface.take(v)?;
    }
    let chosen = one_by_one(units, wanted, |chosen, room| {
        let left = |u: usize| units.each[u].iter().map(|&v| surface.square_at(v)).sum::<f64>();
        let free = |u: &usize| {
            let unit = &units.each[*u];
            unit.len() <= room && unit.iter().all(|&v| !held[v]) && units.fits(unit, chosen)
        };
        let best = (0..units.each.len())
            .filter(free)
            .map(|u| (left(u) / units.each[u].len() as f64, u))
            .reduce(|best, next| if next.0 > best.0 { next } else { best })
            .map(|(_, u)| u)?;
        for &v in &units.each[best] {
            if let Err(error) = surface.take(v) {
                failed = Some(error);
                return None;
            }
        }
        Some(best)
    });
    match failed {
        Some(error) => Err(error.into()),
        None => Ok(chosen),
    }
}

/// A vertex that no shape moves by more is at rest where markers move the surface, metres.
const UNMOVED_M: f64 = 1e-4;

/// Places spread by distance alone.
fn farthest(task: &Task<'_, '_>, wanted: usize) -> Vec<Vec<usize>> {
    let units = task.units;
    let points: Vec<Vec<_>> = (units.each.iter())
        .map(|unit| unit.iter().map(|&v| units.face.place(v)).collect())
        .collect();
    let stays: Vec<_> = units.kept.iter().map(|&v| units.face.place(v)).collect();
    let fits = |chosen: &[usize], u: usize| {
        let taken: Vec<usize> = chosen.iter().flat_map(|&c| &units.each[c]).copied().collect();
        units.fits(&units.each[u], &taken)
    };
    let chosen = farthest_first(&points, &stays, wanted, &fits);
    chosen.into_iter().map(|u| units.each[u].clone()).collect()
}

/// Takes the unit that `next` names until there are enough markers or it names none; it is told the vertices
/// that have markers, and how many places are left.
pub(super) fn one_by_one(
    units: &Units<'_>,
    wanted: usize,
    mut next: impl FnMut(&[usize], usize) -> Option<usize>,
) -> Vec<Vec<usize>> {
    let mut chosen: Vec<Vec<usize>> = Vec::new();
    let mut taken = units.kept.clone();
    let mut room = wanted;
    while room > 0 {
        let Some(unit) = next(&taken, room) else { break };
        taken.extend(&units.each[unit]);
        room -= units.each[unit].len();
        chosen.push(units.each[unit].clone());
    }
    chosen
}

/// The criterion of the greedy choice that lowers the expected error of the vertices.
pub(super) fn expected_error(motion: &FaceMotion) -> Criterion {
    Criterion::ExpectedError(motion.basis.gram.clone())
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|method| method.word() == word).ok_or_else(|| {
            let words: Vec<&str> = Self::ALL.iter().map(|method| method.word()).collect();
            format!("{word:?} is no method of a layout; use {}", words.join(", "))
        })
    }
}
