//! How exactly blocks would estimate what no hypothesis tests: thresholds, perceived scales, the faces that people have in
//! mind. Whole studies are simulated and analysed as the report analyses them, with half of the block's trials, with
//! its own number, and with twice as many.

use std::collections::BTreeMap;

use mimique_report::document::csv_text;
use mimique_session::rows::{SessionRecord, tidy};
use mimique_stats::{Outcome, Table, UnitImage, describe, normal_quantile_upper};
use mimique_study::{Component, Study};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use super::given::text;
use super::{PowerError, PowerOptions, run_seed};
use crate::faces::{images, is_present};
use crate::scaling::scales;
use crate::simulate::{Parameters, SimulatedSession, Simulation, threshold};
use crate::thresholds::{Threshold, thresholds};
use crate::trials::export::Export;

/// Simulated studies a point, at most: each of them is gone through page by page.
pub const MOST_RUNS: usize = 100;
/// Draws of the permutation test of a simulated study.
const PERMUTATIONS: usize = 200;

/// How exactly a block estimates what it is for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BlockPrecision {
    /// Name of the component.
    pub block: String,
    /// What it is to estimate.
    pub estimand: Estimand,
    /// Simulated studies a point.
    pub runs: usize,
    /// By number of trials and of people.
    pub points: Vec<PrecisionPoint>,
}

/// What a block is to estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Estimand {
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
    /// Share of what is there that is found: people whose threshold lies within the levels, studies with a scale, units
    /// of planted faces whose presence has p of 0.05 or less.
    pub found: f64,
    /// Of images: share of the other pairs of unit and answer that are found as well.
    pub found_falsely: Option<f64>,
}

/// What one simulated study found with so many of its people.
#[derive(Default)]
struct Found {
    /// Width of an interval.
    width: Option<f64>,
    /// An estimate whose spread over studies makes an interval.
    estimate: Option<f64>,
    /// Sum of the squared errors of people's thresholds.
    squares: f64,
    /// What was found, of how much.
    found: [usize; 2],
    falsely: [usize; 2],
}

/// The precision of every block that estimates something of the kind.
pub(super) fn precision(
    study: &Study,
    config_hash: &str,
    parameters: &Parameters,
    options: &PowerOptions,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<BlockPrecision>, PowerError> {
    let people = &options.participants;
    let most = people.iter().copied().max().unwrap_or(0);
    let runs = runs(options);
    let mut all = Vec::new();
    for Block { name, estimand, trials } in blocks(study) {
        let mut points = Vec::new();
        for trials in trials {
            let study = with_trials(study, &name, trials);
            let each: Vec<Vec<Found>> = (0..runs)
                .into_par_iter()
                .map(|run| {
                    let seed = run_seed(options.seed, &name, run);
                    let simulation = Simulation::new(&study, config_hash, parameters, seed)?;
                    let sessions = simulation.sessions(most as u64, |session| session)?;
                    progress();
                    let simulated = SimulatedStudy {
                        study: &study,
                        parameters,
                        name: &name,
                        sessions: &sessions,
                    };
                    Ok(match estimand {
                        Estimand::Thresholds => simulated.thresholds(seed, people),
                        Estimand::Scale => simulated.of_each(people, SimulatedStudy::scale),
                        Estimand::Images => simulated.of_each(people, SimulatedStudy::images),
                    })
                })
                .collect::<Result<_, PowerError>>()?;
            for (place, &participants) in people.iter().enumerate() {
                let found: Vec<&Found> = each.iter().map(|run| &run[place]).collect();
                points.push(point(&found, trials, participants, estimand));
            }
        }
        all.push(BlockPrecision { block: name, estimand, runs, points });
    }
    Ok(all)
}

/// How many studies [`precision`] simulates.
pub(super) fn simulated(study: &Study, options: &PowerOptions) -> usize {
    blocks(study).iter().map(|block| block.trials.len()).sum::<usize>() * runs(options)
}

fn runs(options: &PowerOptions) -> usize {
    options.runs.min(MOST_RUNS)
}

/// A block, and the numbers of trials that it is simulated with: half of its own, its own, twice as many.
pub(super) struct Block {
    name: String,
    estimand: Estimand,
    trials: Vec<u32>,
}

/// The blocks of a study that estimate something of the kind.
pub(super) fn blocks(study: &Study) -> Vec<Block> {
    let of = |(name, component): (&String, &Component)| {
        let (estimand, json) = match component {
            Component::Adaptive(block) => (Estimand::Thresholds, &block.0),
            Component::Scaling(block) => (Estimand::Scale, &block.0),
            Component::ReverseCorrelation(block) => (Estimand::Images, &block.0),
            _ => return None,
        };
        let own = u32::try_from(json["trials"].as_u64()?).ok()?;
        let mut trials = vec![own.div_ceil(2), own, own.saturating_mul(2)];
        trials.dedup();
        Some(Block { name: name.clone(), estimand, trials })
    };
    study.components.iter().filter_map(of).collect()
}

/// The study with so many trials in a block.
fn with_trials(study: &Study, name: &str, trials: u32) -> Study {
    let mut study = study.clone();
    let json = match study.components.get_mut(name) {
        Some(Component::Adaptive(block)) => &mut block.0,
        Some(Component::Scaling(block)) => &mut block.0,
        Some(Component::ReverseCorrelation(block)) => &mut block.0,
        _ => return study,
    };
    json["trials"] = trials.into();
    study
}

/// A simulated study, of which one block is looked at.
struct SimulatedStudy<'r> {
    study: &'r Study,
    parameters: &'r Parameters,
    name: &'r str,
    sessions: &'r [SimulatedSession],
}

