//! Adaptive blocks in the report: the threshold of each person by a psychometric function, and the mean of people.

mod figure;
mod section;

use mimique_adaptive::{Shape, Track};
use mimique_stats::{
    Description, Lapse, LevelCount, Outcome, PsychometricFit, PsychometricOptions,
    bootstrap_through, describe, psychometric,
};
use mimique_study::{AdaptiveComponent, ClosedLoop, Draw, PsychometricFunction, Study, Varied};
use serde::Serialize;

use crate::trials::export::{Answer, Export, ShownLevel};

/// Runs of the rule, with answers drawn from the fitted function, for an interval.
pub(crate) const ROUNDS: usize = 1000;

/// The thresholds of an adaptive block.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BlockThresholds {
    /// Name of the component.
    pub block: String,
    /// Its question.
    #[serde(skip)]
    pub question: String,
    /// The varied parameter.
    pub parameter: String,
    /// Its lowest and highest level.
    pub levels: [f64; 2],
    /// Whether people say yes or no: nobody is then right by chance, and catch trials show no difference.
    #[serde(skip_serializing_if = "is_false")]
    pub yes_no: bool,
    /// Whether levels fall from the hardest to the easiest: fitted functions are then of minus the level.
    #[serde(skip_serializing_if = "is_false")]
    pub falls: bool,
    pub people: Vec<PersonThreshold>,
    /// Mean of the thresholds that lie within the levels, with its t interval.
    pub mean: Outcome<Description>,
}

fn is_false(flag: &bool) -> bool {
    !flag
}

/// What the answers of one person give.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PersonThreshold {
    /// `participant_id`.
    pub participant: String,
    /// Answers that count, of all tracks.
    pub answers: usize,
    /// Catch trials, and those answered right.
    pub catches: [usize; 2],
    pub threshold: Threshold,
    /// 95 % interval of the threshold: the rule run anew with answers of the fitted function.
    pub interval: Option<[f64; 2]>,
    /// The fitted function.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit: Option<PsychometricFit>,
    #[serde(skip)]
    pub shown: Vec<ShownAnswer>,
}

/// Where a threshold lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) enum Threshold {
    /// Within the levels.
    At(f64),
    /// Above the highest level.
    Above(f64),
    /// Below the lowest level.
    Below(f64),
    /// Right answers begin between two levels: the function is a step.
    Between([f64; 2]),
    /// Fewer than three levels were visited, or the answers tell of none.
    Unknown,
    /// Seed and answers do not give the levels that were recorded.
    NotReplayed,
}

/// One answer of a track, in order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShownAnswer {
    pub track: usize,
    pub level: f64,
    pub right: bool,
}

/// The thresholds of every adaptive block whose question was answered; intervals by `rounds` runs of the rule, none of
/// them: no intervals.
pub(crate) fn thresholds(export: &Export, study: &Study, rounds: usize) -> Vec<BlockThresholds> {
    let of = |(name, block): (&str, AdaptiveComponent)| {
        let answers = export.answers_to(&block.question);
        let people: Vec<PersonThreshold> = (0..export.people.len())
            .filter(|person| export.people[*person].excluded.is_none())
            .filter_map(|person| {
                let own = answers.iter().filter(|answer| answer.person == person);
                let own: Vec<(&Answer, &ShownLevel)> =
                    own.filter_map(|answer| level_of(export, answer, name)).collect();
                (!own.is_empty()).then(|| {
                    let seed = study.seed ^ (person as u64 + 1);
                    of_person(&export.people[person].id, &own, (name, &block), (rounds, seed))
                })
            })
            .collect();
        let found = people.iter().filter_map(|person| match person.threshold {
            Threshold::At(level) => Some(level),
            _ => None,
        });
        let mean = describe(&found.collect::<Vec<f64>>());
        let parameter = block.vary.parameter.clone();
        let levels = ends(&block.vary);
        let falls = block.vary.from > block.vary.to;
        let question = block.question.clone();
        let (block, yes_no) = (name.to_owned(), block.yes.is_some());
        BlockThresholds { block, question, parameter, levels, yes_no, falls, people, mean }
    };
    let all = study.adaptive().map(of);
    all.filter(|block| !block.people.is_empty()).collect()
}

fn level_of<'e>(
    export: &'e Export,
    answer: &'e Answer,
    block: &str,
) -> Option<(&'e Answer, &'e ShownLevel)> {
    let level = export.trials[answer.trial].level.as_ref()?;
    (&*level.block == block).then_some((answer, level))
}

