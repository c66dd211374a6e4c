//! Answers counted: by option where there are options, as a summary where there are numbers.

use std::collections::BTreeMap;

use mimique_study::{Choice, Component, KindOfQuestion as _, Question, Study, Summary};
use serde_json::Value;

/// How the answers to one question are distributed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Distribution {
    pub question: String,
    pub prompt: String,
    pub shape: Shape,
}

/// What can be shown of the answers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shape {
    /// Label and count of each option, in the order of the study.
    Counts(Vec<(String, u64)>),
    /// Number of answers, least, mean, greatest.
    Numbers { count: u64, least: f64, mean: f64, greatest: f64 },
    /// Texts are read in the export; here they are only counted.
    Texts(u64),
}

/// The distribution of every question of the study, in the order of the file.
pub(crate) fn distributions<'a>(
    study: &Study,
    language: &str,
    answers: impl Iterator<Item = &'a (String, Value)>,
) -> Vec<Distribution> {
    let mut by_question: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    for (question, answer) in answers {
        by_question.entry(question).or_default().push(answer);
    }
    let mut found = Vec::new();
    for question in questions(study) {
        let prompt = question.prompt.in_language(language).to_owned();
        // Rows of a matrix and axes of a grid are responses of their own: `id.row`.
        let prefix = format!("{}.", question.id);
        for (id, answers) in &by_question {
            if *id == question.id || id.starts_with(&prefix) {
                found.push(Distribution {
                    question: (*id).to_owned(),
                    prompt: prompt.clone(),
                    shape: shape(question, language, answers),
                });
            }
        }
    }
    found
}

fn questions(study: &Study) -> Vec<&Question> {
    let pages = study.components.values().filter_map(|component| match component {
        Component::Questionnaire(page) => Some(&page.questions),
        _ => None,
    });
    let demographics = study.demographics.iter().map(|page| &page.questions);
    let all = demographics.chain([&study.questions]).chain(pages).flatten();
    let mut seen = std::collections::BTreeSet::new();
    all.filter(|question| seen.insert(&question.id)).collect()
}

fn shape(question: &Question, language: &str, answers: &[&Value]) -> Shape {
    match question.kind.summary() {
        Summary::Points(points) => {
            counts(points.map(|point| (point.to_string(), point.to_string())), answers)
        }
        Summary::Options => {
            let label = |option: &Choice| option.label.in_language(language).to_owned();
            let options = question.kind.options().iter();
            counts(options.map(|option| (option.value.clone(), label(option))), answers)
        }
        Summary::Texts => Shape::Texts(answers.len() as u64),
        Summary::Numbers => numbers(answers),
    }
}

fn counts(options: impl Iterator<Item = (String, String)>, answers: &[&Value]) -> Shape {
    let mut by_value: BTreeMap<String, u64> = BTreeMap::new();
    for answer in answers {
        let text = answer.as_str().map_or_else(|| answer.to_string(), str::to_owned);
        // Several choices stand in one cell, joined by a bar.
        for value in text.split('|') {
            *by_value.entry(value.to_owned()).or_default() += 1;
        }
    }
    let mut counts: Vec<(String, u64)> =
        options.map(|(value, label)| (label, by_value.remove(&value).unwrap_or(0))).collect();
    // Options of an earlier version of the study.
    counts.extend(by_value);
    Shape::Counts(counts)
}

fn numbers(answers: &[&Value]) -> Shape {
    let values: Vec<f64> = answers.iter().filter_map(|answer| answer.as_f64()).collect();
    if values.is_empty() {
        return Shape::Texts(answers.len() as u64);
    }
    Shape::Numbers {
        count: values.len() as u64,
        least: values.iter().copied().fold(f64::INFINITY, f64::min),
        mean: values.iter().sum::<f64>() / values.len() as f64,
        greatest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn options_are_counted_in_the_order_of_the_study() {
        let options = [("a", "A"), ("b", "B"), ("c", "C")];
        let options = options.map(|(value, label)| (value.to_owned(), label.to_owned()));
        let answers = [json!("b|a"), json!("b"), json!("gone")];
        let shape = counts(options.into_iter(), &answers.iter().collect::<Vec<_>>());
        let expected = [("A", 1), ("B", 2), ("C", 0), ("gone", 1)];
        let expected = expected.map(|(label, count)| (label.to_owned(), count));
        assert_eq!(shape, Shape::Counts(expected.to_vec()));
    }

    #[test]
    fn numbers_are_summarised() {
        let answers = [json!(1), json!(2.5), json!(4)];
        let shape = numbers(&answers.iter().collect::<Vec<_>>());
        assert_eq!(shape, Shape::Numbers { count: 3, least: 1.0, mean: 2.5, greatest: 4.0 });
    }
}