impl SimulatedStudy<'_> {
    /// What the report would find with the first so many people each; nothing where none of them left an answer.
    fn of_each(&self, people: &[usize], find: fn(&Self, &Export) -> Found) -> Vec<Found> {
        let of = |&people: &usize| {
            let export = export(self.study, &self.sessions[..people]);
            export.map_or_else(Found::default, |export| find(self, &export))
        };
        people.iter().map(of).collect()
    }

    /// The thresholds of the first so many people each: every person is fitted once.
    fn thresholds(&self, seed: u64, people: &[usize]) -> Vec<Found> {
        let export = export(self.study, self.sessions);
        let all = export.map_or_else(Vec::new, |export| thresholds(&export, self.study, 0));
        let block = all.into_iter().find(|block| block.block == self.name);
        let fitted = block.map_or_else(Vec::new, |block| block.people);
        let number = |id: &str| {
            let own = self.sessions.iter().find(|own| own.started.participant_id == id)?;
            Some(own.started.participant)
        };
        let fitted: Vec<(u64, Threshold)> = fitted
            .iter()
            .filter_map(|person| Some((number(&person.participant)?, person.threshold)))
            .collect();
        let of = |&people: &usize| {
            let among = fitted.iter().filter(|(number, _)| *number <= people as u64);
            let within: Vec<(u64, f64)> = among
                .clone()
                .filter_map(|(number, threshold)| match threshold {
                    Threshold::At(level) => Some((*number, *level)),
                    _ => None,
                })
                .collect();
            let levels: Vec<f64> = within.iter().map(|(_, level)| *level).collect();
            let mean = describe(&levels).ok();
            let planted = self.parameters.discrimination.get(self.name);
            let squares = within.iter().flat_map(|(number, level)| {
                planted.map(|given| (level - threshold(given, self.name, seed, *number)).powi(2))
            });
            Found {
                width: mean.and_then(|mean| mean.mean_ci_t).map(|[low, high]| high - low),
                squares: squares.sum(),
                found: [within.len(), among.count()],
                ..Found::default()
            }
        };
        people.iter().map(of).collect()
    }

    fn scale(&self, export: &Export) -> Found {
        let block = scales(export, self.study, 0).into_iter().find(|own| own.block == self.name);
        let scale = block.and_then(|block| block.scale.ok());
        Found {
            estimate: scale.as_ref().and_then(|scale| scale.scale.last().copied()),
            found: [usize::from(scale.is_some()), 1],
            ..Found::default()
        }
    }

    fn images(&self, export: &Export) -> Found {
        let mut counted = Found::default();
        let all = images(export, self.study, PERMUTATIONS).into_iter();
        let block = all.filter(|own| own.block == self.name).find_map(|own| own.found);
        let templates = self.parameters.templates.get(self.name);
        for own in block.iter().flat_map(|block| &block.images.categories) {
            let planted = templates.and_then(|all| all.categories.get(&own.category));
            let planted = |unit: &UnitImage| {
                planted.is_some_and(|parts| parts.iter().any(|part| part.unit == unit.unit))
            };
            let Outcome::Ok(group) = &own.group else { continue };
            for unit in &group.units {
                let count = if planted(unit) { &mut counted.found } else { &mut counted.falsely };
                count[0] += usize::from(is_present(unit));
                count[1] += 1;
            }
        }
        counted
    }
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

fn point(runs: &[&Found], trials: u32, participants: usize, estimand: Estimand) -> PrecisionPoint {
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
    let width = match estimand {
        Estimand::Thresholds => describe(&numbers(|run| run.width)).ok().map(|all| all.mean),
        Estimand::Scale => {
            let spread = describe(&numbers(|run| run.estimate)).ok().and_then(|all| all.sd);
            spread.map(|sd| 2.0 * normal_quantile_upper(0.025) * sd)
        }
        Estimand::Images => None,
    };
    let people: usize = runs.iter().map(|run| run.found[0]).sum();
    let squares: f64 = runs.iter().map(|run| run.squares).sum();
    let is_there = estimand == Estimand::Thresholds && people > 0;
    PrecisionPoint {
        trials,
        participants,
        width,
        error: is_there.then(|| (squares / people as f64).sqrt()),
        found: share(|run| run.found).unwrap_or_default(),
        found_falsely: share(|run| run.falsely).filter(|_| estimand == Estimand::Images),
    }
}
