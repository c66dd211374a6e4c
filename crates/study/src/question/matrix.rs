//! One choice in each of several rows.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, Summary, Told, label, pick};
use super::simulation::{Chance, Simulated};
use super::view::{QuestionKindView, Showing};
use super::{Choice, Question, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::text::Words;

/// One choice in each of several rows. The answer is an object from row to option.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Matrix {
    /// The rows.
    pub rows: Vec<Choice>,
    /// The options of each row.
    pub options: Vec<Choice>,
}

impl KindOfQuestion for Matrix {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.rows, place, "rows", 1, issues);
        defining::options(&self.options, place, "options", 2, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        let map = answer.as_object().ok_or(AnswerProblem::NotAnOption)?;
        for (row, chosen) in map {
            if !self.rows.iter().any(|each| each.value == *row) {
                return Err(AnswerProblem::NotAnOption);
            }
            accepting::one_of(&self.options, chosen)?;
        }
        if map.len() < self.rows.len() { Err(AnswerProblem::Incomplete) } else { Ok(()) }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        let rows = showing.choices(&self.rows);
        QuestionKindView::Matrix { rows, options: showing.options() }
    }

    fn described(&self, language: &str) -> String {
        pick(language, "one choice a row", "un choix par ligne").to_owned()
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Drawn { by_shares: false }
    }

    fn drawn(&self, _weights: &[f64], chance: &mut dyn Chance) -> Value {
        let rows = self.rows.iter().map(|row| {
            let option = &self.options[chance.below(self.options.len())];
            (row.value.clone(), option.value.as_str().into())
        });
        Value::Object(rows.collect())
    }

    fn options(&self) -> &[Choice] {
        &self.options
    }

    fn rows(&self) -> &[Choice] {
        &self.rows
    }

    fn parts(&self) -> Option<Vec<&str>> {
        Some(self.rows.iter().map(|row| row.value.as_str()).collect())
    }

    fn is_numeric(&self) -> bool {
        self.options.iter().all(|option| option.value.parse::<f64>().is_ok())
    }

    fn summary(&self) -> Summary {
        Summary::Options
    }

    fn told(&self, _asked: &Question, answer: &Value, language: &str, _words: &Words) -> Told {
        let rows = answer.as_object().into_iter().flatten();
        rows.flat_map(|(row, chosen)| {
            // With one row there is nothing to tell apart.
            let row = (self.rows.len() > 1).then(|| label(&self.rows, row, language));
            let chosen = chosen.as_str().map(|word| label(&self.options, word, language));
            row.into_iter().chain(chosen)
        })
        .collect()
    }
}
