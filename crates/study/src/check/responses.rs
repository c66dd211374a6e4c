//! What hypotheses and tables take: answers to questions of trials, by their names in the export.

use std::borrow::Cow;

use super::Subject;
use super::issue::Issues;
use super::problem::Problem;
use crate::question::Question;
use crate::study_file::{Sequence, SequenceItem, Study, TrialsComponent};

/// The question that gives an answer of this name.
pub(super) fn question<'s>(study: &'s Study, response: &str) -> Option<&'s Question> {
    study.all_questions().find(|question| question.response_ids().iter().any(|id| id == response))
}

/// The same, if it is asked in trials; what is wrong with the name at `place` is reported.
/// `of_conditions`: conditions are compared, each of which is looked at by itself.
pub(super) fn tested<'s>(
    subject: &Subject<'s>,
    response: &str,
    place: String,
    of_conditions: bool,
    issues: &mut Issues,
) -> Option<&'s Question> {
    let study = subject.study;
    let question = named(study, response, &place, issues)?;
    if study.is_asked_of_levels(&question.id) {
        issues.error(place, Problem::LevelsFollowAnswers { question: question.id.clone() });
        return None;
    }
    if study.is_asked_of_scales(&question.id) {
        issues.error(place, Problem::JudgesDifferences { question: question.id.clone() });
        return None;
    }
    if study.is_asked_of_drawn_faces(&question.id) {
        issues.error(place, Problem::DrawnAtRandom { question: question.id.clone() });
        return None;
    }
    if !of_conditions && is_asked_in_no_trial(study, &question.id) {
        issues.error(place, Problem::AskedInNoTrial { question: question.id.clone() });
        return None;
    }
    Some(question)
}

/// The question that gives an answer of this name; what is wrong with the name at `place` is reported.
pub(super) fn named<'s>(
    study: &'s Study,
    response: &str,
    place: &str,
    issues: &mut Issues,
) -> Option<&'s Question> {
    let Some(question) = question(study, response) else {
        if let Some(whole) = study.all_questions().find(|question| question.id == response) {
            issues.error(
                place,
                Problem::SeveralAnswers {
                    response: response.to_owned(),
                    answers: format!("\"{}\"", whole.response_ids().join("\", \"")),
                },
            );
            return None;
        }
        let known: Vec<String> = study.all_questions().flat_map(Question::response_ids).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        issues.error(place, Problem::unknown("question", response, known));
        return None;
    };
    Some(question)
}

/// Whether a trial that a condition is shown asks a question.
pub(super) fn is_asked(study: &Study, condition: &str, question: &str) -> bool {
    let blocks = trials(study, &study.sequence, Some(condition));
    blocks.into_iter().any(|block| asks(&block, question))
}

/// Whether trials are shown, and none of them, to nobody, asks a question.
fn is_asked_in_no_trial(study: &Study, question: &str) -> bool {
    let shown_to = study.conditions().into_iter().map(Some).chain([None]);
    let blocks: Vec<_> =
        shown_to.flat_map(|condition| trials(study, &study.sequence, condition)).collect();
    !blocks.is_empty() && !blocks.iter().any(|block| asks(block, question))
}

/// The blocks of trials that a condition is shown.
fn trials<'s>(
    study: &'s Study,
    sequence: &Sequence,
    condition: Option<&str>,
) -> Vec<Cow<'s, TrialsComponent>> {
    let of = |item: &SequenceItem| match item {
        SequenceItem::Sequence(nested) if nested.is_shown_in(condition) => {
            trials(study, nested, condition)
        }
        SequenceItem::Sequence(_) => Vec::new(),
        SequenceItem::Component(name) => study.trial_block(name).into_iter().collect(),
    };
    sequence.components.iter().flat_map(of).collect()
}

fn asks(block: &TrialsComponent, question: &str) -> bool {
    block.questions.iter().any(|id| id == question)
}
