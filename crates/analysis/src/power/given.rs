//! A simulated answer as the export has it.

use mimique_study::KindOfQuestion as _;
use serde_json::Value;

use crate::simulate::{Asked, Raw, Way, as_json};
use crate::trials::export::Answer;

/// An answer of a trial before it is kept.
pub(super) struct Given<'a> {
    pub person: usize,
    pub clip: usize,
    pub asked: &'a Asked<'a>,
    pub raw: &'a Raw,
    pub rt_ms: Option<f64>,
}

impl Given<'_> {
    /// The answer, or its part of a name, as the export has it; none where the part was not answered.
    pub fn as_answer(&self, part: &str, trial: usize) -> Option<Answer> {
        let (answer, correct, truth) = match (self.raw, &self.asked.way) {
            (Raw::Option(option), Way::Recognised(recognised)) => {
                let options = self.asked.question.kind.options();
                let right = recognised.clips[self.clip].as_ref().map(|row| row.right);
                (
                    options[*option].value.clone(),
                    right.map(|right| right == *option),
                    right.map(|right| options[right].value.clone()),
                )
            }
            (Raw::Json(Value::Object(parts)), _) => (text(parts.get(part)?), None, None),
            _ => (text(&as_json(self.asked, self.raw.clone())), None, None),
        };
        Some(Answer {
            person: self.person,
            number: answer.parse().ok().filter(|number: &f64| number.is_finite()),
            text: answer.into(),
            correct,
            truth: truth.map(Into::into),
            rt_ms: self.rt_ms,
            trial,
            trace: None,
        })
    }
}

/// A cell as the export has it.
pub(super) fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
