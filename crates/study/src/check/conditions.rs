//! `showIf`: a question that is asked before, whose answer is kept, and an answer that can be given.
//! The values of a screening rule are checked here too.

use std::cmp::Ordering;

use serde_json::Value;

use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Known;
use super::{Subject, between};
use crate::question::{Condition, KindOfQuestion as _, Question};
use crate::study_file::{Component, OrderRule, Sequence, SequenceItem};

/// Where a question is asked.
#[derive(Clone, Copy)]
enum Asked<'a> {
    Demographics,
    Practice,
    /// A page of questions or a block of trials.
    Component(&'a str),
}

/// Why an answer is not known when the question that wants it comes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Unknown {
    AskedLater,
    PerhapsLater,
    Elsewhere,
    NotKept,
}

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let demographics = study.demographics.iter().flat_map(|page| &page.questions).enumerate();
    for (index, question) in demographics {
        let place = below("/demographics/questions", index);
        condition(subject, question, &[Asked::Demographics], &place, issues);
    }
    for (index, question) in study.questions.iter().enumerate() {
        let place = below("/questions", index);
        condition(subject, question, &asked(subject, &question.id), &place, issues);
    }
    for (name, component) in &study.components {
        let Component::Questionnaire(page) = component else { continue };
        let pointer = below(&below("/components", name), "questions");
        for (index, question) in page.questions.iter().enumerate() {
            let place = below(&pointer, index);
            condition(subject, question, &[Asked::Component(name)], &place, issues);
        }
    }
}

/// Where a shared question is asked.
fn asked<'a>(subject: &Subject<'a>, id: &str) -> Vec<Asked<'a>> {
    let names = |ids: &[String]| ids.iter().any(|each| each == id);
    let practice = subject.study.training.iter().filter(|it| names(&it.questions));
    let asks = |name: &str| subject.study.questions_of(name).iter().any(|each| each.id == id);
    let blocks = subject.study.components.iter().filter(|(_, component)| component.is_block());
    let blocks = blocks.filter(|(name, _)| asks(name));
    practice
        .map(|_| Asked::Practice)
        .chain(blocks.map(|(name, _)| Asked::Component(name.as_str())))
        .collect()
}

