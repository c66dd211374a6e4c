//! Blocks of difference scaling: the levels, their method, and the question that says which of two pairs differ more.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::read_block;
use super::values::Counted;
use super::{Subject, compared, levels, reverse_correlation};
use crate::columns::{SCALING_COLUMNS, WEIGHTS_EXPECTED_COLUMN};
use crate::question::{KindOfQuestion as _, OptionOrder, QuestionKind};
use crate::study_file::{Component, ScalingBlock, ScalingComponent};

/// Fewest and most levels of a scale.
const LEVELS: std::ops::RangeInclusive<usize> = 5..=11;
/// Most trials of a block.
const MOST_TRIALS: f64 = 2000.0;

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &ScalingBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let Some(block) = read_block(block.read(), pointer, issues) else { return };
    let before = issues.count();
    let trials = f64::from(block.trials);
    if !(1.0..=MOST_TRIALS).contains(&trials) {
        let problem =
            Problem::OutOfRange { value: trials, unit: "trials", least: 1.0, most: MOST_TRIALS };
        issues.error(below(pointer, "trials"), problem);
    }
    let place = below(pointer, "levels");
    let count = block.levels.len();
    if !LEVELS.contains(&count) {
        let (fewest, most) = (*LEVELS.start(), *LEVELS.end());
        issues.error(&place, Problem::LevelCount { levels: Counted(count, "level"), fewest, most });
    } else if !block.levels.is_sorted_by(|one, next| one < next) {
        issues.error(&place, Problem::LevelsNotAscending);
    }
    let named = [("method", &block.method)];
    let parameter = (block.parameter.as_str(), "parameter");
    levels::names(subject, &named, (&block.avatar, &block.segments), parameter, pointer, issues);
    question(subject, &block, pointer, issues);
    let columns: Vec<_> = SCALING_COLUMNS.into_iter().chain([WEIGHTS_EXPECTED_COLUMN]).collect();
    compared::columns(subject, &columns, pointer, issues);
    if issues.count() == before {
        let of = (block.method.as_str(), block.parameter.as_str());
        levels::are_solved(subject, of, &block.levels, &place, issues);
    }
}

fn question(subject: &Subject<'_>, block: &ScalingComponent, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "question");
    let Some(question) = reverse_correlation::shared(subject, &block.question, &place, issues)
    else {
        return;
    };
    let kind = &question.kind;
    let is_choice = matches!(kind, QuestionKind::SingleChoice(_)) && kind.options().len() == 2;
    let is_in_order = kind.option_order() != OptionOrder::Random && kind.keys().is_none();
    let is_whole = question.required && question.show_if.is_none();
    let is_plain = kind.truth().is_none() && question.attention_check.is_none();
    if !(is_choice && is_in_order && is_whole && is_plain) {
        issues.error(&place, Problem::NoJudgement { question: question.id.clone() });
    }
    let is_scaling = |component: &Component| matches!(component, Component::Scaling(_));
    reverse_correlation::asked_elsewhere(subject, question, is_scaling, &place, issues);
}
