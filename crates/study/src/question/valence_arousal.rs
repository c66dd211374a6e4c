//! A point on a grid of valence (across) and arousal (up).

use std::ops::RangeInclusive;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::defining;
use super::kind::{KindOfQuestion, pick};
use super::simulation::{Scale, Simulated};
use super::view::{QuestionKindView, Showing};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::columns::ColumnKind;
use crate::study_file::LocalText;

/// The axes of the grid: the parts of an answer.
const AXES: [&str; 2] = ["valence", "arousal"];

/// A point on a grid of valence (across) and arousal (up). The answer is
/// `{"valence": v, "arousal": a}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Grid {
    /// Cells across and up; an odd number has a middle. Coded 1 to `numItems` from left and below.
    #[serde(default = "nine")]
    pub num_items: u32,
    /// What the left edge means.
    pub left_label: LocalText,
    /// What the right edge means.
    pub right_label: LocalText,
    /// What the lower edge means.
    pub bottom_label: LocalText,
    /// What the upper edge means.
    pub top_label: LocalText,
}

fn nine() -> u32 {
    9
}

impl KindOfQuestion for Grid {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::points(self.num_items, place, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        for axis in AXES {
            let number = answer.get(axis).and_then(Value::as_i64);
            let number = number.ok_or(AnswerProblem::Incomplete)?;
            if !(1..=i64::from(self.num_items)).contains(&number) {
                return Err(AnswerProblem::NotAnOption);
            }
        }
        Ok(())
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::ValenceArousal {
            num_items: self.num_items,
            left: showing.text(&self.left_label),
            right: showing.text(&self.right_label),
            bottom: showing.text(&self.bottom_label),
            top: showing.text(&self.top_label),
        }
    }

    fn described(&self, language: &str) -> String {
        let points = self.num_items;
        pick(
            language,
            format!("valence and arousal, 1 to {points} each"),
            format!("valence et activation, de 1 à {points} chacune"),
        )
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Rated
    }

    fn parts(&self) -> Option<Vec<&str>> {
        Some(AXES.to_vec())
    }

    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Integer
    }

    fn scale(&self) -> Option<Scale> {
        Some(Scale { start: 1.0, step: 1.0, points: self.num_items as usize })
    }

    fn points(&self) -> Option<RangeInclusive<i64>> {
        Some(1..=i64::from(self.num_items))
    }
}
