//! The vocabulary of the screen: what the page renders, without deciding anything itself.

use super::agreement::AgreementView;
use super::placed::PlacedClip;
use super::view_gate::{CalibrationView, DeviceView, FeedbackView, ScriptedView};
use super::view_question::QuestionView;

/// What stands on the screen.
#[derive(Debug, Clone, PartialEq)]
pub enum View {
    /// The agreement.
    Consent {
        /// Identifier of the step, for [`super::Input::Shown`].
        step: String,
        /// What is read before.
        agreement: AgreementView,
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
    /// Where the volume is set.
    Scripted(Box<ScriptedView>),
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
    /// What went wrong, in words.
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
    /// What [`Self::placed`] tells.
    pub(super) placed: Vec<PlacedClip>,
    /// Identifier of the step.
    pub step: String,
    /// Identifier of the clip.
    pub clip: String,
    /// What is played in step beside it.
    pub beside: Option<BesideView>,
    /// The panel, where several clips are rated on one scale; `clip` is its first.
    pub panel: Option<PanelView>,
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
    /// Whether the clip's captions are shown below it ([`mimique_study::CaptionRule`] as in the file), and the label
    /// of the button that switches them; none where no clip has sound.
    pub captions: Option<[String; 2]>,
    /// Whether the play button works.
    pub can_play: bool,
    /// What it says: play, or play again.
    pub play_label: String,
    /// Whether another replay is allowed after the first whole play.
    pub can_replay: bool,
    /// The questions that are answered while the clip plays: by keys, and by lines.
    pub keys: Vec<QuestionView>,
    /// Whether keys can be pressed now.
    pub can_press: bool,
    /// The other questions.
    pub questions: Vec<QuestionView>,
    /// Whether answers can be given: after one whole play, not while the clip plays.
    pub can_answer: bool,
    /// The button that sends the answers.
    pub button: ButtonView,
    /// How far the session is.
    pub progress: ProgressView,
}

impl TrialView {
    /// The clips that are played, on their canvases ([`super::TrialStep::placed`]).
    pub fn placed(&self) -> &[PlacedClip] {
        &self.placed
    }
}

/// A clip that is played in step beside the trial's own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BesideView {
    /// Identifier of the clip.
    pub clip: String,
    /// Whether it stands left.
    pub left: bool,
    /// A line below it.
    pub caption: Option<String>,
    /// A line below the trial's own clip.
    pub clip_caption: Option<String>,
}

/// Several clips that are rated on one scale.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PanelView {
    /// Whether each clip is rated.
    pub is_rated: bool,
    /// What is asked of each; the questions of the trial have the clips' letters as prompts.
    pub prompt: String,
    /// The clips as they stand: the open reference, where there is one, then A, B, C.
    pub figures: Vec<PanelFigure>,
}

/// A clip of a panel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PanelFigure {
    /// Its place, from 1; 0 is the open reference.
    pub place: u32,
    /// Its canvas.
    pub canvas: String,
    /// Identifier of the clip.
    pub clip: String,
    /// "A", or "Reference".
    pub caption: String,
    /// What the button says that plays it alone.
    pub play_label: String,
    /// Whether that button works.
    pub can_play: bool,
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
        /// What went wrong, in words.
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
    /// The completion code.
    pub completion_code: Option<CodeView>,
    /// Label and address of the way back.
    pub redirect: Option<(String, String)>,
    /// That the page goes back by itself, and the button that keeps it here ([`super::Input::Stay`]).
    pub returning: Option<(String, String)>,
    /// What a participant keeps.
    pub records: RecordsView,
}

/// A code to be handed on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeView {
    /// What it is.
    pub label: String,
    /// The code.
    pub code: String,
    /// The button that copies it ([`super::Input::Copied`]).
    pub copy: String,
    /// Said once it is copied.
    pub copied: Option<String>,
}

/// What a participant keeps; labels and values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordsView {
    /// Heading.
    pub heading: String,
    /// Code by which answers are deleted.
    pub withdrawal_code: (String, String),
    /// The participant's number.
    pub participant: (String, String),
    /// The server's receipt.
    pub receipt: (String, String),
    /// What code and number are for.
    pub note: String,
    /// Link to the page where answers are deleted by the code, which a server has.
    pub delete: String,
}
