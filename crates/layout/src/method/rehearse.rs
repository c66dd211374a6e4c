//! Layouts tried in simulated takes, the best of them bettered marker by marker.
//!
//! For one solver (Le, Zhu & Deng, "Marker Optimization for Facial Motion Acquisition and Deformation", 2013,
//! choose markers for one solver, too): information about the weights says little of what markers that were
//! put beside their places, and the adaptation of shape, make of them.

use rayon::prelude::*;

use super::chosen::{Chosen, Task};
use super::clusters::{ClusterOptions, clustered};
use super::greedy::{EXPECTED_ERROR, GreedyOptions, greedy, ordered};
use crate::draws::draws;
use crate::error::LayoutError;

/// How long a rehearsal looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RehearseOptions {
    /// K-means layouts to begin with, beside three greedy ones.
    pub clusterings: usize,
    /// How often every marker is tried elsewhere.
    pub rounds: usize,
}

impl Default for RehearseOptions {
    fn default() -> Self {
        Self { clusterings: 10, rounds: 4 }
    }
}

/// Near places that a unit is tried at in a round.
const NEAR: usize = 5;
/// Far places.
const FAR: usize = 2;
/// What is near, metres.
const NEAR_M: f64 = 0.012;

/// The best layout of so many markers.
pub(super) fn rehearse(
    task: &Task<'_, '_>,
    count: usize,
    options: &RehearseOptions,
) -> Result<Chosen, LayoutError> {
    let begun = beginnings(task, count, options)?;
    let (mut least, mut units) = begun;
    let steps = (options.rounds * units.len()) as u64;
    task.progress.stage("rehearse", steps);
    let kept: Vec<Vec<usize>> = task.units.kept.iter().map(|&v| vec![v]).collect();
    let kernel = task.rehearsal.kernel(&[kept.concat(), units.concat()].concat())?;
    for round in 0..options.rounds {
        let mut better = false;
        for place in 0..units.len() {
            let trials = trials(task, &units, place, round);
            let errors: Vec<f64> = trials
                .par_iter()
                .map(|trial| {
                    let mut tried = units.clone();
                    tried[place].clone_from(trial);
                    let markers = [kept.concat(), tried.concat()].concat();
                    task.rehearsal.mean_square_with(&markers, kernel).unwrap_or(f64::INFINITY)
                })
                .collect();
            let best = errors
                .iter()
                .copied()
                .enumerate()
                .reduce(|best, next| if next.1 < best.1 { next } else { best });
            if let Some((trial, error)) = best.filter(|(_, error)| *error < least) {
                units[place].clone_from(&trials[trial]);
                (least, better) = (error, true);
            }
            task.progress.step();
        }
        if !better {
            (0..(options.rounds - 1 - round) * units.len()).for_each(|_| task.progress.step());
            break;
        }
    }
    let mut all = kept;
    all.extend(ordered(task, units));
    Ok(Chosen { units: all, without_room: Vec::new() })
}

/// The mean square error of a layout in the simulated takes, square metres, and its units.
type Tried = (f64, Vec<Vec<usize>>);

/// The best of some layouts by K-means and greedy choice, with its mean square error.
fn beginnings(
    task: &Task<'_, '_>,
    count: usize,
    options: &RehearseOptions,
) -> Result<(f64, Vec<Vec<usize>>), LayoutError> {
    let units = task.units;
    let wanted = units.wanted(count)?;
    task.progress.stage("begin", (options.clusterings + 3) as u64);
    let by_clusters =
        |first: usize| clustered(task, wanted, &ClusterOptions { starts: 1, first }).units;
    let by_greedy = [
        EXPECTED_ERROR,
        GreedyOptions { information: true, slip: true },
        GreedyOptions { information: false, slip: false },
    ];
    let tried: Vec<Result<Tried, LayoutError>> = (0..options.clusterings + by_greedy.len())
        .into_par_iter()
        .map(|number| {
            let chosen = match number.checked_sub(options.clusterings) {
                None => by_clusters(number),
                Some(greedily) => greedy(task, wanted, &by_greedy[greedily]),
            };
            let chosen = units.exactly(chosen, count);
            task.progress.step();
            let chosen = chosen?;
            let markers = [units.kept.clone(), chosen.concat()].concat();
            Ok((task.rehearsal.mean_square(&markers)?, chosen))
        })
        .collect();
    let mut failed = None;
    let mut best: Option<(f64, Vec<Vec<usize>>)> = None;
    for outcome in tried {
        match outcome {
            Ok(next) if best.as_ref().is_none_or(|(least, _)| next.0 < *least) => best = Some(next),
            Ok(_) => {}
            Err(error) => failed = failed.or(Some(error)),
        }
    }
    best.ok_or_else(|| failed.unwrap_or(LayoutError::TooFew(count)))
}

/// Other units of the same kind for a place, that fit beside all others: some near it, some anywhere.
fn trials(
    task: &Task<'_, '_>,
    units: &[Vec<usize>],
    place: usize,
    round: usize,
) -> Vec<Vec<usize>> {
    let all = task.units;
    let others: Vec<usize> = (units.iter().enumerate())
        .filter(|(i, _)| *i != place)
        .flat_map(|(_, unit)| unit)
        .chain(&all.kept)
        .copied()
        .collect();
    let own = &units[place];
    let distance = |unit: &[usize]| (all.face.place(unit[0]) - all.face.place(own[0])).length();
    let alike = |unit: &&Vec<usize>| unit.len() == own.len() && unit[0] != own[0];
    let (mut near, mut far): (Vec<&Vec<usize>>, Vec<&Vec<usize>>) =
        all.each.iter().filter(alike).partition(|unit| distance(unit) < NEAR_M);
    let mut draws = draws(task.seed, &format!("trials {round} {place}"));
    let mut take = |from: &mut Vec<&Vec<usize>>, most: usize| {
        let mut found: Vec<Vec<usize>> = Vec::new();
        // Drawn one by one, since most far ones fit and few near ones may.
        while found.len() < most && !from.is_empty() {
            let unit = from.swap_remove(draws.below(from.len()));
            if all.fits(unit, &others) {
                found.push(unit.clone());
            }
        }
        found
    };
    let mut trials = take(&mut near, NEAR);
    trials.extend(take(&mut far, FAR));
    trials
}
