//! Adaptive blocks: what is varied, between which levels, by which rule, and which question tells right from wrong.

use mimique_adaptive::{QuestPlus, Staircase};

use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::read_block;
use super::{Subject, compared, levels};
use crate::closed_loop::{grid, staircase};
use crate::columns::{LEVEL_COLUMNS, WEIGHTS_EXPECTED_COLUMN};
use crate::question::QuestionKind;
use crate::study_file::{AdaptiveBlock, AdaptiveComponent, PsychometricFunction, Varied};

/// Most levels of a block: each is solved before the study is served.
const MOST_LEVELS: f64 = 201.0;
/// Most clips of levels of a block: levels times segments.
const MOST_CLIPS: usize = 1000;
/// Most trials of a track, and most tracks.
const MOST_TRIALS: f64 = 1000.0;
const MOST_TRACKS: f64 = 8.0;

/// The higher a low-pass, the less it can be seen.
const FALLS: &str = "lowpassHz";

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &AdaptiveBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let Some(block) = read_block(block.read(), pointer, issues) else { return };
    let before = issues.count();
    ranges(&block, pointer, issues);
    let named = [("method", &block.method), ("against", &block.against)];
    let parameter = (block.vary.parameter.as_str(), "vary/parameter");
    levels::names(subject, &named, (&block.avatar, &block.segments), parameter, pointer, issues);
    let falls = block.vary.from > block.vary.to;
    if block.vary.parameter == FALLS && !falls {
        let parameter = block.vary.parameter.clone();
        issues.error(below(pointer, "vary"), Problem::LevelsRise { parameter });
    }
    let function = block.rule.quest_plus.as_ref().map(|rule| rule.function);
    if falls && function == Some(PsychometricFunction::Weibull) {
        issues.error(below(pointer, "rule"), Problem::WeibullFalls);
    }
    let columns: Vec<_> = LEVEL_COLUMNS.into_iter().chain([WEIGHTS_EXPECTED_COLUMN]).collect();
    compared::columns(subject, &columns, pointer, issues);
    question(subject, &block, pointer, issues);
    if issues.count() > before {
        return;
    }
    rule(&block, pointer, issues);
    clips(subject, &block, pointer, issues);
}

fn ranges(block: &AdaptiveComponent, pointer: &str, issues: &mut Issues) {
    let mut range = |key: &str, value: f64, unit, least: f64, most: f64| {
        if !(least..=most).contains(&value) {
            let place = format!("{pointer}/{key}");
            issues.error(place, Problem::OutOfRange { value, unit, least, most });
        }
    };
    range("trials", f64::from(block.trials), "trials", 1.0, MOST_TRIALS);
    range("tracks", f64::from(block.tracks), "tracks", 1.0, MOST_TRACKS);
    range("catch", block.catch, "of the trials", 0.0, 0.5);
    range("vary/levels", f64::from(block.vary.levels), "levels", 3.0, MOST_LEVELS);
    let Varied { from, to, .. } = block.vary;
    if from == to {
        issues.error(below(pointer, "vary"), Problem::OneLevel { level: from });
    }
    if let Some(stop) = block.stop_sd {
        if block.rule.staircase.is_some() {
            issues.error(below(pointer, "stopSd"), Problem::StopOfStaircase);
        } else if stop <= 0.0 || !stop.is_finite() {
            issues.error(below(pointer, "stopSd"), Problem::StopNotPositive { stop });
        }
    }
}

fn question(subject: &Subject<'_>, block: &AdaptiveComponent, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "question");
    let shared = &subject.study.questions;
    let Some(question) = shared.iter().find(|each| each.id == block.question) else {
        let known = shared.iter().map(|each| &each.id);
        issues.error(place, Problem::unknown("question", &block.question, known));
        return;
    };
    let is_plain =
        question.required && question.show_if.is_none() && question.attention_check.is_none();
    let name = || block.question.clone();
    let Some(yes) = &block.yes else {
        let tells = matches!(&question.kind, QuestionKind::Comparison(kind) if !kind.allow_same);
        if !tells || !is_plain {
            issues.error(place, Problem::NotTwoSides { question: name() });
        }
        return;
    };
    match &question.kind {
        QuestionKind::SingleChoice(kind)
            if is_plain && kind.options.len() == 2 && kind.truth.is_none() =>
        {
            if !kind.options.iter().any(|option| option.value == *yes) {
                let values = kind.options.iter().map(|option| option.value.as_str());
                issues.error(below(pointer, "yes"), Problem::unknown("option", yes, values));
            }
        }
        _ => issues.error(place, Problem::NotYesOrNo { question: name() }),
    }
    if block.catches() == 0 {
        issues.error(below(pointer, "catch"), Problem::YesWithoutCatchTrials);
    }
}

fn rule(block: &AdaptiveComponent, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "rule");
    match (&block.rule.quest_plus, &block.rule.staircase) {
        (Some(rule), None) => {
            let place = below(&place, "questPlus");
            let [_, _, count] = rule.threshold;
            if count.fract() != 0.0 || !(2.0..=1000.0).contains(&count) {
                let place = below(&below(&place, "threshold"), 2);
                let unit = "thresholds";
                let problem = Problem::OutOfRange { value: count, unit, least: 2.0, most: 1000.0 };
                issues.error(place, problem);
            } else if let Err(error) = QuestPlus::new(grid(rule, block)) {
                issues.error(place, Problem::LevelGrid { what: error.to_string() });
            }
        }
        (None, Some(rule)) => {
            let place = below(&place, "staircase");
            if let Err(error) = Staircase::new(staircase(rule, &block.vary)) {
                issues.error(place, Problem::LevelGrid { what: error.to_string() });
                return;
            }
            let apart = (block.vary.to - block.vary.from) / f64::from(block.vary.levels - 1);
            let is_between = |length: f64| {
                let steps = length / apart;
                (steps - steps.round()).abs() > 1e-6
            };
            let start = rule.start.unwrap_or(block.vary.to) - block.vary.from;
            let lengths = rule.steps.iter().copied().chain([start]);
            if let Some(length) = lengths.into_iter().find(|length| is_between(*length)) {
                issues.error(place, Problem::BetweenLevels { length, apart });
            }
        }
        _ => issues.error(place, Problem::OneRule),
    }
}

fn clips(subject: &Subject<'_>, block: &AdaptiveComponent, pointer: &str, issues: &mut Issues) {
    let study = subject.study;
    let (parameter, levels) = (&block.vary.parameter, [block.vary.from, block.vary.to]);
    let place = below(pointer, "vary");
    if !levels::are_solved(subject, (&block.method, parameter), &levels, &place, issues) {
        return;
    }
    let segments = match block.segments.len() {
        0 => study.stimuli.segments.len(),
        named => named,
    };
    let has_both = study
        .adaptive()
        .find(|(name, _)| below("/components", name) == pointer)
        .map_or(0, |(_, block)| block.shown.len());
    if has_both < segments {
        let against = block.against.clone();
        issues.error(below(pointer, "against"), Problem::NothingAgainst { against });
    }
    let clips = segments * block.vary.levels as usize;
    if clips > MOST_CLIPS {
        let problem = Problem::TooManyLevels { clips, most: MOST_CLIPS };
        issues.error(below(&below(pointer, "vary"), "levels"), problem);
    }
}
