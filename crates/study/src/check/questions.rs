//! Questions: identifiers, options, scales, right answers.

use std::collections::{BTreeMap, BTreeSet};

use super::issue::{Issues, below, listed};
use super::nearest::suggestion;
use super::{Subject, attention, conditions};
use crate::responses::is_reserved_column;
use crate::study_file::{Choice, Component, LocalText, Question, QuestionKind, TrialsComponent};

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
                let message = format!("\"{}\" is the identifier of {first} already", question.id);
                issues.error(below(&place, "id"), "duplicate", message, "give it another one");
            }
            kind(question, &place, issues);
            signs(question, &place, issues);
            attention::examine(subject, question, &place, issues);
        }
    }
    conditions::examine(subject, issues);
    for (index, question) in study.questions.iter().enumerate() {
        let blocks: Vec<&TrialsComponent> = blocks_asking(subject, &question.id).collect();
        let in_training =
            study.training.iter().any(|training| training.questions.contains(&question.id));
        if blocks.is_empty() && !in_training {
            let message = format!("\"{}\" is never asked", question.id);
            let hint = "name it in the questions of a trials component, or remove it";
            issues.warning(below("/questions", index), "unused-question", message, hint);
        }
        if matches!(question.kind, QuestionKind::Comparison(_))
            && (in_training || blocks.iter().any(|block| block.beside.is_none()))
        {
            let message = format!("\"{}\" compares two clips, and only one is shown", question.id);
            let hint = "ask it in trials components that have \"beside\"";
            issues.error(below("/questions", index), "no-companion", message, hint);
        }
        truth(subject, question, &blocks, &below("/questions", index), issues);
    }
}

/// The blocks that ask a question.
fn blocks_asking<'a>(
    subject: &'a Subject<'_>,
    id: &'a str,
) -> impl Iterator<Item = &'a TrialsComponent> {
    subject.study.components.values().filter_map(move |component| match component {
        Component::Trials(block) if block.questions.iter().any(|each| each == id) => Some(block),
        _ => None,
    })
}

fn identifier(subject: &Subject<'_>, question: &Question, place: &str, issues: &mut Issues) {
    let pointer = below(place, "id");
    let id = &question.id;
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    if id.is_empty() || !id.chars().all(plain) {
        let message = format!("\"{id}\" cannot be the name of a column");
        issues.error(pointer, "bad-id", message, "use letters, digits, _ and -");
        return;
    }
    let is_column = is_reserved_column(id);
    let is_factor = subject.clips.iter().any(|clip| clip.factors.contains_key(id));
    if is_column || is_factor {
        let what = if is_factor { "a factor" } else { "a column of every export" };
        let message = format!("\"{id}\" is the name of {what} already");
        issues.error(pointer, "name-taken", message, format!("call it \"perceived_{id}\", say"));
    }
}

fn kind(question: &Question, place: &str, issues: &mut Issues) {
    match &question.kind {
        QuestionKind::SingleChoice(choice) => options(&choice.options, place, "options", 2, issues),
        QuestionKind::MultipleChoice(choice) => {
            options(&choice.options, place, "options", 1, issues);
            let count = choice.options.len();
            let (least, most) = (choice.minimum.unwrap_or(0), choice.maximum.unwrap_or(count));
            if least > most || most > count {
                let message = format!("{least} to {most} of {count} options cannot be chosen");
                let hint = "mend minimum and maximum";
                issues.error(place, "bad-range", message, hint);
            }
        }
        QuestionKind::Ranking(ranking) => options(&ranking.options, place, "options", 2, issues),
        QuestionKind::Matrix(matrix) => {
            options(&matrix.rows, place, "rows", 1, issues);
            options(&matrix.options, place, "options", 2, issues);
        }
        QuestionKind::Likert(scale) => {
            points(scale.num_items, place, issues);
            let labels = scale.labels.len();
            if labels > 0 && labels != scale.num_items as usize {
                let message = format!("{labels} labels for {} points", scale.num_items);
                let hint = "write one label a point, or leave labels out";
                issues.error(below(place, "labels"), "wrong-length", message, hint);
            } else if labels == 0 {
                ends(&scale.left_label, &scale.right_label, place, issues);
            }
        }
        QuestionKind::Slider(slider) => {
            ends(&slider.left_label, &slider.right_label, place, issues);
            range(Some(slider.minimum), Some(slider.maximum), place, issues);
            if slider.step <= 0.0 || slider.step > slider.maximum - slider.minimum {
                let message = format!("a step of {} leads nowhere", slider.step);
                let hint = "take a step above 0 and no longer than the line";
                issues.error(below(place, "step"), "out-of-range", message, hint);
            }
        }
        QuestionKind::Number(field) => range(field.minimum, field.maximum, place, issues),
        QuestionKind::ShortText(field) | QuestionKind::LongText(field) => {
            if field.max_length == Some(0) {
                let message = "no text can be written";
                let hint = "take a maxLength above 0";
                issues.error(below(place, "maxLength"), "out-of-range", message, hint);
            }
        }
        QuestionKind::ValenceArousal(grid) => points(grid.num_items, place, issues),
        QuestionKind::Comparison(_) => {}
    }
}

