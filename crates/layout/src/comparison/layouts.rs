//! The layouts of a comparison, made anew for every fold.

use mimique_solver::{Method as Solver, MethodSpec};

use super::Comparing;
use crate::candidates::{Candidates, Where};
use crate::error::LayoutError;
use crate::evaluation::Fold;
use crate::face::Excluded;
use crate::method::{Choice, Method, RehearseOptions, Task};
use crate::motion::FaceMotion;
use crate::progress::Silent;
use crate::rehearsal::{Conditions, Effort, Rehearsal};
use crate::sets::random;
use crate::spacing::Spacing;
use crate::units::Units;

/// Layouts drawn at random of each size.
const RANDOM: usize = 5;
/// Rounds of a rehearsal for each point of a curve: a quarter of a layout's own.
const ROUNDS: usize = 1;
/// K-means layouts that such a rehearsal begins with.
const CLUSTERINGS: usize = 4;

/// Where a layout comes from.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// Chosen by a method.
    Method(Method),
    /// Drawn at random, by its number.
    Chance(usize),
    /// Given, by its name.
    Set(String),
}

/// A layout's vertices in each fold.
pub(super) struct Entry {
    origin: Origin,
    pub(super) markers: usize,
    pub(super) by_fold: Vec<Vec<usize>>,
}

impl Entry {
    /// What it is called in a row.
    pub(super) fn name(&self) -> String {
        match &self.origin {
            Origin::Method(method) => method.to_string(),
            Origin::Chance(number) => format!("random {}", number + 1),
            Origin::Set(name) => name.clone(),
        }
    }

    /// Whether it is drawn once more than a method that learns is judged by.
    pub(super) fn is_repeated(&self) -> bool {
        matches!(self.origin, Origin::Chance(number) if number > 0)
    }
}

/// Entries of origins with every number of markers, the largest first.
fn entries(origins: &[Origin], counts: &[usize]) -> Vec<Entry> {
    let of = |origin: &Origin| {
        let entry =
            |&markers: &usize| Entry { origin: origin.clone(), markers, by_fold: Vec::new() };
        counts.iter().rev().map(entry).collect::<Vec<_>>()
    };
    origins.iter().flat_map(of).collect()
}

/// The given sets, the same in every fold.
fn sets(comparing: &Comparing<'_, '_>, folds: usize) -> Vec<Entry> {
    (comparing.sets.iter())
        .map(|set| Entry {
            origin: Origin::Set(set.name.clone()),
            markers: set.vertices.len(),
            by_fold: vec![set.vertices.clone(); folds],
        })
        .collect()
}

/// Layouts of the method, of K-means and of chance for each fold, and the given sets.
///
/// # Errors
/// [`LayoutError`], first of all where the largest number of markers does not fit.
pub(super) fn recommended(
    comparing: &Comparing<'_, '_>,
    folds: &[Fold],
) -> Result<Vec<Entry>, LayoutError> {
    let mut origins = vec![Origin::Method(comparing.method)];
    if comparing.method != Method::Kmeans {
        origins.push(Origin::Method(Method::Kmeans));
    }
    origins.extend((0..RANDOM).map(Origin::Chance));
    let mut entries = entries(&origins, comparing.counts);
    entries.retain(|entry| {
        let thinned = entry.origin == Origin::Method(Method::Reduce);
        !thinned || entry.markers <= comparing.thinned.len()
    });
    comparing.progress.stage("layouts", (folds.len() * entries.len()) as u64);
    for fold in folds {
        let motion = &fold.learnt;
        let candidates = &comparing.candidates.vertices;
        let spacing = Spacing::of(comparing.face, motion, candidates, comparing.distance);
        let symmetric = comparing.symmetric;
        let face = comparing.face;
        let units = Units::of(face, comparing.candidates, spacing, symmetric, comparing.kept)?;
        let mut solver = comparing.solvers[0].clone();
        solver.rbf_smoothing = Some(comparing.smoothing);
        let (conditions, seed) = (comparing.conditions, comparing.seed);
        let effort = Effort::SEARCH;
        let rehearsal = Rehearsal::new(face, motion, None, &solver, conditions, effort, seed);
        fill(comparing, &units, motion, &rehearsal, conditions, &mut entries)?;
    }
    entries.extend(sets(comparing, folds.len()));
    Ok(entries)
}

/// The thesis's own: K-means of any vertex of the face, single markers, no distance; one layout at random.
///
/// # Errors
/// As [`recommended`].
pub(super) fn as_in_the_thesis(
    comparing: &Comparing<'_, '_>,
    folds: &[Fold],
) -> Result<Vec<Entry>, LayoutError> {
    let exclude = vec![Excluded::Ears, Excluded::Neck, Excluded::Hair];
    let candidates = Candidates::of(comparing.face, &Where { exclude, ..Where::default() });
    let origins = [Origin::Method(Method::Kmeans), Origin::Chance(0)];
    let mut entries = entries(&origins, comparing.counts);
    comparing.progress.stage("layouts-as-thesis", (folds.len() * entries.len()) as u64);
    for fold in folds {
        let spacing = Spacing::at_rest(comparing.face, 0.0);
        let units = Units::of(comparing.face, &candidates, spacing, false, &[])?;
        let conditions = Conditions { noise: 0.0, slip: 0.0, others: false };
        // K-means tries nothing.
        let rehearsal = Rehearsal::new(
            comparing.face,
            &fold.learnt,
            None,
            &MethodSpec::new(Solver::Lsts),
            conditions,
            Effort { takes: 1, frames: 1 },
            comparing.seed,
        );
        fill(comparing, &units, &fold.learnt, &rehearsal, conditions, &mut entries)?;
    }
    entries.extend(sets(comparing, folds.len()));
    Ok(entries)
}

/// One more fold for entries that are chosen or drawn.
fn fill(
    comparing: &Comparing<'_, '_>,
    units: &Units<'_>,
    motion: &FaceMotion,
    rehearsal: &Rehearsal<'_>,
    conditions: Conditions,
    entries: &mut [Entry],
) -> Result<(), LayoutError> {
    let task = Task {
        units,
        motion,
        rehearsal,
        noise: conditions.noise,
        slip: conditions.slip,
        seed: comparing.seed,
        progress: &Silent,
    };
    let rehearse = RehearseOptions { clusterings: CLUSTERINGS, rounds: ROUNDS };
    let start = comparing.thinned.to_vec();
    let mut choice = Choice { rehearse, start, ..Choice::default() };
    for entry in entries {
        let vertices = match entry.origin {
            Origin::Method(method) => {
                let vertices = method.choose(&task, entry.markers, &choice)?.vertices();
                if method == Method::Reduce {
                    // Fewer are thinned from more: the largest number is the first.
                    choice.start.clone_from(&vertices);
                }
                vertices
            }
            Origin::Chance(number) => {
                let drawn = random(units, entry.markers, comparing.seed, number);
                let drawn = units.exactly(drawn, entry.markers)?;
                [units.kept.clone(), drawn.concat()].concat()
            }
            Origin::Set(_) => continue,
        };
        comparing.progress.step();
        entry.by_fold.push(vertices);
    }
    Ok(())
}
