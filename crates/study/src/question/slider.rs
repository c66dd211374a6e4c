//! A number on a line.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, between, pick};
use super::simulation::{Scale, Simulated};
use super::view::{QuestionKindView, Showing};
use super::{accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::{Issues, Problem, below};
use crate::columns::ColumnKind;
use crate::study_file::LocalText;

/// A number on a line. The answer is the number as shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Slider {
    /// Lowest value.
    pub minimum: f64,
    /// Highest value.
    pub maximum: f64,
    /// Distance of neighbouring values.
    #[serde(default = "unit_step")]
    pub step: f64,
    /// What the lowest value means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_label: Option<LocalText>,
    /// What the highest value means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_label: Option<LocalText>,
}

fn unit_step() -> f64 {
    1.0
}

impl KindOfQuestion for Slider {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::ends(&self.left_label, &self.right_label, place, issues);
        defining::range(Some(self.minimum), Some(self.maximum), place, issues);
        if self.step <= 0.0 || self.step > self.maximum - self.minimum {
            issues.error(below(place, "step"), Problem::Step { step: self.step });
        }
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        accepting::within(answer, Some(self.minimum), Some(self.maximum))
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::Slider {
            minimum: self.minimum,
            maximum: self.maximum,
            step: self.step,
            left: showing.text_of(&self.left_label),
            right: showing.text_of(&self.right_label),
        }
    }

    fn described(&self, language: &str) -> String {
        let (least, most) = (self.minimum, self.maximum);
        let line = pick(
            language,
            format!("slider from {least} to {most}"),
            format!("curseur de {least} à {most}"),
        );
        line + &between(&self.left_label, &self.right_label, language)
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Rated
    }

    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Number
    }

    fn scale(&self) -> Option<Scale> {
        let step = if self.step > 0.0 { self.step } else { 1.0 };
        let steps = ((self.maximum - self.minimum) / step + 1e-9).floor().max(0.0);
        Some(Scale { start: self.minimum, step, points: steps as usize + 1 })
    }

    fn bounds(&self) -> Option<[Option<f64>; 2]> {
        Some([Some(self.minimum), Some(self.maximum)])
    }
}
