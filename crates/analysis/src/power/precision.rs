//! How exactly blocks would tell what no hypothesis tests: thresholds, perceived scales, the faces that people have in
//! mind. Whole studies are simulated and analysed as the report analyses them, with half of the block's trials, with
//! its own number, and with twice as many.

use std::collections::BTreeMap;

use mimique_session::rows::{SessionRecord, tidy};
use mimique_stats::{Outcome, Table, describe};
use mimique_study::{Component, Study};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use super::given::text;
use super::{PowerError, PowerOptions, run_seed};
use crate::faces::images;
use crate::report::document::csv_text;
use crate::scaling::scales;
use crate::simulate::{Parameters, SimulatedSession, Simulation, threshold};
use crate::thresholds::{Threshold, thresholds};
use crate::trials::export::Export;

/// Simulated studies a point, at most: each of them is gone through page by page.
pub const MOST_RUNS: usize = 100;
/// Draws of the permutation test of a simulated study.
const PERMUTATIONS: usize = 200;
/// A unit belongs to a face below this p.
const ALPHA: f64 = 0.05;
/// Standard normal quantile of a 95 % interval.
const Z: f64 = 1.959_963_984_540_054;

/// How exactly a block tells what it is for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BlockPrecision {
    /// Name of the component.
    pub block: String,
    /// What it tells.
    pub tells: Told,
    /// Simulated studies a point.
    pub runs: usize,
    /// By number of trials and of people.
    pub points: Vec<PrecisionPoint>,
}

/// What a block tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Told {
    /// The threshold of each person.
    Thresholds,
    /// A perceived scale.
    Scale,
    /// Which action units go with which answer.
    Images,
}

/// With so many people and trials.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PrecisionPoint {
    /// Trials of each person (of an adaptive block, of each track).
    pub trials: u32,
    /// People who arrive.
    pub participants: usize,
    /// Width of a 95 % interval: of the mean threshold (t, mean over studies), of ψ at the highest level (from its
    /// spread over studies). None of images.
    pub width: Option<f64>,
    /// Of thresholds: root mean square of what is found of a person, less the planted threshold. A mean over people may
    /// be narrow where everybody is found in the middle of the levels; this is not.
    pub error: Option<f64>,
    /// Share of what is there that is told: people whose threshold lies within the levels, studies with a scale, units
    /// of planted faces whose presence has p of 0.05 or less.
    pub told: f64,
    /// Of images: share of the other pairs of unit and answer that are told as well.
    pub falsely: Option<f64>,
}

/// What one simulated study found.
#[derive(Default)]
struct Found {
    /// Width of an interval, or the estimate whose spread over studies makes one.
    width: Option<f64>,
    estimate: Option<f64>,
    /// Sum of the squared errors of people's thresholds.
    squares: f64,
    /// What was told, of how much.
    told: [usize; 2],
    falsely: [usize; 2],
}

