//! A number on a line; with `whilePlaying`, a rating that follows the clip.

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

/// A number on a line. The answer is the number as shown; with `whilePlaying` the list of numbers at which the line stood,
/// [`TRACE_HZ`] times a second from the clip's first frame to its last.
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
    /// Whether the line is moved while the clip plays, and its whole course is the answer.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub while_playing: bool,
}

/// How often in a second a rating that follows the clip is noted.
pub const TRACE_HZ: f64 = 60.0;

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
        let within = |number| accepting::within(number, Some(self.minimum), Some(self.maximum));
        if !self.while_playing {
            return within(answer);
        }
        let course = answer.as_array().filter(|course| !course.is_empty());
        course.ok_or(AnswerProblem::NotANumber)?.iter().try_for_each(within)
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::Slider {
            while_playing: self.while_playing,
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
        let followed = match self.while_playing {
            true => pick(language, ", moved while the clip plays", ", déplacé pendant l’extrait"),
            false => "",
        };
        line + followed + &between(&self.left_label, &self.right_label, language)
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

    fn is_traced(&self) -> bool {
        self.while_playing
    }

    fn bounds(&self) -> Option<[Option<f64>; 2]> {
        Some([Some(self.minimum), Some(self.maximum)])
    }
}
