//! Power: the study's own analysis over simulated answers, against the number of people and of clips.
//!
//! Each run simulates a whole study and tests every hypothesis of its file as in the thesis (trials taken for independent
//! observations) and by the test that decides it in the report, for other clips or for these.
//! With the effects of the parameters the share of runs with p below alpha is the power, without them the
//! rate of false positives.

mod clips;
mod curve;
mod dataset;
#[cfg(test)]
mod dataset_tests;
mod design;
mod drawn_pairs;
mod given;
mod precision;
mod precision_table;
mod table;

use mimique_locale::Language;
use mimique_stats::{Adjustment, Outcome, proportion};
use mimique_study::{Hypothesis, OrderError, Problem, Study, TestName};
use rayon::prelude::*;
use serde::Serialize;

use crate::hypothesis::ClipScope;
use crate::hypothesis::decision::{EffectUnit, detected};
use crate::hypothesis::other_clips::OtherClipsTests;
use crate::hypothesis::test_line::OutcomeP;
use crate::hypothesis::undefined::TestOutcome;
use crate::hypothesis::{is_two_way, of_pair, test_hypothesis};
use crate::naming::Naming;
use crate::simulate::{Draws, Model, Parameters, ParametersError};
pub use curve::power_curve;
use design::Design;
pub use precision::{BlockPrecision, Estimand, PrecisionPoint};
pub use precision_table::{precision_csv, precision_markdown};
pub(crate) use table::enough;
pub use table::{in_scope, no_effect, power_csv, power_markdown, smallest_cell};

/// The power with which [`HypothesisPower::smallest_difference`] is detected.
const SMALLEST_DIFFERENCE_POWER: f64 = 0.8;

/// What is varied, and how often it is simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerOptions {
    /// Numbers of people.
    pub participants: Vec<usize>,
    /// Numbers of clips; empty: the study's own.
    pub clips: Vec<usize>,
    /// Simulated studies a point.
    pub runs: usize,
    /// Seed of everything.
    pub seed: u64,
    /// A test is positive below this p.
    pub alpha: f64,
    /// Whether false positives are counted too, in as many runs again.
    pub false_positives: bool,
    /// Whether the mixed models of other clips too are fitted in each run also where they do not decide.
    pub mixed: bool,
}

/// The power of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Power {
    /// Identifier of the study.
    pub study: String,
    /// Simulated studies a point.
    pub runs: usize,
    /// Seed.
    pub seed: u64,
    /// A test is positive below this p.
    pub alpha: f64,
    /// A point for each number of people and of clips, in this order.
    pub points: Vec<PowerPoint>,
    /// How exactly blocks estimate what no hypothesis tests: thresholds, scales, faces in mind.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub precision: Vec<BlockPrecision>,
}

/// One number of people and of clips.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PowerPoint {
    /// People who arrive.
    pub participants: usize,
    /// Clips of the study.
    pub clips: usize,
    /// Segments that they are of.
    pub segments: usize,
    /// People left after dropout and exclusions, on average.
    pub people_used: f64,
    /// The study's hypotheses.
    pub hypotheses: Vec<HypothesisPower>,
}

/// One hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HypothesisPower {
    /// Its identifier.
    pub id: String,
    /// Which clips its decision is about.
    pub scope: ClipScope,
    /// The smallest difference between two levels that the deciding test detects with a power of 80 %; none of
    /// interactions, correlations and equivalence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_difference: Option<SmallestDifference>,
    /// Whether the parameters hold an effect for it ([`Parameters::has_effect`]). Without one, what is
    /// counted as power is false positives.
    pub effect: bool,
    /// With the effects of the parameters; of a hypothesis of equivalence without them, at a true difference of 0.
    pub power: Columns,
    /// Without the effects that the hypotheses look for; none of a hypothesis of equivalence.
    pub false_positives: Option<Columns>,
}

