//! Questions: what all have, and a file for each kind of them ([`QuestionKind`] lists the kinds).
//!
//! Nothing is ever pre-selected: a question has no default answer. What an answer is in JSON, each kind
//! says in its file.

mod accepting;
mod best_worst;
mod comparison;
pub(crate) mod defining;
mod free_text;
mod kind;
mod likert;
mod long_text;
mod matrix;
mod multiple_choice;
mod number;
mod ranking;
mod short_text;
mod simulation;
mod single_choice;
mod slider;
mod valence_arousal;
mod view;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::study_file::LocalText;

pub use best_worst::BestWorst;
pub use comparison::Comparison;
pub use kind::{KindOfQuestion, QuestionKind, Summary, Told};
pub use likert::Likert;
pub use long_text::{LONG_TEXT, LongText};
pub use matrix::Matrix;
pub use multiple_choice::MultipleChoice;
pub use number::NumberField;
pub use ranking::Ranking;
pub use short_text::{SHORT_TEXT, ShortText};
pub use simulation::{Chance, Scale, Simulated};
pub use single_choice::{SPACE_KEY, SingleChoice};
pub use slider::{Slider, TRACE_HZ};
pub use valence_arousal::Grid;
pub use view::{ChoiceView, QuestionKindView, Showing};

/// One question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Question {
    /// Name of the response in the export.
    pub id: String,
    /// What is asked.
    pub prompt: LocalText,
    /// A line below the prompt.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub help: Option<LocalText>,
    /// A sign-language video of the prompt: an MP4 or WebM file, or one a language.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<LocalText>,
    /// What else is in sign language, or has a picture, each with its words: the ends of a scale, its points,
    /// the edges of a grid. They stand above the answers in this order. In a comparison `left`,
    /// `same` and `right` stand in the place of the page's own options.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signs: Vec<Choice>,
    /// Whether the page waits for an answer.
    #[serde(default = "yes")]
    pub required: bool,
    /// Asked only if an earlier answer says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub show_if: Option<Condition>,
    /// The answer that an attentive person gives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attention_check: Option<AttentionCheck>,
    /// What kind of answer.
    #[serde(flatten)]
    pub kind: QuestionKind,
}

fn yes() -> bool {
    true
}

/// An earlier answer that opens a question. Every condition given must hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Condition {
    /// Which question: of this page, or of an earlier one.
    pub question: String,
    /// The answer is this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equals: Option<Value>,
    /// The answer is one of these (or has one of these among several choices).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub one_of: Vec<Value>,
    /// The answer is a number of at least this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// The answer is a number of at most this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
}

/// A question that checks attention.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct AttentionCheck {
    /// The answer that passes.
    pub expected: Value,
}

impl Question {
    /// Names of its answers in the export: its own, or one for each part (`grid.valence`).
    pub fn response_ids(&self) -> Vec<String> {
        match self.kind.parts() {
            Some(parts) => parts.iter().map(|part| format!("{}.{part}", self.id)).collect(),
            None => vec![self.id.clone()],
        }
    }

    /// Whether people answer on a scale, by options or by one of two clips, so that a run of equal answers
    /// says something.
    pub fn is_closed(&self) -> bool {
        let kind = &self.kind;
        kind.scale().is_some() || !kind.options().is_empty() || kind.compares_clips()
    }
}

/// One option.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Choice {
    /// What the export says.
    pub value: String,
    /// What the participant reads.
    pub label: LocalText,
    /// A picture shown with the label: a PNG, JPEG, WebP or SVG file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<String>,
    /// A sign-language video shown with the label: an MP4 or WebM file, or one a language.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<LocalText>,
}

/// In which order options are shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum OptionOrder {
    /// As in the file.
    #[default]
    Fixed,
    /// Drawn once a participant, the same in every trial.
    Random,
}
