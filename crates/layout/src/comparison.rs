//! Layouts of one method over the number of markers, beside other methods, sets that were used before, maps of a
//! laboratory and places drawn at random: as recommended (a solver of this program, noise, markers put beside
//! their places, smoothing) and as in the thesis (Gaussian processes on exact places).

use mimique_solver::{Inference, Method as Solver, MethodSpec};
use rayon::prelude::*;
use serde::Serialize;

use crate::candidates::{Candidates, Where};
use crate::error::LayoutError;
use crate::evaluation::{Errors, Fold, Judge, Trial, folds};
use crate::face::{Excluded, Face};
use crate::method::{Choice, ClusterOptions, Method, RehearseOptions, Task};
use crate::motion::FaceMotion;
use crate::progress::{Progress, Silent};
use crate::rehearsal::{Conditions, Effort, Rehearsal};
use crate::sets::{NamedSet, random};
use crate::spacing::Spacing;
use crate::units::Units;

/// Layouts drawn at random of each size.
const RANDOM: usize = 5;
/// Noise of the trials, metres.
const NOISES_M: [f64; 3] = [0.0, 1e-4, 3e-4];
/// What the Gaussian processes of the thesis are judged by.
const THESIS_EFFORT: Effort = Effort { takes: 1, frames: 200 };
/// Rounds of a rehearsal for each point of a curve: a quarter of a layout's own.
const ROUNDS: usize = 1;
/// K-means layouts that such a rehearsal begins with.
const CLUSTERINGS: usize = 4;

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
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Comparison {
    /// What was left out in turn.
    pub folds: Vec<String>,
    /// By solvers of this program.
    pub recommended: Vec<CurveRow>,
    /// By Gaussian processes on exact places, any place of the face, no distance.
    pub as_in_the_thesis: Vec<CurveRow>,
}

/// A layout's vertices in each fold.
struct Entry {
    layout: String,
    markers: usize,
    by_fold: Vec<Vec<usize>>,
}

impl Comparing<'_, '_> {
    /// How many steps [`Self::run`] tells of.
    pub fn steps(&self) -> u64 {
        let folds = folds(self.motion).len() as u64;
        let made = self.counts.len() as u64;
        2 * folds * made
    }

    /// Makes every layout, judges all of them.
    ///
    /// # Errors
    /// [`LayoutError`], first of all where the largest number of markers does not fit.
    pub fn run(&self) -> Result<Comparison, LayoutError> {
        let folds = folds(self.motion);
        let entries = self.recommended_layouts(&folds)?;
        let judge = Judge::new(self.face, &folds, Effort::REPORT, self.seed);
        let trials = self.trials();
        let steps = (entries.len() * trials.len()) as u64;
        self.progress.stage("judge", steps);
        let recommended = judged(&judge, &entries, &trials, self.progress);

        let whole = crate::evaluation::folds(self.whole);
        let entries = self.thesis_layouts(&whole)?;
        let judge = Judge::new(self.face, &whole, THESIS_EFFORT, self.seed);
        let trials = thesis_trials();
        self.progress.stage("judge-as-thesis", (entries.len() * trials.len()) as u64);
        let as_in_the_thesis = judged(&judge, &entries, &trials, self.progress);
        let folds = folds.into_iter().map(|fold| fold.name).collect();
        Ok(Comparison { folds, recommended, as_in_the_thesis })
    }

    /// Every solver with every noise at exact places and at places beside them; the usual noise with smoothing.
    fn trials(&self) -> Vec<Trial> {
        let mut trials = Vec::new();
        for (number, solver) in self.solvers.iter().enumerate() {
            let mut add = |noise: f64, slip: f64, smoothing: f64| {
                let mut solver = solver.clone();
                solver.rbf_smoothing = Some(smoothing);
                let conditions = Conditions { noise, slip, others: slip > 0.0 };
                trials.push(Trial { solver, conditions });
            };
            let slip = self.conditions.slip;
            for noise in NOISES_M {
                // The other solvers, and what learns anew for every layout, with the usual noise alone.
                if number == 0 && solver.method != Solver::Regression || noise == NOISES_M[1] {
                    add(noise, 0.0, 0.0);
                    add(noise, slip, 0.0);
                }
            }
            add(NOISES_M[1], slip, self.smoothing);
        }
        trials
    }

