//! Blocks of panels: the conditions of a page, its reference and anchor, and the scale on which they are rated.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::read_block;
use super::{Subject, compared};
use crate::columns::PANEL_COLUMNS;
use crate::question::QuestionKind;
use crate::study_file::{PanelBlock, PanelComponent};

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &PanelBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let Some(block) = read_block(block.read(), pointer, issues) else { return };
    let before = issues.count();
    compared::clips(subject, block.compares(), pointer, issues);
    scale(subject, &block, pointer, issues);
    compared::columns(subject, &PANEL_COLUMNS, pointer, issues);
    if issues.count() == before {
        conditions(subject, &block, pointer, issues);
    }
}

/// Every clip is rated from 0 to 100.
fn scale(subject: &Subject<'_>, block: &PanelComponent, pointer: &str, issues: &mut Issues) {
    let shared = &subject.study.questions;
    let place = below(pointer, "question");
    let Some(question) = shared.iter().find(|each| each.id == block.question) else {
        let known = shared.iter().map(|each| &each.id);
        issues.error(place, Problem::unknown("question", &block.question, known));
        return;
    };
    let is_scale = matches!(
        &question.kind,
        QuestionKind::Slider(line)
            if [line.minimum, line.maximum] == [0.0, 100.0] && !line.while_playing
    );
    if !is_scale || question.show_if.is_some() || question.attention_check.is_some() {
        issues.error(place, Problem::NoScale { question: block.question.clone() });
    }
}

/// Every page has every condition; reference and anchor are among them.
fn conditions(subject: &Subject<'_>, block: &PanelComponent, pointer: &str, issues: &mut Issues) {
    let conditions = block.conditions(subject.clips);
    let (fewest, most) = (PanelComponent::FEWEST_CONDITIONS, PanelComponent::MOST_CONDITIONS);
    if !(fewest..=most).contains(&conditions.len()) {
        let conditions = conditions.len();
        issues.error(below(pointer, "levels"), Problem::Conditions { conditions, fewest, most });
        return;
    }
    for (key, level) in [("reference", &block.reference), ("anchor", &block.anchor)] {
        let Some(level) = level.as_ref().filter(|level| !conditions.contains(level)) else {
            continue;
        };
        let problem =
            Problem::NoCondition { level: level.clone(), conditions: conditions.join(", ") };
        issues.error(below(pointer, key), problem);
    }
    if let Some(level) = block.anchor.as_ref().filter(|_| block.anchor == block.reference) {
        issues.error(below(pointer, "anchor"), Problem::ReferenceIsAnchor { level: level.clone() });
    }
    if block.exclude.is_some() && block.reference.is_none() {
        issues.error(below(pointer, "exclude"), Problem::ScreensByReference);
    }
    match block.trials(subject.clips) {
        Err(why) => compared::no_cells(why, pointer, issues),
        Ok(trials) => {
            let pages = trials.panel.filter(|panel| !panel.in_turn).map(|panel| panel.pages);
            let pages = pages.iter().flatten().map(|page| page.clips.as_slice());
            compared::one_sound(subject, pages, pointer, issues);
        }
    }
}