fn condition(
    subject: &Subject<'_>,
    question: &Question,
    asked: &[Asked<'_>],
    place: &str,
    issues: &mut Issues,
) {
    let Some(condition) = &question.show_if else { return };
    let place = below(place, "showIf");
    let wanted = condition.question.as_str();
    let Some(of) = subject.study.all_questions().find(|each| each.id == wanted) else {
        issues.error(
            below(&place, "question"),
            Problem::unknown(
                "question",
                wanted,
                subject.study.all_questions().map(|each| &each.id),
            ),
        );
        return;
    };
    for &here in asked {
        let place = below(&place, "question");
        match known_before(subject, here, &question.id, wanted) {
            Ok(()) => {}
            Err(Unknown::AskedLater) => {
                issues.error(place, Problem::AskedLater { question: wanted.to_owned() });
            }
            Err(Unknown::PerhapsLater) => {
                issues.warning(place, Problem::PerhapsLater { question: wanted.to_owned() });
            }
            Err(Unknown::Elsewhere) => {
                issues.error(place, Problem::OtherCondition { question: wanted.to_owned() });
            }
            Err(Unknown::NotKept) => {
                issues.error(place, Problem::NotKept { question: wanted.to_owned() });
            }
        }
    }
    values(condition, of, &place, Asks::Next, issues);
}

/// Whether the answer to `wanted` is known where `id` is asked.
fn known_before(
    subject: &Subject<'_>,
    here: Asked<'_>,
    id: &str,
    wanted: &str,
) -> Result<(), Unknown> {
    let study = subject.study;
    let page = |questions: &[Question]| questions.iter().map(|each| each.id.clone()).collect();
    let together: Vec<String> = match here {
        Asked::Demographics => study.demographics.as_ref().map(|it| page(&it.questions)),
        Asked::Practice => study.training.as_ref().map(|it| it.questions.clone()),
        Asked::Component(name) => match study.components.get(name) {
            Some(Component::Questionnaire(it)) => Some(page(&it.questions)),
            _ => Some(study.questions_of(name).iter().map(|each| each.id.clone()).collect()),
        },
    }
    .unwrap_or_default();
    let place = |id: &str| together.iter().position(|each| each == id);
    if let Some(before) = place(wanted) {
        return if Some(before) < place(id) { Ok(()) } else { Err(Unknown::AskedLater) };
    }
    if study.demographics.iter().flat_map(|it| &it.questions).any(|each| each.id == wanted) {
        return Ok(());
    }
    let asks = |component: &Component| match component {
        Component::Questionnaire(page) => page.questions.iter().any(|each| each.id == wanted),
        _ => false,
    };
    let Some((there, _)) = study.components.iter().find(|(_, component)| asks(component)) else {
        return Err(Unknown::NotKept);
    };
    let Asked::Component(here) = here else { return Err(Unknown::AskedLater) };
    // Somebody to whom one of the two is not shown has no order of them.
    let way = |name: &str, condition| path(&study.sequence, name, condition);
    let both = |condition| way(there, condition).zip(way(here, condition));
    let known =
        between::each(study).into_iter().filter_map(both).map(|(there, here)| {
            match first(&there, &here) {
                Some(Ordering::Less) => Ok(()),
                None => Err(Unknown::PerhapsLater),
                Some(_) => Err(Unknown::AskedLater),
            }
        });
    known.reduce(Result::and).unwrap_or(Err(match study.conditions().is_empty() {
        true => Unknown::AskedLater,
        false => Unknown::Elsewhere,
    }))
}

/// The way to a component: in each sequence its order and the place in it; no place where the
/// component interrupts the sequence.
type Way = Vec<(OrderRule, Option<usize>)>;

fn path(sequence: &Sequence, name: &str, condition: Option<&str>) -> Option<Way> {
    for (index, item) in sequence.components.iter().enumerate() {
        let rest = match item {
            SequenceItem::Component(other) => (other == name).then(Vec::new),
            SequenceItem::Sequence(nested) if !nested.is_shown_in(condition) => None,
            SequenceItem::Sequence(nested) => path(nested, name, condition),
        };
        if let Some(rest) = rest {
            return Some([vec![(sequence.order, Some(index))], rest].concat());
        }
    }
    let interrupts = sequence.interruptions.iter().any(|each| each.component == name);
    interrupts.then(|| vec![(sequence.order, None)])
}

/// Which of two comes first; `None` where that is drawn.
fn first(left: &Way, right: &Way) -> Option<Ordering> {
    let ((order, left), (_, right)) = left.iter().zip(right).find(|(left, right)| left != right)?;
    let (left, right) = left.as_ref().zip(right.as_ref())?;
    (*order == OrderRule::Fixed).then(|| left.cmp(right))
}

/// What a condition on an answer decides.
#[derive(Clone, Copy)]
pub(super) enum Asks {
    /// Whether a question is asked.
    Next,
    /// Whom the study takes.
    Whom,
}

/// The values of a condition: there are some, and they can be answers to the question.
pub(super) fn values(
    condition: &Condition,
    question: &Question,
    place: &str,
    asks: Asks,
    issues: &mut Issues,
) {
    let bounds = [condition.at_least, condition.at_most];
    if condition.equals.is_none() && condition.one_of.is_empty() && bounds == [None, None] {
        issues.error(place, Problem::EmptyCondition);
    }
    let id = &question.id;
    answers(condition, question, place, issues);
    let Some([least, most]) = question.kind.bounds() else {
        if bounds != [None, None] {
            issues.error(place, Problem::AnswersNoNumbers { question: id.clone() });
        }
        return;
    };
    if let (Some(at_least), Some(at_most)) = (condition.at_least, condition.at_most)
        && at_least > at_most
    {
        issues.error(place, Problem::BoundsCross { least: at_least, most: at_most });
    }
    let too_low = condition.at_most.zip(least).filter(|(at_most, least)| at_most < least);
    let too_high = condition.at_least.zip(most).filter(|(at_least, most)| at_least > most);
    if let Some((bound, end)) = too_low.or(too_high) {
        let question = id.clone();
        let problem = match asks {
            Asks::Next => Problem::NeverReached { question, end, bound },
            Asks::Whom => Problem::NeverSaid { question, end, bound },
        };
        issues.error(place, problem);
    }
}

/// The answers that a condition names can be given.
fn answers(condition: &Condition, question: &Question, place: &str, issues: &mut Issues) {
    let id = &question.id;
    let options: Vec<&str> =
        question.kind.options().iter().map(|option| option.value.as_str()).collect();
    let several = question.kind.takes_several();
    let no_answer = |value: &Value| Problem::NoAnswerTo {
        answer: value.clone(),
        question: id.clone(),
        known: Known::of(&options),
    };
    for value in &condition.one_of {
        // One of several choices is enough.
        let fits = match several {
            true => value.as_str().is_some_and(|word| options.contains(&word)),
            false => can_be_given(question, value),
        };
        if !fits {
            issues.error(place, no_answer(value));
        }
    }
    if let Some(value) = condition.equals.as_ref().filter(|value| !can_be_given(question, value)) {
        let problem = match several && value.is_string() {
            true => Problem::NotTheWholeAnswer { answer: value.clone(), question: id.clone() },
            false => no_answer(value),
        };
        issues.error(place, problem);
    }
}

/// Whether somebody can give this answer; 3.0 is 3.
fn can_be_given(question: &Question, value: &Value) -> bool {
    let whole = value.as_f64().filter(|number| number.fract() == 0.0 && number.abs() < 9e15);
    let value = whole.map_or_else(|| value.clone(), |number| (number as i64).into());
    let required = Question { required: true, ..question.clone() };
    required.accept(Some(&value)).is_ok()
}
