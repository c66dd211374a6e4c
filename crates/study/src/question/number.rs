//! A number typed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, pick};
use super::simulation::Simulated;
use super::view::{QuestionKindView, Showing};
use super::{accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::columns::ColumnKind;
use crate::study_file::LocalText;

/// A number typed. The answer is the number.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct NumberField {
    /// Lowest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Highest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// Whole numbers only.
    #[serde(default)]
    pub integer: bool,
    /// Unit shown after the field: `years`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<LocalText>,
}

impl KindOfQuestion for NumberField {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::range(self.minimum, self.maximum, place, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        accepting::within(answer, self.minimum, self.maximum)?;
        match self.integer && answer.as_f64().is_some_and(|number| number.fract() != 0.0) {
            true => Err(AnswerProblem::NotWhole),
            false => Ok(()),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::Number {
            minimum: self.minimum,
            maximum: self.maximum,
            integer: self.integer,
            unit: self.unit.as_ref().map(|unit| showing.text(unit)),
        }
    }

    fn described(&self, language: &str) -> String {
        pick(language, "a number", "un nombre").to_owned()
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Number(self)
    }

    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Number
    }

    fn bounds(&self) -> Option<[Option<f64>; 2]> {
        Some([self.minimum, self.maximum])
    }
}
