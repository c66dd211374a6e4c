//! Layouts of one method over the number of markers, beside other methods, sets that were used before, maps of a
//! laboratory and places drawn at random: as recommended (a solver of this program, noise, markers put beside
//! their places, smoothing) and as in the thesis (Gaussian processes on exact places).

mod layouts;
mod worth;

pub use worth::{MarkerWorth, missed, worth};

use mimique_solver::{Inference, Method as Solver, MethodSpec};
use rayon::prelude::*;
use serde::Serialize;

use crate::candidates::Candidates;
use crate::error::LayoutError;
use crate::evaluation::{Errors, Judge, Trial, folds};
use crate::face::Face;
use crate::method::Method;
use crate::motion::FaceMotion;
use crate::progress::Progress;
use crate::rehearsal::{Conditions, Effort};
use crate::sets::NamedSet;
use layouts::Entry;

/// Noise of the trials, metres.
const NOISES_M: [f64; 3] = [0.0, 1e-4, 3e-4];
/// What the Gaussian processes of the thesis are judged by.
const THESIS_EFFORT: Effort = Effort { takes: 1, frames: 200 };
/// What methods that learn for each layout anew are judged by where markers are put: one take of the avatar's
/// face, one of another.
const LEARNING_EFFORT: Effort = Effort { takes: 2, frames: 200 };

/// What is compared.
pub struct Comparing<'c, 'a> {
    /// The face.
    pub face: &'a Face<'a>,
    /// Where markers may be.
    pub candidates: &'c Candidates,
    /// The distance that they keep, metres.
    pub distance: f64,
    /// Whether they come in pairs.
    pub symmetric: bool,
    /// Markers that stay.
    pub kept: &'c [usize],
    /// The motion, without the shapes that no allowed place tells.
    pub motion: &'c FaceMotion,
    /// The motion as it is, for the thesis's side.
    pub whole: &'c FaceMotion,
    /// Noise and slip of the search, metres.
    pub conditions: Conditions,
    /// Smoothing that is advised where markers are put by hand.
    pub smoothing: f64,
    /// The solvers; layouts are sought with the first.
    pub solvers: &'c [MethodSpec],
    /// The method of the layouts.
    pub method: Method,
    /// The numbers of markers.
    pub counts: &'c [usize],
    /// What `reduce` thins.
    pub thinned: &'c [usize],
    /// Given layouts.
    pub sets: &'c [NamedSet],
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Told of every step.
    pub progress: &'c dyn Progress,
}

/// The setting of a row.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RowTrial {
    /// The solver: `lsts`, `regression sparse`, `regression exact` …
    pub solver: String,
    /// Standard deviation of the noise, millimetres.
    pub noise_mm: f64,
    /// Of the places of markers, millimetres.
    pub slip_mm: f64,
    /// Of the adaptation of shape.
    pub smoothing: f64,
}

/// The errors of one layout under one trial.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct CurveRow {
    /// The method, the set or the map.
    pub layout: String,
    /// Its markers.
    pub markers: usize,
    /// The trial.
    #[serde(flatten)]
    pub trial: RowTrial,
    /// The errors.
    #[serde(flatten)]
    pub errors: Errors,
}

/// Curves of both kinds.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Comparison {
    /// What layouts are sought with, and the first curve is drawn of.
    pub main: RowTrial,
    /// What was left out in turn.
    pub folds: Vec<String>,
    /// By solvers of this program.
    pub recommended: Vec<CurveRow>,
    /// By Gaussian processes on exact places, any place of the face, no distance.
    pub as_in_the_thesis: Vec<CurveRow>,
}

impl Comparison {
    /// The rows of a layout under the trial that layouts are sought with, by the number of markers.
    pub fn main_curve(&self, layout: &str) -> Vec<&CurveRow> {
        let own = |row: &&CurveRow| row.layout == layout && row.trial == self.main;
        let mut rows: Vec<&CurveRow> = self.recommended.iter().filter(own).collect();
        rows.sort_by_key(|row| row.markers);
        rows
    }
}

