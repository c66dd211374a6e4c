//! A rating scale, coded as shown.

use std::ops::RangeInclusive;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Question;
use super::defining;
use super::kind::{KindOfQuestion, Summary, Told, between, pick};
use super::simulation::{Scale, Simulated};
use super::view::{QuestionKindView, Showing};
use crate::answer::AnswerProblem;
use crate::check::{Counted, Issues, Problem, below};
use crate::columns::ColumnKind;
use crate::study_file::LocalText;
use crate::text::Words;

/// A rating scale: `numItems` points from `start`. The answer is the point's number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Likert {
    /// Number of points.
    pub num_items: u32,
    /// Number of the first point.
    #[serde(default = "one")]
    pub start: i64,
    /// What the lowest point means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_label: Option<LocalText>,
    /// What the highest point means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_label: Option<LocalText>,
    /// A label at each point, from the lowest, instead of the ends alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<LocalText>,
}

fn one() -> i64 {
    1
}

impl Likert {
    /// Number of the last point.
    pub fn end(&self) -> i64 {
        self.start.saturating_add(i64::from(self.num_items) - 1)
    }

    /// The label at a point.
    fn label(&self, point: i64) -> Option<&LocalText> {
        usize::try_from(point.saturating_sub(self.start)).ok().and_then(|it| self.labels.get(it))
    }
}

impl KindOfQuestion for Likert {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::points(self.num_items, place, issues);
        let labels = self.labels.len();
        if labels == 0 {
            defining::ends(&self.left_label, &self.right_label, place, issues);
        } else if labels != self.num_items as usize {
            let labels = Counted(labels, "label");
            let problem = Problem::LabelCount { labels, points: self.num_items };
            issues.error(below(place, "labels"), problem);
        }
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        match answer.as_i64() {
            Some(point) if (self.start..=self.end()).contains(&point) => Ok(()),
            _ => Err(AnswerProblem::NotAnOption),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        let label = |point| self.label(point).map_or_else(String::new, |text| showing.text(text));
        QuestionKindView::Likert {
            points: (self.start..=self.end()).map(|point| (point, label(point))).collect(),
            left: showing.text_of(&self.left_label),
            right: showing.text_of(&self.right_label),
        }
    }

    fn described(&self, language: &str) -> String {
        let (points, start, end) = (self.num_items, self.start, self.end());
        let scale = pick(
            language,
            format!("scale of {points} points, {start} to {end}"),
            format!("échelle de {points} points, de {start} à {end}"),
        );
        scale + &between(&self.left_label, &self.right_label, language)
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Rated
    }

    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Integer
    }

    fn few_answers(&self) -> Vec<String> {
        (self.start..=self.end()).map(|point| point.to_string()).collect()
    }

    fn scale(&self) -> Option<Scale> {
        Some(Scale { start: self.start as f64, step: 1.0, points: self.num_items as usize })
    }

    fn points(&self) -> Option<RangeInclusive<i64>> {
        Some(self.start..=self.end())
    }

    fn ends(&self) -> Option<[Option<&LocalText>; 2]> {
        Some([self.left_label.as_ref(), self.right_label.as_ref()])
    }

    fn bounds(&self) -> Option<[Option<f64>; 2]> {
        Some([self.start, self.end()].map(|point| Some(point as f64)))
    }

    fn summary(&self) -> Summary {
        Summary::Points(self.start..=self.end())
    }

    fn told(&self, _asked: &Question, answer: &Value, language: &str, _words: &Words) -> Told {
        let mut ways = vec![answer.to_string()];
        if let Some(point) = answer.as_i64() {
            let left = self.left_label.as_ref().filter(|_| point == self.start);
            let right = self.right_label.as_ref().filter(|_| point == self.end());
            let labels = [self.label(point), left, right].into_iter().flatten();
            ways.extend(labels.map(|label| label.in_language(language).to_owned()));
        }
        vec![ways]
    }
}
