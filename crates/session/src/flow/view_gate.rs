//! The vocabulary of the screen: device, calibration, practice.

use super::view::{ButtonView, ProgressView};

/// What the device lacks, or that it is being looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceView {
    /// Identifier of the step.
    pub step: String,
    /// Heading.
    pub heading: String,
    /// Text below it.
    pub text: String,
    /// Whether it was not measured yet.
    pub measuring: bool,
    /// What is missing, each with what to do about it.
    pub problems: Vec<(String, String)>,
    /// The button that leads on.
    pub button: ButtonView,
    /// The button that goes on without a full screen, where that is allowed.
    pub without: Option<String>,
    /// The button that measures again, where something is missing.
    pub again: Option<String>,
    /// The button for those who cannot put right what is missing.
    pub give_up: Option<String>,
    /// How far the session is.
    pub progress: ProgressView,
}

/// How large a CSS pixel is.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationView {
    /// Identifier of the step.
    pub step: String,
    /// Heading.
    pub heading: String,
    /// Paragraphs below it.
    pub text: Vec<String>,
    /// The card to be made as large as a real one.
    pub card: Option<CardView>,
    /// The distance of the eyes.
    pub distance: Option<DistanceView>,
    /// The button that leads on.
    pub button: ButtonView,
    /// How far the session is.
    pub progress: ProgressView,
}

/// A card to be made as large as a real one.
#[derive(Debug, Clone, PartialEq)]
pub struct CardView {
    /// What to do.
    pub instruction: String,
    /// Label of the slider.
    pub label: String,
    /// Labels of the buttons that make it smaller and larger.
    pub steps: (String, String),
    /// Width of the picture, CSS pixels.
    pub width_px: f64,
    /// Height of the picture, CSS pixels.
    pub height_px: f64,
    /// Whether its size was set.
    pub set: bool,
    /// The button for those who have no card, where that is allowed; whether it was pressed.
    pub no_card: Option<(String, bool)>,
    /// What to correct; only after the button was pressed.
    pub problem: Option<String>,
}

/// The distance of the eyes.
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceView {
    /// What is asked.
    pub label: String,
    /// Unit after the field.
    pub unit: String,
    /// What was written.
    pub value: Option<f64>,
    /// What to correct; only after the button was pressed.
    pub problem: Option<String>,
}

/// A page whose controls are a script's: where the volume is set and the tones are counted (`static/sound/check.js`),
/// where the measuring of the face is agreed to (`static/mimicry/check.js`).
#[derive(Debug, Clone, PartialEq)]
pub struct ScriptedView {
    /// Identifier of the step: `sound`, `mimicry`.
    pub step: String,
    /// Heading.
    pub heading: String,
    /// Paragraphs below it.
    pub text: Vec<String>,
    /// What the script gets, as JSON: [`mimique_study::SoundPages`], [`mimique_study::MimicryPages`].
    pub pages: String,
    /// How far the session is.
    pub progress: ProgressView,
}

/// Which answers to a practice clip were right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FeedbackView {
    /// Identifier of the step.
    pub step: String,
    /// Heading: all right, or not.
    pub heading: String,
    /// Whether all were right.
    pub correct: bool,
    /// A question each.
    pub items: Vec<FeedbackItem>,
    /// What follows from this round.
    pub text: Option<String>,
    /// The button that leads on.
    pub button: ButtonView,
    /// How far the session is.
    pub progress: ProgressView,
}

/// What was right about one answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FeedbackItem {
    /// What was asked.
    pub prompt: String,
    /// "You answered: joy".
    pub given: String,
    /// "Right is: fear"; none if it was right.
    pub right: Option<String>,
}