impl Comparing<'_, '_> {
    /// Makes every layout, judges all of them.
    ///
    /// # Errors
    /// [`LayoutError`], first of all where the largest number of markers does not fit.
    pub fn run(&self) -> Result<Comparison, LayoutError> {
        let folds = folds(self.motion);
        let entries = layouts::recommended(self, &folds)?;
        let (learning, solving): (Vec<Trial>, Vec<Trial>) =
            self.trials().into_iter().partition(|trial| learns(&trial.solver));
        let once: Vec<&Entry> = entries.iter().filter(|entry| !entry.is_repeated()).collect();
        let entries: Vec<&Entry> = entries.iter().collect();
        let steps = entries.len() * solving.len() + once.len() * learning.len();
        self.progress.stage("judge", steps as u64);
        let judge = |effort: Effort| Judge::new(self.face, &folds, effort, self.seed);
        let mut recommended = judged(&judge(Effort::REPORT), &entries, &solving, self.progress);
        recommended.extend(judged(&judge(LEARNING_EFFORT), &once, &learning, self.progress));

        let whole = crate::evaluation::folds(self.whole);
        let entries = layouts::as_in_the_thesis(self, &whole)?;
        let judge = Judge::new(self.face, &whole, THESIS_EFFORT, self.seed);
        let trials = thesis_trials();
        self.progress.stage("judge-as-thesis", (entries.len() * trials.len()) as u64);
        let entries: Vec<&Entry> = entries.iter().collect();
        let as_in_the_thesis = judged(&judge, &entries, &trials, self.progress);
        let folds = folds.into_iter().map(|fold| fold.name).collect();
        let Conditions { noise, slip, .. } = self.conditions;
        let smoothing = if slip > 0.0 { self.smoothing } else { 0.0 };
        let main = RowTrial::of(&trial(&self.solvers[0], noise, slip, smoothing));
        Ok(Comparison { main, folds, recommended, as_in_the_thesis })
    }

    /// Every solver with every noise at exact places and at places beside them; the noise that layouts are sought
    /// with smoothed, too. Solvers beside the first, and those that learn for each layout anew, have that noise
    /// alone.
    fn trials(&self) -> Vec<Trial> {
        let Conditions { noise: usual, slip, .. } = self.conditions;
        let mut noises = NOISES_M.to_vec();
        noises.push(usual);
        noises.sort_unstable_by(f64::total_cmp);
        let mut trials: Vec<Trial> = Vec::new();
        for (number, solver) in self.solvers.iter().enumerate() {
            let mut add = |noise: f64, slip: f64, smoothing: f64| {
                let trial = trial(solver, noise, slip, smoothing);
                if !trials.contains(&trial) {
                    trials.push(trial);
                }
            };
            for &noise in &noises {
                if number == 0 && !learns(solver) || noise == usual {
                    add(noise, 0.0, 0.0);
                    add(noise, slip, 0.0);
                }
            }
            if slip > 0.0 {
                add(usual, slip, self.smoothing);
            }
        }
        trials
    }
}

/// A solver under noise (metres), with markers put beside their places (metres) and smoothing.
fn trial(solver: &MethodSpec, noise: f64, slip: f64, smoothing: f64) -> Trial {
    let mut solver = solver.clone();
    solver.rbf_smoothing = Some(smoothing);
    Trial { solver, conditions: Conditions { noise, slip, others: slip > 0.0 } }
}

/// The processes of the thesis: sparse as in 3.3.1, and exact.
fn thesis_trials() -> Vec<Trial> {
    [Inference::Sparse, Inference::Exact]
        .into_iter()
        .map(|inference| {
            let mut solver = MethodSpec::new(Solver::Regression);
            solver.inference = Some(inference);
            let conditions = Conditions { noise: 0.0, slip: 0.0, others: false };
            Trial { solver, conditions }
        })
        .collect()
}

/// A method, and how a regression infers.
fn solver_name(spec: &MethodSpec) -> String {
    match (spec.method, spec.inference()) {
        (Solver::Regression, Inference::Sparse) => "regression sparse".to_owned(),
        (Solver::Regression, Inference::Exact) => "regression exact".to_owned(),
        (other, _) => other.to_string(),
    }
}

/// Whether a method learns for each layout anew.
fn learns(solver: &MethodSpec) -> bool {
    solver.method == Solver::Regression
}

/// Rows of all entries under all trials; layouts that cannot be solved have none.
fn judged(
    judge: &Judge<'_>,
    entries: &[&Entry],
    trials: &[Trial],
    progress: &dyn Progress,
) -> Vec<CurveRow> {
    let layouts: Vec<Vec<&[usize]>> =
        (entries.iter()).map(|entry| entry.by_fold.iter().map(Vec::as_slice).collect()).collect();
    let of_trial = |trial: &Trial| {
        let errors = judge.errors(trial, &layouts, progress);
        let named = RowTrial::of(trial);
        let rows = entries.iter().zip(errors).filter_map(|(entry, errors)| {
            Some(CurveRow {
                layout: entry.name(),
                markers: entry.markers,
                trial: named.clone(),
                errors: errors?,
            })
        });
        rows.collect::<Vec<CurveRow>>()
    };
    trials.par_iter().map(of_trial).collect::<Vec<_>>().concat()
}

impl RowTrial {
    fn of(trial: &Trial) -> Self {
        let mm = |metres: f64| (1e6 * metres).round() / 1e3;
        Self {
            solver: solver_name(&trial.solver),
            noise_mm: mm(trial.conditions.noise),
            slip_mm: mm(trial.conditions.slip),
            smoothing: trial.solver.rbf_smoothing(),
        }
    }
}
