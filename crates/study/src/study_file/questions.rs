//! Questions, by type.
//!
//! Nothing is ever pre-selected: a question has no default answer. Answers as JSON: a choice is its
//! `value`, several choices an array of values in the order of the file, a scale its number as
//! shown, a matrix an object from row to value, a ranking an array of values from first to last, a
//! grid `{"valence": v, "arousal": a}`, a comparison `"left"`, `"right"` or `"same"`.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use super::LocalText;
use crate::from_json::{Faults, FromJson};
use crate::tagged::{self, tagged_by_type};

/// One question.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
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
    /// A signed video of the prompt: an MP4 or WebM file, or one a language.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<LocalText>,
    /// What else is signed, or has a picture, each with its words: the ends of a scale, its points,
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

/// What questions of every type have.
#[derive(Deserialize, FromJson)]
#[serde(rename_all = "camelCase")]
struct Common {
    id: String,
    prompt: LocalText,
    #[serde(default)]
    help: Option<LocalText>,
    #[serde(default)]
    video: Option<LocalText>,
    #[serde(default)]
    signs: Vec<Choice>,
    #[serde(default = "yes")]
    required: bool,
    #[serde(default)]
    show_if: Option<Condition>,
    #[serde(default)]
    attention_check: Option<AttentionCheck>,
}

impl Common {
    fn with(self, kind: QuestionKind) -> Question {
        let Self { id, prompt, help, video, signs, required, show_if, attention_check } = self;
        Question { id, prompt, help, video, signs, required, show_if, attention_check, kind }
    }
}

impl FromJson for Question {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        Common::from_json(value, faults).with(QuestionKind::from_json(value, faults))
    }
}

impl<'de> Deserialize<'de> for Question {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        tagged::read(deserializer, |value| {
            let kind = tagged::from(value.clone())?;
            let common: Common = tagged::from(value)?;
            Ok(common.with(kind))
        })
    }
}

/// An earlier answer that opens a question. Every condition given must hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct AttentionCheck {
    /// The answer that passes.
    pub expected: Value,
}

/// What kind of answer is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(remote = "Self", rename_all = "camelCase")]
#[schemars(tag = "type")]
#[non_exhaustive]
pub enum QuestionKind {
    /// One of several: radio buttons. With `truth`, a forced choice.
    SingleChoice(SingleChoice),
    /// Any of several: check boxes.
    MultipleChoice(MultipleChoice),
    /// A rating scale, coded as shown.
    Likert(Likert),
    /// A number on a line.
    Slider(Slider),
    /// A number typed.
    Number(NumberField),
    /// A line of text.
    ShortText(TextField),
    /// Several lines of text.
    LongText(TextField),
    /// One choice in each of several rows.
    Matrix(Matrix),
    /// Options put in order.
    Ranking(Ranking),
    /// A point on a grid of valence and arousal.
    ValenceArousal(Grid),
    /// Which of the two clips shown side by side.
    Comparison(Comparison),
}

tagged_by_type!(QuestionKind);

impl Question {
    /// The parts of a question that gives several answers: the axes of a grid, the rows of a matrix, the
    /// options whose places a ranking gives.
    pub fn parts(&self) -> Option<Vec<&str>> {
        let values =
            |choices| Some(<[Choice]>::iter(choices).map(|it| it.value.as_str()).collect());
        match &self.kind {
            QuestionKind::ValenceArousal(_) => Some(vec!["valence", "arousal"]),
            QuestionKind::Matrix(matrix) => values(&matrix.rows),
            QuestionKind::Ranking(ranking) => values(&ranking.options),
            _ => None,
        }
    }

    /// Names of its answers in the export: its own, or one for each part (`grid.valence`).
    pub fn response_ids(&self) -> Vec<String> {
        match self.parts() {
            Some(parts) => parts.iter().map(|part| format!("{}.{part}", self.id)).collect(),
            None => vec![self.id.clone()],
        }
    }
}

impl QuestionKind {
    /// The word of the file: `likert`...
    pub fn word(&self) -> &'static str {
        match self {
            Self::SingleChoice(_) => "singleChoice",
            Self::MultipleChoice(_) => "multipleChoice",
            Self::Likert(_) => "likert",
            Self::Slider(_) => "slider",
            Self::Number(_) => "number",
            Self::ShortText(_) => "shortText",
            Self::LongText(_) => "longText",
            Self::Matrix(_) => "matrix",
            Self::Ranking(_) => "ranking",
            Self::ValenceArousal(_) => "valenceArousal",
            Self::Comparison(_) => "comparison",
        }
    }

    /// The options of a question that has some.
    pub fn options(&self) -> &[Choice] {
        match self {
            Self::SingleChoice(question) => &question.options,
            Self::MultipleChoice(question) => &question.options,
            Self::Matrix(question) => &question.options,
            Self::Ranking(question) => &question.options,
            _ => &[],
        }
    }
}

/// One option.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Choice {
    /// What the export says.
    pub value: String,
    /// What the participant reads.
    pub label: LocalText,
    /// A picture shown with the label: a PNG, JPEG, WebP or SVG file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<String>,
    /// A signed video shown with the label: an MP4 or WebM file, or one a language.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<LocalText>,
}

/// In which order options are shown.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, FromJson, JsonSchema,
)]
#[serde(rename_all = "camelCase")]
pub enum OptionOrder {
    /// As in the file.
    #[default]
    Fixed,
    /// Drawn once a participant, the same in every trial.
    Random,
}

/// One of several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct SingleChoice {
    /// The options, two at least.
    pub options: Vec<Choice>,
    /// In which order they are shown.
    #[serde(default)]
    pub option_order: OptionOrder,
    /// The factor of the clip that holds the right answer (`expression`); the export then has
    /// `truth` and `correct`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth: Option<String>,
}

/// Any of several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct MultipleChoice {
    /// The options.
    pub options: Vec<Choice>,
    /// In which order they are shown.
    #[serde(default)]
    pub option_order: OptionOrder,
    /// Fewest that must be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<usize>,
    /// Most that may be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<usize>,
}

/// A rating scale: `numItems` points from `start`, coded as shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
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
}

/// A number on a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
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

/// A number typed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
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

/// Text typed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct TextField {
    /// Most characters; 200 for a line and 5,000 for several if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_length: Option<usize>,
}

/// One choice in each of several rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Matrix {
    /// The rows.
    pub rows: Vec<Choice>,
    /// The options of each row.
    pub options: Vec<Choice>,
}

/// Options put in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Ranking {
    /// What is ranked.
    pub options: Vec<Choice>,
    /// In which order they stand at first.
    #[serde(default)]
    pub option_order: OptionOrder,
}

/// A point on a grid of valence (across) and arousal (up).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
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

/// Which of the two clips that are shown side by side. The export names the clip that was chosen in
/// its column `chosen`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Comparison {
    /// Whether "no difference" can be answered.
    #[serde(default)]
    pub allow_same: bool,
}

fn nine() -> u32 {
    9
}
