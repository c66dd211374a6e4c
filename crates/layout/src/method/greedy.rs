//! Markers one after the other, each where it tells most (criteria in `mimique_solver::Greedy`).

use mimique_solver::{Criterion, Greedy, MarkerUnit};

use super::Task;
use super::chosen::{expected_error, one_by_one};

/// What a run of the greedy choice counts with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GreedyOptions {
    /// The uncertainty of the weights instead of the expected error of the vertices.
    pub(super) information: bool,
    /// Whether markers are taken to be put beside their places.
    pub(super) slip: bool,
}

/// Expected error, markers put beside their places.
pub(super) const EXPECTED_ERROR: GreedyOptions = GreedyOptions { information: false, slip: true };

/// Units of `wanted` markers.
pub(super) fn greedy(
    task: &Task<'_, '_>,
    wanted: usize,
    options: &GreedyOptions,
) -> Vec<Vec<usize>> {
    let units = task.units;
    let mut greedy = run(task, &units.each, options);
    let kept = run_kept(task, options);
    if let Some((kept, covariance)) = kept {
        // Kept markers have told what they tell.
        greedy = Greedy::new(&kept, &covariance, criterion(task, options));
    }
    let mut out = vec![false; units.each.len()];
    one_by_one(units, wanted, |chosen, room| {
        for (u, out) in out.iter_mut().enumerate() {
            if !*out && !units.fits(&units.each[u], chosen) {
                *out = true;
                greedy.leave_out(u);
            }
        }
        let (best, _) = greedy.best(&|u| units.each[u].len() <= room)?;
        out[best] = true;
        greedy.take(best);
        Some(best)
    })
}

/// The order in which given units tell most.
pub(super) fn ordered(task: &Task<'_, '_>, chosen: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let mut greedy = run(task, &chosen, &EXPECTED_ERROR);
    let mut order = Vec::new();
    while let Some((best, _)) = greedy.best(&|_| true) {
        greedy.take(best);
        order.push(best);
    }
    order.into_iter().map(|u| chosen[u].clone()).collect()
}

fn criterion(task: &Task<'_, '_>, options: &GreedyOptions) -> Criterion {
    if options.information { Criterion::Information } else { expected_error(task.motion) }
}

fn marker_units(
    task: &Task<'_, '_>,
    units: &[Vec<usize>],
    options: &GreedyOptions,
) -> Vec<MarkerUnit> {
    let (face, motion) = (task.units.face, task.motion);
    let moment = motion.second_moment();
    let slip = if options.slip { task.slip } else { 0.0 };
    let covariance = |&v: &usize| {
        face.gradients.measurement_covariance(v, &motion.basis.deltas, &moment, [task.noise, slip])
    };
    let unit = |unit: &Vec<usize>| MarkerUnit {
        deltas: motion.basis.at(unit),
        covariances: unit.iter().map(covariance).collect(),
    };
    units.iter().map(unit).collect()
}

fn run(task: &Task<'_, '_>, units: &[Vec<usize>], options: &GreedyOptions) -> Greedy {
    let units = marker_units(task, units, options);
    Greedy::new(&units, &task.motion.prior(), criterion(task, options))
}

/// The units beside kept markers, and what is known with these; none where none are kept.
fn run_kept(task: &Task<'_, '_>, options: &GreedyOptions) -> Option<(Vec<MarkerUnit>, Vec<f64>)> {
    let units = task.units;
    if units.kept.is_empty() {
        return None;
    }
    let kept: Vec<Vec<usize>> = units.kept.iter().map(|&v| vec![v]).collect();
    let mut known = run(task, &kept, options);
    (0..kept.len()).for_each(|unit| known.take(unit));
    Some((marker_units(task, &units.each, options), known.covariance().to_vec()))
}
