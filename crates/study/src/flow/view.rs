//! The vocabulary of the screen: what the page renders, without deciding anything itself.

use serde_json::Value;

/// What stands on the screen.
#[derive(Debug, Clone, PartialEq)]
pub enum View {
    /// The agreement.
    Consent {
        /// Identifier of the step, for [`super::Input::Shown`].
        step: String,
        /// Title of the study.
        title: String,
        /// What it is, in a sentence or two.
        description: String,
        /// The text; the lines on age and retention are its last sections.
        sections: Vec<SectionView>,
        /// Whom to write to.
        contacts: Vec<ContactView>,
        /// Languages to choose from: code and own name; empty if there is one only.
        languages: Vec<(String, String)>,
        /// The button that agrees.
        agree: String,
        /// The button that does not.
        decline: String,
    },
    /// A page of questions.
    Questions {
        /// Identifier of the step.
        step: String,
        /// Heading.
        title: String,
        /// Text below it.
        text: Vec<String>,
        /// The questions that are asked.
        questions: Vec<QuestionView>,
        /// A picture or a signed video that could not be had.
        failed: Option<FailedView>,
        /// The button that leads on.
        button: ButtonView,
        /// How much time is left.
        clock: Option<ClockView>,
        /// How far the session is.
        progress: ProgressView,
    },
    /// A page to read: instructions, debriefing, a page of the sequence, a break.
    Page {
        /// Identifier of the step.
        step: String,
        /// Heading.
        heading: String,
        /// Paragraphs.
        text: Vec<String>,
        /// The button that leads on; a break says in its `hint` how long it still lasts.
        button: ButtonView,
        /// How much time is left.
        clock: Option<ClockView>,
        /// How far the session is.
        progress: ProgressView,
    },
    /// What the device lacks, or that it is being looked at.
    Device(Box<DeviceView>),
    /// How large a CSS pixel is.
    Calibration(Box<CalibrationView>),
    /// Which answers to a practice clip were right.
    Feedback(Box<FeedbackView>),
    /// A trial.
    Trial(Box<TrialView>),
    /// Everything is answered; the last answers are on their way.
    ReceiptPending {
        /// Heading.
        heading: String,
        /// Text.
        text: String,
        /// Events that have arrived.
        stored: u64,
        /// Events of the session.
        total: u64,
    },
    /// Everything has arrived.
    End(Box<EndView>),
    /// The participant did not agree.
    Declined {
        /// Heading.
        heading: String,
        /// Text.
        text: String,
    },
    /// The participant took everything back.
    Withdrawn {
        /// Heading.
        heading: String,
        /// Text; empty until the server confirms.
        text: String,
        /// Whether the server has deleted everything.
        confirmed: bool,
    },
}

/// Something that the page shows could not be had.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedView {
    /// What is said.
    pub message: String,
    /// What went wrong.
    pub reason: String,
    /// The button that tries again ([`super::Input::Retry`]).
    pub retry: String,
}

/// A heading and its paragraphs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SectionView {
    /// Heading.
    pub heading: String,
    /// Paragraphs.
    pub text: Vec<String>,
}

/// Whom to write to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ContactView {
    /// What the person or board does here.
    pub role: String,
    /// Name.
    pub name: String,
    /// Address.
    pub email: String,
    /// File number of the approval.
    pub reference: Option<String>,
}

/// The button that leads on. It stays pressable when it does not lead on yet, so that pressing it
/// says what is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ButtonView {
    /// What it says.
    pub label: String,
    /// Whether it leads on.
    pub can_submit: bool,
    /// Why it does not, if that is not an answer's problem.
    pub hint: Option<String>,
}

/// How far the session is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProgressView {
    /// Steps done.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
}

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
    /// The button for those who cannot mend what is missing.
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
    /// What to mend; only after the button was pressed.
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
    /// What to mend; only after the button was pressed.
    pub problem: Option<String>,
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

/// How much time is left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClockView {
    /// "12 s left", or why there is a limit before it begins.
    pub text: String,
    /// Said once when the end is near.
    pub warning: Option<String>,
    /// The button that gives more time.
    pub extend: Option<String>,
}

/// How large the canvas is to be shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageSize {
    /// Width, CSS pixels.
    pub width: f64,
    /// Height, CSS pixels.
    pub height: f64,
    /// Where the size is one in millimetres: device pixels per CSS pixel for which it holds. In a
    /// window of another ratio `r` both are multiplied by this / `r`.
    pub device_pixel_ratio: Option<f64>,
}

/// A trial.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialView {
    /// Identifier of the step.
    pub step: String,
    /// Identifier of the clip.
    pub clip: String,
    /// What is played in step beside it.
    pub beside: Option<BesideView>,
    /// "Clip 3 of 12".
    pub heading: String,
    /// A line above the clip.
    pub instruction: Option<String>,
    /// How large the clip is to be shown.
    pub size: StageSize,
    /// How much time is left.
    pub clock: Option<ClockView>,
    /// Where the trial is.
    pub phase: Phase,
    /// What to tell: loading, watch first, answer now, interrupted.
    pub message: String,
    /// Whether the play button works.
    pub can_play: bool,
    /// What it says: play, or play again.
    pub play_label: String,
    /// Whether another replay is allowed after the first whole play.
    pub can_replay: bool,
    /// The questions.
    pub questions: Vec<QuestionView>,
    /// Whether answers can be given: after one whole play, not while the clip plays.
    pub can_answer: bool,
    /// The button that sends the answers.
    pub button: ButtonView,
    /// How far the session is.
    pub progress: ProgressView,
}

/// A clip that is played in step beside the trial's own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BesideView {
    /// Identifier of the clip.
    pub clip: String,
    /// Whether it stands left (above, on a narrow screen).
    pub left: bool,
    /// A line below it.
    pub caption: Option<String>,
    /// A line below the trial's own clip.
    pub clip_caption: Option<String>,
}

/// Where a trial is.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// The clip is being loaded and solved, 0..1; or the answers before it are being saved (1).
    Loading {
        /// 0..1.
        fraction: f64,
    },
    /// The clip could not be loaded or shown; `retry` is the button's label.
    Failed {
        /// What the stage says.
        reason: String,
        /// The button's label.
        retry: String,
    },
    /// It can be played.
    Ready,
    /// It is being played.
    Playing,
    /// It has been played; the questions wait.
    Answering,
}

/// The last page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndView {
    /// How the session ended: `completed`, `screened_out`, `failed_checks`.
    pub outcome: &'static str,
    /// Heading.
    pub heading: String,
    /// Paragraphs.
    pub text: Vec<String>,
    /// Label and completion code.
    pub completion_code: Option<(String, String)>,
    /// Label and address of the way back.
    pub redirect: Option<(String, String)>,
    /// Label and receipt.
    pub receipt: (String, String),
    /// Label, code, and what it is for.
    pub withdrawal_code: (String, String, String),
}

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
