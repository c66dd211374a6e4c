//! Options put in order.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, labels, pick};
use super::simulation::{Chance, Simulated};
use super::view::{QuestionKindView, Showing};
use super::{Choice, OptionOrder, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::columns::ColumnKind;

/// Options put in order. The answer is an array of values from first to last; the export has the place of
/// each option.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Ranking {
    /// What is ranked.
    pub options: Vec<Choice>,
    /// In which order they stand at first.
    #[serde(default)]
    pub option_order: OptionOrder,
}

impl KindOfQuestion for Ranking {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.options, place, "options", 2, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        match accepting::several_of(&self.options, answer)? < self.options.len() {
            true => Err(AnswerProblem::Incomplete),
            false => Ok(()),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::Ranking { options: showing.options() }
    }

    fn described(&self, language: &str) -> String {
        let options = labels(&self.options, language);
        pick(language, format!("ranking of {options}"), format!("classement de {options}"))
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Drawn { by_shares: false }
    }

    fn drawn(&self, _weights: &[f64], chance: &mut dyn Chance) -> Value {
        let mut places: Vec<usize> = (0..self.options.len()).collect();
        chance.shuffle(&mut places);
        places.into_iter().map(|place| self.options[place].value.as_str()).collect()
    }

    fn options(&self) -> &[Choice] {
        &self.options
    }

    fn option_order(&self) -> OptionOrder {
        self.option_order
    }

    fn parts(&self) -> Option<Vec<&str>> {
        Some(self.options.iter().map(|option| option.value.as_str()).collect())
    }

    /// The place of an option, from 1.
    fn part_of(&self, answer: &Value, part: &str) -> Value {
        let ranked = answer.as_array().map(Vec::as_slice).unwrap_or_default();
        let place = ranked.iter().position(|each| each.as_str() == Some(part));
        place.map_or(Value::Null, |place| (place + 1).into())
    }

    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Integer
    }
}
