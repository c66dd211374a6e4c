//! Blocks of pairs: what is compared, within what, which pairs are dealt, and which question chooses.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::read_block;
use super::values::Counted;
use super::{Subject, compared};
use crate::columns::PAIR_COLUMNS;
use crate::question::{KindOfQuestion as _, QuestionKind};
use crate::study_file::{ClipShowing, NoPairs, PairRule, PairsBlock, PairsComponent};

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &PairsBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let Some(block) = read_block(block.read(), pointer, issues) else { return };
    let before = issues.count();
    compared::clips(subject, block.compares(), pointer, issues);
    questions(subject, &block, pointer, issues);
    compared::columns(subject, &PAIR_COLUMNS, pointer, issues);
    if issues.count() == before {
        dealt(subject, &block, pointer, issues);
    }
    if issues.count() == before
        && block.show == ClipShowing::InStep
        && let Ok(trials) = block.trials(subject.clips)
    {
        let levels = block.compared(subject.clips).len().max(1);
        let clips = trials.pairs.map_or_else(Vec::new, |pairs| pairs.clips);
        compared::one_sound(subject, clips.chunks(levels), pointer, issues);
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

/// Every cell has every level, and the pairs are dealt evenly.
fn dealt(subject: &Subject<'_>, block: &PairsComponent, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "schedule");
    match (block.schedule.rule, block.schedule.per_participant) {
        (PairRule::Incomplete | PairRule::Active, None) => {
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
        Err(NoPairs::Cells(why)) => compared::no_cells(why, pointer, issues),
        Ok(balance) => {
            let [least, most] = balance.pair_in_cell;
            if most - least > 1 || balance.items_of_slot > 1 {
                issues.error(
                    place,
                    Problem::UnevenPairs {
                        least: Counted(least, "time"),
                        most: Counted(most, "time"),
                    },
                );
            }
        }
    }
}