fn signs(question: &Question, place: &str, issues: &mut Issues) {
    options(&question.signs, place, "signs", 0, issues);
    for (index, sign) in question.signs.iter().enumerate() {
        let pointer = below(&below(place, "signs"), index);
        if sign.video.is_none() && sign.image.is_none() {
            let message = format!("\"{}\" has neither a signed video nor a picture", sign.value);
            let hint = "add \"video\": \"FILE.mp4\", or remove it";
            issues.error(pointer, "empty", message, hint);
        } else if let QuestionKind::Comparison(comparison) = &question.kind {
            let mut sides = vec!["left", "right"];
            sides.extend(comparison.allow_same.then_some("same"));
            if !sides.contains(&sign.value.as_str()) {
                let message = format!("\"{}\" is no option of this comparison", sign.value);
                let hint = suggestion(&sign.value, &sides);
                issues.error(below(&pointer, "value"), "unknown-reference", message, hint);
            }
        }
    }
}

fn points(count: u32, place: &str, issues: &mut Issues) {
    if !(2..=101).contains(&count) {
        let message = format!("a scale of {count} points");
        issues.error(below(place, "numItems"), "out-of-range", message, "take 2 to 101");
    }
}

fn ends(left: &Option<LocalText>, right: &Option<LocalText>, place: &str, issues: &mut Issues) {
    let missing: Vec<&str> = [("leftLabel", left), ("rightLabel", right)]
        .into_iter()
        .filter(|(_, label)| label.is_none())
        .map(|(key, _)| key)
        .collect();
    if !missing.is_empty() {
        let message = format!("a scale without ends: no {}", missing.join(", no "));
        let hint = format!("say what its ends mean: \"{}\": \"...\"", missing[0]);
        issues.error(place, "scale-without-ends", message, hint);
    }
}

fn range(minimum: Option<f64>, maximum: Option<f64>, place: &str, issues: &mut Issues) {
    if let (Some(least), Some(most)) = (minimum, maximum)
        && least >= most
    {
        let message = format!("from {least} to {most} there is nothing to choose");
        issues.error(place, "bad-range", message, "make the maximum larger than the minimum");
    }
}

fn options(options: &[Choice], place: &str, key: &str, least: usize, issues: &mut Issues) {
    let pointer = below(place, key);
    if options.len() < least {
        let message = format!("{} of at least {least}", options.len());
        issues.error(&pointer, "too-few", message, "add what can be chosen");
    }
    for (index, option) in options.iter().enumerate() {
        let place = below(&below(&pointer, index), "value");
        if option.value.trim().is_empty() || option.value.contains('|') {
            let message = format!("\"{}\" cannot be a value", option.value);
            issues.error(place, "bad-id", message, "write a word without |");
        } else if options[..index].iter().any(|each| each.value == option.value) {
            let message = format!("\"{}\" is the value of two", option.value);
            issues.error(place, "duplicate", message, "give each its own value");
        }
    }
}

/// The right answer must be among the options, for every clip that is asked about.
fn truth(
    subject: &Subject<'_>,
    question: &Question,
    blocks: &[&TrialsComponent],
    place: &str,
    issues: &mut Issues,
) {
    let QuestionKind::SingleChoice(choice) = &question.kind else { return };
    let Some(factor) = &choice.truth else { return };
    let pointer = below(place, "truth");
    let values: Vec<&str> = choice.options.iter().map(|option| option.value.as_str()).collect();
    let names = subject.study.factor_names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    if !names.contains(&factor.as_str()) {
        let message = format!("there is no factor \"{factor}\"");
        issues.error(pointer, "unknown-reference", message, suggestion(factor, &names));
        return;
    }
    let mut strange = BTreeSet::new();
    for clip in subject.clips {
        if !blocks.iter().any(|block| block.clips.takes(clip)) {
            continue;
        }
        match clip.factor_text(factor) {
            None => {
                let message = format!("clip \"{}\" has no factor \"{factor}\"", clip.id);
                let hint = "give its segment that factor, or leave the clip out of the block";
                issues.error(&pointer, "no-truth", message, hint);
            }
            Some(truth) if !values.contains(&truth.as_str()) && strange.insert(truth.clone()) => {
                let message =
                    format!("the truth of clip \"{}\" is \"{truth}\", no option", clip.id);
                let hint = format!("add that option; there is {}", listed(&values));
                issues.error(&pointer, "no-truth", message, hint);
            }
            Some(_) => {}
        }
    }
}
