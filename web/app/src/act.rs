//! What a page asks for when something happens on it.

use mimique_session::flow::Input;
use serde_json::Value;

/// From the answer so far to the new one.
pub type Change = Box<dyn FnOnce(Option<&Value>) -> Value>;

/// What a page asks for.
#[allow(clippy::large_enum_variant, reason = "one act is held at a time")]
pub enum Act {
    /// An input of the session.
    Input(Input),
    /// Another answer to a question, made from the answer of that moment, which the screen may not show
    /// yet.
    Change {
        /// Identifier of the question.
        question: String,
        /// From the answer so far to the new one.
        change: Change,
    },
    /// Another try to fetch the study and begin.
    BeginAgain,
    /// A session of its own for the next person at this browser.
    AnotherPerson,
    /// A text, to be pasted elsewhere.
    Copy(String),
    /// The answers as a file, where no server has them.
    Download,
}

impl From<Input> for Act {
    fn from(input: Input) -> Self {
        Self::Input(input)
    }
}
