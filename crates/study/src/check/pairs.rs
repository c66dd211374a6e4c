//! Blocks of pairs: what is compared, within what, which pairs are dealt, and which question chooses.

use std::collections::{BTreeMap, BTreeSet};

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::{all_factors, selection};
use super::values::Nearest;
use crate::columns::PAIR_COLUMNS;
use crate::question::{KindOfQuestion as _, QuestionKind};
use crate::study_file::{NoPairs, PairRule, PairShowing, PairsBlock, PairsComponent};

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &PairsBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let block = match block.read() {
        Ok(block) => block,
        Err(error) => {
            issues.error(pointer, Problem::Shape { what: error.to_string() });
            return;
        }
    };
    let before = issues.count();
    let factors = all_factors(subject);
    selection(subject, &block.clips, &factors, pointer, issues);
    compared(&block, &factors, pointer, issues);
    questions(subject, &block, pointer, issues);
    columns(subject, pointer, issues);
    showing(subject, &block, pointer, issues);
    if issues.count() == before {
        dealt(subject, &block, pointer, issues);
    }
}

/// What is compared, and what its clips are alike in.
fn compared(
    block: &PairsComponent,
    factors: &BTreeMap<String, BTreeSet<String>>,
    pointer: &str,
    issues: &mut Issues,
) {
    let unknown = |name: &str| Problem::unknown("factor", name, factors.keys());
    let levels = below(pointer, "levels");
    match factors.get(&block.compare) {
        None => issues.error(below(pointer, "compare"), unknown(&block.compare)),
        Some(known) => {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            for (index, level) in block.levels.iter().enumerate() {
                let place = below(&levels, index);
                if !known.contains(&level.as_str()) {
                    let factor = block.compare.clone();
                    let nearest = Nearest::to(level, &known);
                    let level = level.clone();
                    issues.error(place, Problem::NoClipWith { factor, level, known: nearest });
                } else if block.levels[..index].contains(level) {
                    issues.error(place, Problem::NamedTwice { name: level.clone() });
                }
            }
        }
    }
    for (index, name) in block.within.iter().enumerate() {
        let place = below(&below(pointer, "within"), index);
        if *name == block.compare {
            issues.error(place, Problem::ComparedWithin { factor: name.clone() });
        } else if !factors.contains_key(name) {
            issues.error(place, unknown(name));
        } else if block.within[..index].contains(name) {
            issues.error(place, Problem::NamedTwice { name: name.clone() });
        }
    }
}

fn questions(subject: &Subject<'_>, block: &PairsComponent, pointer: &str, issues: &mut Issues) {
    let shared = &subject.study.questions;
    for (key, name) in [("question", Some(&block.question)), ("reasons", block.reasons.as_ref())] {
        let (place, Some(name)) = (below(pointer, key), name) else { continue };
        let Some(question) = shared.iter().find(|each| each.id == *name) else {
            let problem = Problem::unknown("question", name, shared.iter().map(|each| &each.id));
            issues.error(place, problem);
            continue;
        };
        if key == "question" && !matches!(question.kind, QuestionKind::Comparison(_)) {
            issues.error(place, Problem::ChoosesNoClip { question: name.clone() });
        } else if key == "reasons" && question.kind.compares_clips() {
            issues.error(place, Problem::ReasonChooses { question: name.clone() });
        }
    }
}

/// Nothing of the study is called like a column that exports of such blocks have.
fn columns(subject: &Subject<'_>, pointer: &str, issues: &mut Issues) {
    let factors = subject.study.factor_names();
    let about = subject.study.demographics.iter().flat_map(|page| &page.questions);
    for name in factors.iter().chain(about.map(|question| &question.id)) {
        if PAIR_COLUMNS.iter().any(|(column, ..)| column == name) {
            issues.error(pointer, Problem::PairColumn { name: name.clone() });
        }
    }
}

/// Clips in turn have neither sound nor a clock of their own.
fn showing(subject: &Subject<'_>, block: &PairsComponent, pointer: &str, issues: &mut Issues) {
    if block.show == PairShowing::InStep {
        return;
    }
    let stimuli = &subject.study.stimuli;
    let place = below(pointer, "show");
    if !stimuli.sounds.is_empty() {
        issues.error(&place, Problem::InTurnWithSound);
    }
    let is_video = |clip: &&crate::study_file::Clip| {
        let avatar = stimuli.avatars.get(&clip.avatar);
        block.clips.takes(clip) && avatar.is_some_and(|avatar| !avatar.videos.is_empty())
    };
    if subject.clips.iter().any(|clip| is_video(&clip)) {
        issues.error(&place, Problem::InTurnWithVideo);
    }
}

/// Every cell has every level, and the pairs are dealt evenly.
fn dealt(subject: &Subject<'_>, block: &PairsComponent, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "schedule");
    match (block.schedule.rule, block.schedule.per_participant) {
        (PairRule::Incomplete, None) => {
            issues.error(&place, Problem::MissingKey { key: "perParticipant".to_owned() });
            return;
        }
        (PairRule::All, Some(_)) => {
            issues.error(below(&place, "perParticipant"), Problem::ShareOfAll);
            return;
        }
        _ => {}
    }
    let levels = block.compared(subject.clips).len();
    if levels < 2 {
        let factor = block.compare.clone();
        issues.error(below(pointer, "levels"), Problem::NothingToCompare { factor, levels });
        return;
    }
    match block.balance(subject.clips) {
        Err(NoPairs::Design(why)) => {
            issues.error(below(&place, "perParticipant"), Problem::NoDesign { why });
        }
        Err(why @ NoPairs::LevelMissing { .. }) => {
            issues.error(pointer, Problem::CellIncomplete { why });
        }
        Err(why @ NoPairs::LevelTwice { .. }) => {
            issues.error(below(pointer, "within"), Problem::CellAmbiguous { why });
        }
        Ok(balance) => {
            let [least, most] = balance.pair_in_cell;
            if most - least > 1 || balance.items_of_slot > 1 {
                issues.error(place, Problem::UnevenPairs { least, most });
            }
        }
    }
}