    /// Layouts of the method, of K-means and of chance for each fold, and the given sets.
    fn recommended_layouts(&self, folds: &[Fold]) -> Result<Vec<Entry>, LayoutError> {
        let mut methods = vec![self.method];
        methods.extend((self.method != Method::Kmeans).then_some(Method::Kmeans));
        methods.retain(|method| *method != Method::Reduce);
        self.progress.stage("layouts", (folds.len() * self.counts.len() * methods.len()) as u64);
        let mut entries: Vec<Entry> = Vec::new();
        for &method in &methods {
            for &count in self.counts {
                entries.push(Entry { layout: method.to_string(), markers: count, by_fold: vec![] });
            }
        }
        for number in 0..RANDOM {
            for &count in self.counts {
                let layout = format!("random {}", number + 1);
                entries.push(Entry { layout, markers: count, by_fold: vec![] });
            }
        }
        for fold in folds {
            let spacing =
                Spacing::of(self.face, &fold.learnt, &self.candidates.vertices, self.distance);
            let units = Units::of(self.face, self.candidates, spacing, self.symmetric, self.kept)?;
            let mut solver = self.solvers[0].clone();
            solver.rbf_smoothing = Some(self.smoothing);
            let rehearsal = Rehearsal::new(
                self.face,
                &fold.learnt,
                None,
                &solver,
                self.conditions,
                Effort::SEARCH,
                self.seed,
            );
            let task = Task {
                units: &units,
                motion: &fold.learnt,
                rehearsal: &rehearsal,
                noise: self.conditions.noise,
                slip: self.conditions.slip,
                seed: self.seed,
                progress: &Silent,
            };
            let rehearse = RehearseOptions { clusterings: CLUSTERINGS, rounds: ROUNDS };
            let choice = Choice { rehearse, ..Choice::default() };
            let random_from = methods.len() * self.counts.len();
            for (place, entry) in entries.iter_mut().enumerate() {
                let vertices = if place < random_from {
                    let method = methods[place / self.counts.len()];
                    let found = method.choose(&task, entry.markers, &choice)?;
                    self.progress.step();
                    found.vertices()
                } else {
                    let number = (place - random_from) / self.counts.len();
                    let drawn = random(&units, entry.markers, self.seed, number);
                    let drawn = units.exactly(drawn, entry.markers)?;
                    [self.kept.to_vec(), drawn.concat()].concat()
                };
                entry.by_fold.push(vertices);
            }
        }
        entries.extend(self.set_entries(folds.len()));
        Ok(entries)
    }

    /// The thesis's own: K-means of any vertex of the face, single markers, no distance.
    fn thesis_layouts(&self, folds: &[Fold]) -> Result<Vec<Entry>, LayoutError> {
        let anywhere = Where {
            exclude: vec![Excluded::Ears, Excluded::Neck, Excluded::Hair],
            ..Where::default()
        };
        let candidates = Candidates::of(self.face, &anywhere);
        self.progress.stage("layouts-as-thesis", (folds.len() * self.counts.len()) as u64);
        let mut kmeans: Vec<Entry> = (self.counts.iter())
            .map(|&markers| Entry { layout: "kmeans".to_owned(), markers, by_fold: vec![] })
            .collect();
        let mut chance: Vec<Entry> = (self.counts.iter())
            .map(|&markers| Entry { layout: "random 1".to_owned(), markers, by_fold: vec![] })
            .collect();
        for fold in folds {
            let spacing = Spacing::at_rest(self.face, 0.0);
            let units = Units::of(self.face, &candidates, spacing, false, &[])?;
            let rehearsal = Rehearsal::new(
                self.face,
                &fold.learnt,
                None,
                &MethodSpec::new(Solver::Lsts),
                Conditions { noise: 0.0, slip: 0.0, others: false },
                Effort { takes: 1, frames: 1 },
                self.seed,
            );
            let task = Task {
                units: &units,
                motion: &fold.learnt,
                rehearsal: &rehearsal,
                noise: 0.0,
                slip: 0.0,
                seed: self.seed,
                progress: &Silent,
            };
            let choice = Choice { clusters: ClusterOptions::default(), ..Choice::default() };
            for entry in &mut kmeans {
                let found = Method::Kmeans.choose(&task, entry.markers, &choice)?;
                self.progress.step();
                entry.by_fold.push(found.vertices());
            }
            for entry in &mut chance {
                let drawn = random(&units, entry.markers, self.seed, 0);
                entry.by_fold.push(drawn.concat());
            }
        }
        kmeans.append(&mut chance);
        kmeans.extend(self.set_entries(folds.len()));
        Ok(kmeans)
    }

    /// The given sets, the same in every fold.
    fn set_entries(&self, folds: usize) -> Vec<Entry> {
        let entry = |set: &NamedSet| Entry {
            layout: set.name.clone(),
            markers: set.vertices.len(),
            by_fold: vec![set.vertices.clone(); folds],
        };
        self.sets.iter().map(entry).collect()
    }
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

/// Rows of all entries under all trials; layouts that cannot be solved have none.
fn judged(
    judge: &Judge<'_>,
    entries: &[Entry],
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
                layout: entry.layout.clone(),
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
        let spec = &trial.solver;
        let solver = match (spec.method, spec.inference()) {
            (Solver::Regression, Inference::Sparse) => "regression sparse".to_owned(),
            (Solver::Regression, Inference::Exact) => "regression exact".to_owned(),
            (other, _) => other.to_string(),
        };
        let mm = |metres: f64| (1e6 * metres).round() / 1e3;
        Self {
            solver,
            noise_mm: mm(trial.conditions.noise),
            slip_mm: mm(trial.conditions.slip),
            smoothing: spec.rbf_smoothing(),
        }
    }
}

/// What the markers of a layout are worth in simulated takes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MarkerWorth {
    /// Error with the markers up to this one, millimetres; null where so few tell no face.
    pub with_those_before_mm: Option<f64>,
    /// How much the error rises without it, millimetres.
    pub missed_mm: Option<f64>,
}

/// The worth of each marker of a layout, in its order.
pub fn worth(rehearsal: &Rehearsal<'_>, vertices: &[usize]) -> Vec<MarkerWorth> {
    let error =
        |markers: &[usize]| rehearsal.mean_square(markers).ok().map(|square| 1e3 * square.sqrt());
    let all = error(vertices);
    (0..vertices.len())
        .into_par_iter()
        .map(|place| {
            let mut others = vertices.to_vec();
            others.remove(place);
            let without = error(&others);
            MarkerWorth {
                with_those_before_mm: error(&vertices[..=place]),
                missed_mm: without.zip(all).map(|(without, all)| without - all),
            }
        })
        .collect()
}
