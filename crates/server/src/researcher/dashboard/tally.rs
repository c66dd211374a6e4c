//! Answers counted: by option where there are options, as a summary where there are numbers. Tallies of many
//! people are those of each, added up.

use std::collections::{BTreeMap, BTreeSet};

use mimique_study::{Choice, Component, KindOfQuestion as _, Question, Study, Summary};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The answers to one question, or to a part of one, without what was written in words.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Tally {
    /// How often each option was chosen, or each point of a scale.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    values: BTreeMap<String, u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    numbers: Option<Numbers>,
    /// Texts are read in the export; here they are only counted.
    #[serde(skip_serializing_if = "is_zero")]
    texts: u64,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// Numbers, summed up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Numbers {
    pub count: u64,
    pub least: f64,
    pub sum: f64,
    pub greatest: f64,
}

/// How the answers to a response are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Counting {
    Values,
    Numbers,
    Texts,
}

impl Counting {
    /// How those to each response of a study are counted, by the response.
    pub fn of(study: &Study) -> BTreeMap<String, Self> {
        let of = |question: &Question| match question.kind.summary() {
            Summary::Points(_) | Summary::Options | Summary::Sides(_) => Self::Values,
            Summary::Numbers => Self::Numbers,
            Summary::Texts => Self::Texts,
        };
        questions(study)
            .into_iter()
            .flat_map(|question| {
                question.response_ids().into_iter().map(move |id| (id, of(question)))
            })
            .collect()
    }
}

impl Tally {
    /// Adds an answer.
    pub(super) fn count(&mut self, answer: &Value, by: Counting) {
        match (by, answer.as_f64()) {
            (Counting::Values, _) => {
                let text = answer.as_str().map_or_else(|| answer.to_string(), str::to_owned);
                // Several choices stand in one cell, joined by a bar.
                for value in text.split('|') {
                    *self.values.entry(value.to_owned()).or_default() += 1;
                }
            }
            (Counting::Numbers, Some(number)) => {
                let one = Numbers { count: 1, least: number, sum: number, greatest: number };
                self.numbers = Some(self.numbers.map_or(one, |numbers| numbers.and(one)));
            }
            (Counting::Numbers | Counting::Texts, _) => self.texts += 1,
        }
    }

    /// Adds another tally.
    pub(super) fn add(&mut self, other: &Self) {
        for (value, count) in &other.values {
            *self.values.entry(value.clone()).or_default() += count;
        }
        if let Some(more) = other.numbers {
            self.numbers = Some(self.numbers.map_or(more, |numbers| numbers.and(more)));
        }
        self.texts += other.texts;
    }
}

impl Numbers {
    fn and(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            least: self.least.min(other.least),
            sum: self.sum + other.sum,
            greatest: self.greatest.max(other.greatest),
        }
    }
}

/// Under which name the levels that a question of pairs chose are counted, beside the sides.
pub(super) fn chosen_of(question: &str) -> String {
    format!("{question}.chosen")
}

/// Under which name the thresholds so far of an adaptive block are counted, one a person.
pub(super) fn threshold_of(question: &str) -> String {
    format!("{question}.threshold")
}

/// Under which name the levels are counted at which the staircases of an adaptive block stand, one a person.
pub(super) fn level_of(question: &str) -> String {
    format!("{question}.level")
}

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
    /// The numbers, summed up.
    Numbers(Numbers),
    /// Thresholds so far, one a person.
    Thresholds(Numbers),
    /// Where staircases stand, one a person.
    Levels(Numbers),
    /// How many texts there are.
    Texts(u64),
}

