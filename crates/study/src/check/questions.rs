//! Questions: identifiers, options, scales, right answers.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::issue::{Issues, below};
use super::problem::Problem;
use super::reverse_correlation::shared;
use super::values::{Names, Nearest};
use super::{Subject, attention, conditions};
use crate::columns::is_reserved_column;
use crate::question::{KindOfQuestion as _, Question, QuestionKind, defining};
use crate::study_file::{Component, TrialsComponent};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let mut pages: Vec<(String, &[Question])> = Vec::new();
    if let Some(page) = &study.demographics {
        pages.push(("/demographics/questions".to_owned(), &page.questions));
    }
    pages.push(("/questions".to_owned(), &study.questions));
    for (name, component) in &study.components {
        if let Component::Questionnaire(page) = component {
            pages.push((format!("{}/questions", below("/components", name)), &page.questions));
        }
    }
    let mut seen: BTreeMap<&str, String> = BTreeMap::new();
    for (pointer, questions) in &pages {
        for (index, question) in questions.iter().enumerate() {
            let place = below(pointer, index);
            identifier(subject, question, &place, issues);
            if let Some(first) = seen.insert(&question.id, place.clone()) {
                issues.error(
                    below(&place, "id"),
                    Problem::QuestionTwice { id: question.id.clone(), first },
                );
            }
            question.kind.check(&place, issues);
            let (keyed, traced) = (question.kind.keys().is_some(), question.kind.is_traced());
            if (keyed || traced) && pointer != "/questions" {
                let problem = Problem::WithoutClip { question: question.id.clone() };
                let key = if keyed { "keys" } else { "whilePlaying" };
                issues.error(below(&place, key), problem);
            }
            signs(question, &place, issues);
            attention::examine(subject, question, &place, issues);
        }
    }
    conditions::examine(subject, issues);
    for (index, question) in study.questions.iter().enumerate() {
        let blocks = blocks_asking(subject, &question.id);
        let in_training =
            study.training.iter().any(|training| training.questions.contains(&question.id));
        if blocks.is_empty() && !in_training && !subject.study.is_asked_of_no_clip(&question.id) {
            issues.warning(
                below("/questions", index),
                Problem::NeverAsked { id: question.id.clone() },
            );
        }
        let practised_alone = study.training.iter().any(|training| {
            let alone = |clip: &String| !training.beside.contains_key(clip);
            training.questions.contains(&question.id) && training.clips.iter().any(alone)
        });
        if question.kind.compares_clips()
            && (practised_alone || blocks.iter().any(|block| !block.shows_two()))
        {
            issues.error(
                below("/questions", index),
                Problem::ComparesOneClip { id: question.id.clone() },
            );
        }
        truth(subject, question, &blocks, &below("/questions", index), issues);
        confidence(subject, question, &below("/questions", index), issues);
    }
}

/// The blocks that ask a question.
fn blocks_asking<'a>(subject: &'a Subject<'_>, id: &str) -> Vec<Cow<'a, TrialsComponent>> {
    let blocks = subject.study.trial_blocks().into_iter().map(|(_, block)| block);
    blocks.filter(|block| block.questions.iter().any(|each| each == id)).collect()
}

fn identifier(subject: &Subject<'_>, question: &Question, place: &str, issues: &mut Issues) {
    let pointer = below(place, "id");
    let id = &question.id;
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    if id.is_empty() || !id.chars().all(plain) {
        issues.error(pointer, Problem::QuestionId { id: id.clone() });
        return;
    }
    let is_column = is_reserved_column(id);
    let is_factor = subject.clips.iter().any(|clip| clip.factors.contains_key(id));
    if is_column || is_factor {
        let by = if is_factor { "a factor" } else { "a column of every export" };
        issues.error(pointer, Problem::NameTaken { id: id.clone(), by });
    }
}

fn signs(question: &Question, place: &str, issues: &mut Issues) {
    defining::options(&question.signs, place, "signs", 0, issues);
    for (index, sign) in question.signs.iter().enumerate() {
        let pointer = below(&below(place, "signs"), index);
        if sign.video.is_none() && sign.image.is_none() {
            issues.error(pointer, Problem::EmptySign { value: sign.value.clone() });
        } else if let Some(sides) = question.kind.sign_values()
            && !sides.contains(&sign.value.as_str())
        {
            let known = Nearest::to(&sign.value, &sides);
            let problem = Problem::NoSide { value: sign.value.clone(), known };
            issues.error(below(&pointer, "value"), problem);
        }
    }
}

/// How sure a choice is, an ordered rating says that is asked in every trial that asks for the choice.
fn confidence(subject: &Subject<'_>, question: &Question, place: &str, issues: &mut Issues) {
    let Some(id) = question.kind.confidence() else { return };
    let pointer = below(place, "confidence");
    if question.kind.truth().is_none() {
        issues.error(&pointer, Problem::SureOfNoTruth { question: question.id.clone() });
    }
    let Some(rating) = shared(subject, id, &pointer, issues) else { return };
    let is_ordered = match &rating.kind {
        QuestionKind::Likert(_) => true,
        QuestionKind::Slider(line) => !line.while_playing,
        _ => false,
    };
    if !is_ordered || rating.show_if.is_some() || rating.attention_check.is_some() {
        issues.error(pointer, Problem::NoConfidence { question: rating.id.clone() });
        return;
    }
    let asks = |block: &TrialsComponent, id: &str| block.questions.iter().any(|each| each == id);
    for (component, block) in subject.study.trial_blocks() {
        if asks(&block, &question.id) && !asks(&block, id) {
            let (rating, component) = (rating.id.clone(), component.to_owned());
            let question = question.id.clone();
            issues.error(&pointer, Problem::SureElsewhere { rating, question, component });
        }
    }
}

/// The right answer must be among the options, for every clip that is asked about.
fn truth(
    subject: &Subject<'_>,
    question: &Question,
    blocks: &[Cow<'_, TrialsComponent>],
    place: &str,
    issues: &mut Issues,
) {
    let Some(factor) = question.kind.truth() else { return };
    let pointer = below(place, "truth");
    let options = question.kind.options();
    let values: Vec<&str> = options.iter().map(|option| option.value.as_str()).collect();
    let names = subject.study.factor_names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    if !names.contains(&factor) {
        issues.error(pointer, Problem::unknown("factor", factor, &names));
        return;
    }
    let mut strange = BTreeSet::new();
    for clip in subject.clips {
        if !blocks.iter().any(|block| block.clips.takes(clip)) {
            continue;
        }
        match clip.factor_text(factor) {
            None => {
                issues.error(
                    &pointer,
                    Problem::NoTruth { clip: clip.id.clone(), factor: factor.to_owned() },
                );
            }
            Some(truth) if !values.contains(&truth.as_str()) && strange.insert(truth.clone()) => {
                issues.error(
                    &pointer,
                    Problem::TruthNoOption {
                        clip: clip.id.clone(),
                        truth,
                        options: Names::of(&values),
                    },
                );
            }
            Some(_) => {}
        }
    }
}