fn of_person(
    participant: &str,
    answers: &[(&Answer, &ShownLevel)],
    (name, block): (&str, &AdaptiveComponent),
    (rounds, seed): (usize, u64),
) -> PersonThreshold {
    let mut catches = [0, 0];
    let mut shown = Vec::new();
    for (answer, level) in answers {
        let Some(right) = answer.correct else { continue };
        if level.catch {
            catches[0] += 1;
            catches[1] += usize::from(right);
        } else {
            shown.push(ShownAnswer { track: level.track, level: level.level, right });
        }
    }
    let is_replayed = answers.iter().all(|(_, level)| level.replayed);
    let counts = counts(&shown, &block.vary);
    let options = options(block);
    let fit = psychometric(&counts, &options).ok();
    let (threshold, fit) = match fit {
        _ if !is_replayed => (Threshold::NotReplayed, None),
        Some(Outcome::Ok(fit)) => (placed(fit.level_at_half, block), Some(fit)),
        Some(Outcome::Undefined { .. }) => (without_fit(&counts, block), None),
        None => (Threshold::Unknown, None),
    };
    let interval = fit.as_ref().filter(|_| rounds > 0).and_then(|fit| {
        let tracks = tracks(name, block)?;
        let drawn = bootstrap_through(&tracks, &options, &fit.psychometric(), rounds, seed)?;
        Some(ascending(drawn.level_at_half.map(|ease| block.vary.ease(ease))))
    });
    let participant = participant.to_owned();
    let answers = shown.len();
    PersonThreshold { participant, answers, catches, threshold, interval, fit, shown }
}

/// Answers level by level, by [`Varied::ease`].
pub(super) fn counts(shown: &[ShownAnswer], vary: &Varied) -> Vec<LevelCount> {
    let mut counts: Vec<LevelCount> = Vec::new();
    for answer in shown {
        let (level, right) = (vary.ease(answer.level), u64::from(answer.right));
        match counts.iter_mut().find(|own| own.level == level) {
            Some(own) => (own.n, own.correct) = (own.n + 1, own.correct + right),
            None => counts.push(LevelCount { level, n: 1, correct: right }),
        }
    }
    counts.sort_by(|one, other| one.level.total_cmp(&other.level));
    counts
}

fn ascending([one, other]: [f64; 2]) -> [f64; 2] {
    [one.min(other), one.max(other)]
}

/// The lowest and the highest level.
pub(super) fn ends(vary: &Varied) -> [f64; 2] {
    ascending([vary.from, vary.to])
}

fn options(block: &AdaptiveComponent) -> PsychometricOptions {
    let function = block.rule.quest_plus.as_ref().map(|rule| rule.function).unwrap_or_default();
    let shape = match function {
        PsychometricFunction::Normal => Shape::Normal,
        PsychometricFunction::Logistic => Shape::Logistic,
        PsychometricFunction::Weibull => Shape::Weibull,
    };
    PsychometricOptions { shape, guess: block.guess(), lapse: Lapse::Free }
}

/// Where a level lies, by [`Varied::ease`].
fn placed(ease: f64, block: &AdaptiveComponent) -> Threshold {
    let (level, [lowest, highest]) = (block.vary.ease(ease), ends(&block.vary));
    if level > highest {
        Threshold::Above(highest)
    } else if level < lowest {
        Threshold::Below(lowest)
    } else {
        Threshold::At(level)
    }
}

/// Where the threshold lies if no function has a finite maximum: answers that are mostly right everywhere put it
/// before the hardest level, answers by chance everywhere behind the easiest, and a step between two of them.
fn without_fit(counts: &[LevelCount], block: &AdaptiveComponent) -> Threshold {
    let share = |own: &LevelCount| own.correct as f64 / own.n as f64;
    let half = 0.5 * (1.0 + block.guess());
    let right = |own: &&LevelCount| share(own) > half;
    let all: (u64, u64) =
        counts.iter().fold((0, 0), |(n, right), own| (n + own.n, right + own.correct));
    let first = counts.iter().position(|own| right(&own));
    match first {
        None => placed(f64::INFINITY, block),
        Some(0) if all.1 as f64 > half * all.0 as f64 => placed(f64::NEG_INFINITY, block),
        Some(at) if at > 0 && counts[at..].iter().all(|own| right(&own)) => {
            let step = [counts[at - 1].level, counts[at].level];
            Threshold::Between(ascending(step.map(|ease| block.vary.ease(ease))))
        }
        Some(_) => Threshold::Unknown,
    }
}

/// The tracks of a block before their first answer.
fn tracks(name: &str, block: &AdaptiveComponent) -> Option<Vec<Track>> {
    let draw = Draw { seed: 0, config_hash: "", participant: 0, condition: None };
    let closed_loop = ClosedLoop::new(block.clone(), name, draw).ok()?;
    Some(closed_loop.tracks().to_vec())
}