/// The distribution of every question of the study, in the order of the file.
pub(crate) fn distributions(
    study: &Study,
    language: &str,
    tallies: &BTreeMap<String, Tally>,
) -> Vec<Distribution> {
    let mut found = Vec::new();
    let clips = study.clips();
    for question in questions(study) {
        let chosen = chosen_of(&question.id);
        let (threshold, level) = (threshold_of(&question.id), level_of(&question.id));
        let pairs = study.pair_blocks().filter(|(_, block)| block.question == question.id);
        let levels: Vec<String> = pairs.flat_map(|(_, block)| block.compared(&clips)).collect();
        let prompt = question.prompt.in_language(language).to_owned();
        // Rows of a matrix and axes of a grid are responses of their own: `id.row`.
        let prefix = format!("{}.", question.id);
        for (id, tally) in tallies {
            if *id == question.id || id.starts_with(&prefix) {
                found.push(Distribution {
                    question: id.clone(),
                    prompt: prompt.clone(),
                    shape: match tally.numbers {
                        Some(numbers) if *id == threshold => Shape::Thresholds(numbers),
                        Some(numbers) if *id == level => Shape::Levels(numbers),
                        _ if *id == chosen && !levels.is_empty() => {
                            counts(once_each(&levels), tally)
                        }
                        _ => shape(question, language, tally),
                    },
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
    let mut seen = BTreeSet::new();
    all.filter(|question| seen.insert(&question.id)).collect()
}

fn shape(question: &Question, language: &str, tally: &Tally) -> Shape {
    match question.kind.summary() {
        Summary::Points(points) => {
            counts(points.map(|point| (point.to_string(), point.to_string())), tally)
        }
        Summary::Options => {
            let label = |option: &Choice| option.label.in_language(language).to_owned();
            let options = question.kind.options().iter();
            counts(options.map(|option| (option.value.clone(), label(option))), tally)
        }
        Summary::Sides(sides) => {
            let said = |side: &str| question.kind.answer_in_words(question, side, language);
            counts(sides.into_iter().map(|side| (side.to_owned(), said(side))), tally)
        }
        Summary::Numbers => tally.numbers.map_or(Shape::Texts(tally.texts), Shape::Numbers),
        Summary::Texts => Shape::Texts(tally.texts),
    }
}

/// Levels of a factor stand for themselves.
fn once_each(levels: &[String]) -> impl Iterator<Item = (String, String)> {
    let levels: BTreeSet<&String> = levels.iter().collect();
    levels.into_iter().map(|level| (level.clone(), level.clone()))
}

fn counts(options: impl Iterator<Item = (String, String)>, tally: &Tally) -> Shape {
    let mut by_value = tally.values.clone();
    let mut counts: Vec<(String, u64)> =
        options.map(|(value, label)| (label, by_value.remove(&value).unwrap_or(0))).collect();
    // Options of an earlier version of the study.
    counts.extend(by_value);
    Shape::Counts(counts)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn tally(by: Counting, answers: &[Value]) -> Tally {
        let mut all = Tally::default();
        for answer in answers {
            // Each is a person of their own: their tallies are added up.
            let mut one = Tally::default();
            one.count(answer, by);
            all.add(&one);
        }
        all
    }

    #[test]
    fn options_are_counted_in_the_order_of_the_study() {
        let options = [("a", "A"), ("b", "B"), ("c", "C")];
        let options = options.map(|(value, label)| (value.to_owned(), label.to_owned()));
        let tally = tally(Counting::Values, &[json!("b|a"), json!("b"), json!("gone")]);
        let expected = [("A", 1), ("B", 2), ("C", 0), ("gone", 1)];
        let expected = expected.map(|(label, count)| (label.to_owned(), count));
        assert_eq!(counts(options.into_iter(), &tally), Shape::Counts(expected.to_vec()));
    }

    #[test]
    fn choices_between_clips_have_a_bar_for_each_side() {
        let question = json!({ "id": "nearer", "type": "comparison", "allowSame": true,
            "prompt": "Which is nearer?" });
        let question: Question = serde_json::from_value(question).unwrap();
        let tally = tally(Counting::Values, &[json!("left"), json!("same"), json!("left")]);
        let Shape::Counts(bars) = shape(&question, "en", &tally) else { panic!("no bars") };
        let counts: Vec<u64> = bars.iter().map(|(_, count)| *count).collect();
        assert_eq!(counts, [2, 1, 0], "{bars:?}");
        assert!(bars[0].0.contains("left") && bars[2].0.contains("right"), "{bars:?}");
    }

    #[test]
    fn numbers_are_summed_up_and_texts_are_not_kept() {
        let numbers = tally(Counting::Numbers, &[json!(1), json!(2.5), json!(4)]).numbers;
        let expected = Numbers { count: 3, least: 1.0, sum: 7.5, greatest: 4.0 };
        assert_eq!(numbers, Some(expected));
        let texts = tally(Counting::Texts, &[json!("in private"), json!("so too")]);
        assert_eq!(serde_json::to_value(texts).unwrap(), json!({"texts": 2}));
    }
}