/// The precision of every block that tells something of the kind.
pub(super) fn precision(
    study: &Study,
    config_hash: &str,
    parameters: &Parameters,
    options: &PowerOptions,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<BlockPrecision>, PowerError> {
    let most = options.participants.iter().copied().max().unwrap_or(0);
    let runs = runs(options);
    let mut found = Vec::new();
    for (name, tells) in blocks(study) {
        let mut points = Vec::new();
        for (study, trials) in with_trials(study, &name) {
            let each: Vec<Vec<Found>> = (0..runs)
                .into_par_iter()
                .map(|run| {
                    let seed = run_seed(options.seed, &name, run);
                    let simulation = Simulation::new(&study, config_hash, parameters, seed)?;
                    let sessions = simulation.sessions(most as u64, |session| session)?;
                    progress();
                    let of = |&people: &usize| {
                        one((&study, parameters, seed), &sessions[..people], (&name, tells))
                    };
                    Ok(options.participants.iter().map(of).collect())
                })
                .collect::<Result<_, PowerError>>()?;
            for (place, &participants) in options.participants.iter().enumerate() {
                let all: Vec<&Found> = each.iter().map(|run| &run[place]).collect();
                points.push(point(&all, trials, participants, tells));
            }
        }
        found.push(BlockPrecision { block: name, tells, runs, points });
    }
    Ok(found)
}

/// How many studies [`precision`] simulates.
pub(super) fn simulated(study: &Study, options: &PowerOptions) -> usize {
    let variants = |(name, _): &(String, Told)| with_trials(study, name).len();
    blocks(study).iter().map(variants).sum::<usize>() * runs(options)
}

fn runs(options: &PowerOptions) -> usize {
    options.runs.min(MOST_RUNS)
}

pub(super) fn blocks(study: &Study) -> Vec<(String, Told)> {
    let of = |(name, component): (&String, &Component)| {
        let tells = match component {
            Component::Adaptive(_) => Told::Thresholds,
            Component::Scaling(_) => Told::Scale,
            Component::ReverseCorrelation(_) => Told::Images,
            _ => return None,
        };
        Some((name.clone(), tells))
    };
    study.components.iter().filter_map(of).collect()
}

/// The study with half of the block's trials, with its own number, and with twice as many.
fn with_trials(study: &Study, name: &str) -> Vec<(Study, u32)> {
    let trials = match study.components.get(name) {
        Some(Component::Adaptive(block)) => &block.0["trials"],
        Some(Component::Scaling(block)) => &block.0["trials"],
        Some(Component::ReverseCorrelation(block)) => &block.0["trials"],
        _ => return Vec::new(),
    };
    let own = trials.as_u64().and_then(|own| u32::try_from(own).ok()).unwrap_or_default();
    let mut numbers = vec![own.div_ceil(2), own, own.saturating_mul(2)];
    numbers.dedup();
    let varied = |trials: u32| {
        let mut study = study.clone();
        match study.components.get_mut(name) {
            Some(Component::Adaptive(block)) => block.0["trials"] = trials.into(),
            Some(Component::Scaling(block)) => block.0["trials"] = trials.into(),
            Some(Component::ReverseCorrelation(block)) => block.0["trials"] = trials.into(),
            _ => {}
        }
        (study, trials)
    };
    numbers.into_iter().map(varied).collect()
}

/// What the report would find in these sessions; nothing where nobody left an answer.
fn one(
    (study, parameters, seed): (&Study, &Parameters, u64),
    sessions: &[SimulatedSession],
    (name, tells): (&str, Told),
) -> Found {
    let Some(export) = export(study, sessions) else { return Found::default() };
    let mut found = Found::default();
    match tells {
        Told::Thresholds => {
            let all = thresholds(&export, study, 0);
            let Some(block) = all.into_iter().find(|block| block.block == name) else {
                return found;
            };
            if let Some(mean) = block.mean.clone().ok() {
                found.told[0] = mean.n;
                found.width = mean.mean_ci_t.map(|[low, high]| high - low);
            }
            found.told[1] = block.people.len();
            let planted = parameters.discrimination.get(name);
            let number = |id: &str| {
                let own = sessions.iter().find(|own| own.started.participant_id == id)?;
                Some(own.started.participant)
            };
            for person in &block.people {
                if let (Threshold::At(level), Some(given), Some(number)) =
                    (person.threshold, planted, number(&person.participant))
                {
                    let error = level - threshold(given, name, seed, number);
                    found.squares += error * error;
                }
            }
        }
        Told::Scale => {
            found.told[1] = 1;
            let block = scales(&export, study, 0).into_iter().find(|block| block.block == name);
            if let Some(Outcome::Ok(scale)) = block.map(|block| block.scale) {
                found.told[0] = 1;
                found.estimate = scale.scale.last().copied();
            }
        }
        Told::Images => {
            let block =
                images(&export, study, PERMUTATIONS).into_iter().find(|own| own.block == name);
            let images = block.and_then(|block| block.found).map(|found| found.images);
            for own in images.iter().flat_map(|images| &images.categories) {
                let planted = parameters
                    .templates
                    .get(name)
                    .and_then(|all| all.categories.get(&own.category));
                let Outcome::Ok(group) = &own.group else { continue };
                for unit in &group.units {
                    let is_there = planted
                        .is_some_and(|parts| parts.iter().any(|part| part.unit == unit.unit));
                    let count = if is_there { &mut found.told } else { &mut found.falsely };
                    count[0] += usize::from(unit.presence.p <= ALPHA && unit.presence.effect > 0.0);
                    count[1] += 1;
                }
            }
        }
    }
    found
}

fn export(study: &Study, sessions: &[SimulatedSession]) -> Option<Export> {
    Export::read(&Table::parse(csv(study, sessions).into_bytes()).ok()?, study).ok()
}

/// The tidy export of simulated sessions; whoever took the answers back is not in it.
pub(super) fn csv(study: &Study, sessions: &[SimulatedSession]) -> String {
    let kept = sessions.iter().filter(|session| !session.events.is_empty());
    let records = kept.map(|own| SessionRecord { started: &own.started, events: &own.events });
    let table = tidy(study, &BTreeMap::new(), records);
    let cell = |cell: &Value| if cell.is_null() { String::new() } else { text(cell) };
    let head: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    let rows = table.rows.iter().map(|row| row.iter().map(cell).collect::<Vec<String>>());
    csv_text(std::iter::once(head).chain(rows))
}

fn point(runs: &[&Found], trials: u32, participants: usize, tells: Told) -> PrecisionPoint {
    let share = |of: fn(&Found) -> [usize; 2]| {
        let [some, all] = runs.iter().fold([0, 0], |[some, all], run| {
            let [more, of_all] = of(run);
            [some + more, all + of_all]
        });
        (all > 0).then(|| some as f64 / all as f64)
    };
    let numbers = |of: fn(&Found) -> Option<f64>| -> Vec<f64> {
        runs.iter().filter_map(|run| of(run)).collect()
    };
    let width = match tells {
        Told::Thresholds => describe(&numbers(|run| run.width)).ok().map(|all| all.mean),
        Told::Scale => {
            let spread = describe(&numbers(|run| run.estimate)).ok().and_then(|all| all.sd);
            spread.map(|sd| 2.0 * Z * sd)
        }
        Told::Images => None,
    };
    let falsely = share(|run| run.falsely).filter(|_| tells == Told::Images);
    let told = share(|run| run.told).unwrap_or_default();
    let people: usize = runs.iter().map(|run| run.told[0]).sum();
    let squares: f64 = runs.iter().map(|run| run.squares).sum();
    let error = (tells == Told::Thresholds && people > 0).then(|| (squares / people as f64).sqrt());
    PrecisionPoint { trials, participants, width, error, told, falsely }
}