/// Shares of positive tests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Columns {
    /// The thesis's tests of single trials.
    pub as_in_the_thesis: Rate,
    /// The test that decides the hypothesis.
    pub deciding: Rate,
    /// The same with Holm's correction over the study's hypotheses.
    pub deciding_holm: Rate,
    /// Min F', of other clips too, where ratings are compared within people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_f: Option<Rate>,
    /// The linear mixed model, of other clips too, where it decides or was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed: Option<Rate>,
}

/// A difference with the unit of the answers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SmallestDifference {
    /// The difference; of choices, how far the share of choices lies above 1/2.
    pub value: f64,
    /// Its unit.
    pub unit: EffectUnit,
}

/// A share of positive tests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rate {
    /// Runs with p below alpha.
    pub positive: u64,
    /// All runs.
    pub runs: u64,
    /// Runs whose test was undefined; they count as not positive.
    pub undefined: u64,
    /// positive / runs.
    pub share: f64,
    /// Wilson's 95 % interval.
    pub interval: [f64; 2],
}

/// Why power cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum PowerError {
    /// The study names no hypothesis.
    #[error("/hypotheses: the study has none; name what is tested, with its response and factors")]
    NoHypotheses,
    /// A hypothesis is about answers to two clips at once.
    #[error("{place}: {}; {}", .problem.message(), .problem.remedy())]
    OfPair {
        /// Its place in the study file.
        place: String,
        /// What is wrong.
        problem: Box<Problem>,
    },
    /// Nothing can be simulated.
    #[error("{0}")]
    Parameters(#[from] ParametersError),
    /// There is no order of trials.
    #[error("{0}")]
    Order(#[from] OrderError),
    /// A number that cannot be.
    #[error("{option}: {value} is not possible; give {remedy}")]
    Option {
        /// Which option.
        option: &'static str,
        /// Its value.
        value: String,
        /// What to give.
        remedy: &'static str,
    },
}

/// What one run found: people used, and the p-values of each hypothesis.
struct Run {
    people: usize,
    found: Vec<Found>,
}

#[derive(Clone, Copy)]
struct Found {
    scope: ClipScope,
    smallest: Option<SmallestDifference>,
    thesis: Option<f64>,
    deciding: Option<f64>,
    holm: Option<f64>,
    /// Of other clips too: whether it was tested, and p.
    min_f: Option<Option<f64>>,
    mixed: Option<Option<f64>>,
}

/// Simulates and tests. `config_hash` is that of the study's file (with the study's seed it decides the
/// orders of trials); `progress` is told each finished run, from any thread. The result depends on the
/// arguments alone, not on the number of threads.
pub fn power(
    study: &Study,
    config_hash: &str,
    parameters: &Parameters,
    options: &PowerOptions,
    progress: &(dyn Fn() + Sync),
) -> Result<Power, PowerError> {
    check(study, options)?;
    parameters.check(study)?;
    let precision = precision::precision(study, config_hash, parameters, options, progress)?;
    let null = parameters.without_effects(study);
    let effects: Vec<bool> =
        study.hypotheses.iter().map(|each| parameters.has_effect(study, each)).collect();
    let most = options.participants.iter().copied().max().unwrap_or(0);
    let mut points = Vec::new();
    let numbers =
        if study.hypotheses.is_empty() { Vec::new() } else { clip_numbers(study, options) };
    for clips in numbers {
        let design = Design::new(study, config_hash, most, clips)?;
        let model = design.model(parameters);
        let null_model = without_effects_too(study, options).then(|| design.model(&null));
        for &participants in &options.participants {
            let all = |model: &Model<'_>, purpose: &str| -> Vec<Run> {
                let run = |run: usize| {
                    let seed = run_seed(options.seed, purpose, run);
                    let tests = if options.mixed {
                        OtherClipsTests::All
                    } else {
                        OtherClipsTests::Deciding
                    };
                    let result =
                        one_run(study, &design, model, seed, participants, tests, options.alpha);
                    progress();
                    result
                };
                (0..options.runs).into_par_iter().map(run).collect()
            };
            let with = all(&model, "with effects");
            let without = null_model.as_ref().map(|model| all(model, "without effects"));
            let hypotheses = study
                .hypotheses
                .iter()
                .enumerate()
                .map(|(place, hypothesis)| {
                    let columns = |runs: &Vec<Run>| columns(runs, place, options.alpha);
                    let without = without.as_ref().map(columns);
                    // What equivalence finds is that there is no difference.
                    let equal = without.filter(|_| hypothesis.test == TestName::Equivalence);
                    HypothesisPower {
                        id: hypothesis.id.clone(),
                        scope: with[0].found[place].scope,
                        smallest_difference: smallest_difference(&with, place),
                        effect: effects[place] || equal.is_some(),
                        power: equal.unwrap_or_else(|| columns(&with)),
                        false_positives: without
                            .filter(|_| options.false_positives && equal.is_none()),
                    }
                })
                .collect();
            points.push(PowerPoint {
                participants,
                clips: design.clips.clips.len(),
                segments: segments(&design),
                people_used: mean_people(&with),
                hypotheses,
            });
        }
    }
    Ok(Power {
        study: study.id.clone(),
        runs: options.runs,
        seed: options.seed,
        alpha: options.alpha,
        points,
        precision,
    })
}

