//! The vocabulary of the screen: questions. What their kinds show, each kind says itself.

use mimique_study::{ChoiceView, QuestionKindView};
use serde_json::Value;

/// A question.
#[derive(Debug, Clone, PartialEq)]
pub struct QuestionView {
    /// Identifier, for [`super::Input::Answer`].
    pub id: String,
    /// What is asked.
    pub prompt: String,
    /// A line below the prompt.
    pub help: Option<String>,
    /// A sign-language video of the prompt.
    pub video: Option<String>,
    /// What else is in sign language or has a picture, above the answers.
    pub signs: Vec<ChoiceView>,
    /// Whether the page waits for an answer.
    pub required: bool,
    /// Marks a question that may be left out.
    pub optional_mark: Option<String>,
    /// What kind of answer.
    pub kind: QuestionKindView,
    /// The answer so far; nothing is pre-selected.
    pub value: Option<Value>,
    /// What to correct; only after the button was pressed.
    pub problem: Option<String>,
}
