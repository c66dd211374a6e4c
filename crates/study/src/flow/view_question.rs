//! The vocabulary of the screen: questions and their options.

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
    /// A signed video of the prompt.
    pub video: Option<String>,
    /// What else is signed or has a picture, above the answers.
    pub signs: Vec<ChoiceView>,
    /// Whether the page waits for an answer.
    pub required: bool,
    /// Marks a question that may be left out.
    pub optional_mark: Option<String>,
    /// What kind of answer.
    pub kind: QuestionKindView,
    /// The answer so far; nothing is pre-selected.
    pub value: Option<Value>,
    /// What to mend; only after the button was pressed.
    pub problem: Option<String>,
}

/// What kind of answer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum QuestionKindView {
    /// Radio buttons.
    SingleChoice {
        /// In the order shown.
        options: Vec<ChoiceView>,
    },
    /// Check boxes.
    MultipleChoice {
        /// In the order shown.
        options: Vec<ChoiceView>,
        /// Most that may be chosen.
        maximum: Option<usize>,
    },
    /// A scale: number and label of each point (the label is empty where the file has none).
    Likert {
        /// From the lowest to the highest.
        points: Vec<(i64, String)>,
        /// What the lowest means.
        left: String,
        /// What the highest means.
        right: String,
    },
    /// A number on a line.
    Slider {
        /// Lowest value.
        minimum: f64,
        /// Highest value.
        maximum: f64,
        /// Distance of neighbouring values.
        step: f64,
        /// What the lowest means.
        left: String,
        /// What the highest means.
        right: String,
    },
    /// A number typed.
    Number {
        /// Lowest value.
        minimum: Option<f64>,
        /// Highest value.
        maximum: Option<f64>,
        /// Whole numbers only.
        integer: bool,
        /// Unit shown after the field.
        unit: Option<String>,
    },
    /// Text typed.
    Text {
        /// Several lines.
        long: bool,
        /// Most characters.
        max_length: usize,
    },
    /// One choice in each row.
    Matrix {
        /// The rows.
        rows: Vec<ChoiceView>,
        /// The options of each row.
        options: Vec<ChoiceView>,
    },
    /// Options put in order.
    Ranking {
        /// In the order they stand at first.
        options: Vec<ChoiceView>,
    },
    /// A point on a grid.
    ValenceArousal {
        /// Cells across and up.
        num_items: u32,
        /// What the left edge means.
        left: String,
        /// What the right edge means.
        right: String,
        /// What the lower edge means.
        bottom: String,
        /// What the upper edge means.
        top: String,
    },
}

/// An option.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChoiceView {
    /// What the answer says.
    pub value: String,
    /// What the participant reads.
    pub label: String,
    /// A picture shown with the label.
    pub image: Option<String>,
    /// A signed video shown with the label.
    pub video: Option<String>,
}