/// Numbers of clips to simulate; none stands for the study's own.
fn clip_numbers(study: &Study, options: &PowerOptions) -> Vec<Option<usize>> {
    let own = study.clips().len();
    match options.clips.as_slice() {
        [] => vec![None],
        given => given.iter().map(|&clips| (clips != own).then_some(clips)).collect(),
    }
}

/// Segments of a design's clips.
fn segments(design: &Design<'_>) -> usize {
    let segments = design.clips.clips.iter().map(|clip| clip.segment.as_str());
    segments.collect::<std::collections::BTreeSet<_>>().len()
}

fn mean_people(runs: &[Run]) -> f64 {
    runs.iter().map(|run| run.people as f64).sum::<f64>() / runs.len() as f64
}

/// Whether the study is simulated without the effects of its hypotheses too: for false positives, and for the power of
/// a hypothesis of equivalence.
fn without_effects_too(study: &Study, options: &PowerOptions) -> bool {
    let equivalence = |hypothesis: &Hypothesis| hypothesis.test == TestName::Equivalence;
    options.false_positives || study.hypotheses.iter().any(equivalence)
}

/// How many runs [`power`] makes.
pub fn power_runs(study: &Study, options: &PowerOptions) -> u64 {
    let kinds = if without_effects_too(study, options) { 2 } else { 1 };
    let points = match study.hypotheses.is_empty() {
        true => 0,
        false => options.participants.len() * options.clips.len().max(1),
    };
    (points * options.runs * kinds + precision::simulated(study, options)) as u64
}

fn check(study: &Study, options: &PowerOptions) -> Result<(), PowerError> {
    if study.hypotheses.is_empty() && precision::blocks(study).is_empty() {
        return Err(PowerError::NoHypotheses);
    }
    for (index, hypothesis) in study.hypotheses.iter().enumerate() {
        if let Some(of_pair) = of_pair(study, hypothesis) {
            let place = format!("/hypotheses/{index}/factors");
            return Err(PowerError::OfPair { place, problem: Box::new(of_pair.into()) });
        }
    }
    let wrong = |option, value: String, remedy| Err(PowerError::Option { option, value, remedy });
    if let Some(n) = options.participants.iter().find(|n| !(2..=100_000).contains(*n)) {
        return wrong("participants", n.to_string(), "2 to 100000");
    }
    if options.participants.is_empty() {
        return wrong("participants", "nothing".to_owned(), "numbers of people");
    }
    if let Some(n) = options.clips.iter().find(|n| !(2..=10_000).contains(*n)) {
        return wrong("clips", n.to_string(), "2 to 10000");
    }
    if !(1..=1_000_000).contains(&options.runs) {
        return wrong("runs", options.runs.to_string(), "1 to 1000000");
    }
    if !(options.alpha > 0.0 && options.alpha < 1.0) {
        return wrong("alpha", options.alpha.to_string(), "a number between 0 and 1");
    }
    Ok(())
}

/// The seed of one run. Runs of one number share it over numbers of people, so that more people are the
/// same ones and further ones: curves are smoother than with people of their own at each point.
fn run_seed(seed: u64, purpose: &str, run: usize) -> u64 {
    let mut draws = Draws::new(seed, Some(run as u64), &format!("run {purpose}"));
    (draws.unit() * (1_u64 << 53) as f64) as u64
}

fn one_run(
    study: &Study,
    design: &Design<'_>,
    model: &Model<'_>,
    seed: u64,
    participants: usize,
    tests: OtherClipsTests,
    alpha: f64,
) -> Run {
    let export = design.answers(model, seed, participants);
    let naming = Naming { language: Language::English, study };
    let mut found: Vec<Found> = study
        .hypotheses
        .iter()
        .map(|hypothesis| {
            let result = test_hypothesis(&naming, &export, study, hypothesis, tests);
            let smallest = detected(&result, alpha, SMALLEST_DIFFERENCE_POWER);
            let thesis = thesis_p(hypothesis, &result.as_in_the_thesis.tests);
            let clips = result.other_clips.as_ref();
            Found {
                thesis,
                scope: result.scope,
                smallest: smallest.map(|(value, unit)| SmallestDifference { value, unit }),
                deciding: result.p,
                holm: None,
                min_f: clips.and_then(|found| found.min_f.as_ref().map(TestOutcome::p)),
                mixed: clips.and_then(|found| match found.linear_model.as_ref()? {
                    Outcome::Ok(model) => Some(Some(model.p)),
                    Outcome::Undefined { .. } => Some(None),
                }),
            }
        })
        .collect();
    let p: Vec<Option<f64>> = found.iter().map(|found| found.deciding).collect();
    for (found, holm) in found.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        found.holm = holm;
    }
    Run { people: export.flow.people_used, found }
}

/// The mean over the simulated studies that can be tested.
fn smallest_difference(runs: &[Run], place: usize) -> Option<SmallestDifference> {
    let all: Vec<SmallestDifference> =
        runs.iter().filter_map(|run| run.found[place].smallest).collect();
    let unit = all.first()?.unit;
    let value = all.iter().map(|own| own.value).sum::<f64>() / all.len() as f64;
    Some(SmallestDifference { value, unit })
}

/// The p that the thesis would have decided by: the interaction of two factors, the one test, or the
/// smallest of several pairs (it did not correct them).
fn thesis_p(hypothesis: &Hypothesis, tests: &[TestOutcome]) -> Option<f64> {
    if is_two_way(hypothesis.test) {
        return tests.last().and_then(Outcome::p);
    }
    tests.iter().filter_map(Outcome::p).reduce(f64::min)
}

fn columns(runs: &[Run], place: usize, alpha: f64) -> Columns {
    // A test of other clips that some run has is one of the hypothesis; a run without it is undefined.
    let tested = |p: fn(&Found) -> Option<Option<f64>>| {
        runs.iter().any(|run| p(&run.found[place]).is_some())
    };
    let rate = |p: fn(&Found) -> Option<f64>| {
        let all = runs.iter().map(|run| p(&run.found[place]));
        let positive = all.clone().flatten().filter(|p| *p < alpha).count() as u64;
        let undefined = all.filter(Option::is_none).count() as u64;
        let estimate = proportion(positive, runs.len() as u64);
        Rate {
            positive,
            runs: runs.len() as u64,
            undefined,
            share: estimate.proportion.unwrap_or(0.0),
            interval: estimate.wilson.unwrap_or([0.0, 1.0]),
        }
    };
    Columns {
        as_in_the_thesis: rate(|found| found.thesis),
        deciding: rate(|found| found.deciding),
        deciding_holm: rate(|found| found.holm),
        min_f: tested(|found| found.min_f).then(|| rate(|found| found.min_f.flatten())),
        mixed: tested(|found| found.mixed).then(|| rate(|found| found.mixed.flatten())),
    }
}
