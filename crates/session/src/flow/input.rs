//! What comes in: acts of the participant, reports of the page.

use mimique_study::{Answers, Display};
use serde_json::Value;

use crate::event::{Client, PlayLog, StageFailure};
use crate::wire::Receipt;

/// What comes in: acts of the participant, reports of the page.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "one input is held at a time; on 32 bits it is below the limit"
)]
#[non_exhaustive]
pub enum Input {
    /// The page is open for the first time in this session.
    Opened(Client),
    /// The page was opened again, after [`crate::flow::State::replay`].
    Resumed(Client),
    /// The session has begun, after [`crate::flow::State::replay`] of what came before it (agreement and
    /// device: [`crate::flow::Plan::is_before_session`]).
    Begun,
    /// The participant chooses a language.
    ChooseLanguage(String),
    /// The participant agrees.
    Consent,
    /// The participant does not agree.
    Decline,
    /// The page of this step stands on the screen (send it after the first paint).
    Shown {
        /// Identifier of the step.
        step: String,
    },
    /// A question was answered; `Value::Null` takes the answer back. Send it when the answer is
    /// whole (a choice clicked, a field left), not at every key.
    Answer {
        /// Identifier of the question.
        question: String,
        /// The answer, as JSON (see [`mimique_study::QuestionKind`]).
        value: Value,
    },
    /// An option of a question with keys was pressed, by its key or its button.
    Press {
        /// Identifier of the question.
        question: String,
        /// The option's value.
        value: String,
        /// When, page clock: the time of the press itself, milliseconds.
        at_ms: f64,
    },
    /// The button that leads on.
    Next,
    /// The button that plays, or plays again.
    Play,
    /// The button of a panel that plays the clip at this place alone, from 1; 0 is the open reference.
    PlayAlone(u32),
    /// The stage has played the clip, wholly or not. Its times are on the page's clock.
    Played(PlayLog),
    /// A clip is being loaded and solved.
    ClipProgress {
        /// Which clip.
        clip: String,
        /// 0..1.
        fraction: f64,
    },
    /// A clip can be played, a picture or a signed video can be shown.
    ClipPrepared {
        /// Which clip.
        clip: String,
    },
    /// A clip could not be loaded, solved or shown.
    ClipFailed {
        /// Which clip.
        clip: String,
        /// Why.
        failure: StageFailure,
    },
    /// The connection is back.
    Online,
    /// The button that tries again what failed: a clip, a picture or a signed video.
    Retry,
    /// The page lost the focus or was hidden.
    FocusLost,
    /// The page has the focus again.
    FocusGained,
    /// The page fills the screen, or no longer does.
    Fullscreen(bool),
    /// What browser and display can do.
    Measured(Display),
    /// The button of the device gate that measures again.
    MeasureAgain,
    /// The button of the device gate for those who cannot put right what is missing.
    GiveUp,
    /// The button of the device gate that goes on without a full screen.
    WithoutFullscreen,
    /// The picture of the card is as large as the card.
    CardWidth {
        /// Its width, CSS pixels.
        px: f64,
        /// Device pixels per CSS pixel of the window.
        device_pixel_ratio: f64,
    },
    /// The participant has no card.
    NoCard,
    /// How far the participant sits from the screen, centimetres.
    Distance(Option<f64>),
    /// A page whose controls are a script's was gone through; its answers are those of the sound check, or of the consent
    /// to measuring the face.
    PageScripted(Answers),
    /// The level of the trial on the screen: body of [`crate::EventKind::LevelChosen`] or
    /// [`crate::EventKind::LevelsOver`].
    LevelChosen(Value),
    /// The clips that may come after either answer to that level.
    LevelsAhead(Vec<String>),
    /// The next batch of pairs: body of [`crate::EventKind::PairsDrawn`].
    PairsDrawn(Value),
    /// The button that gives more time.
    ExtendTime,
    /// Time has passed (a break and a time limit wait for it). About once a second is enough.
    Tick,
    /// The participant takes everything back (the page has asked whether that is meant).
    Withdraw,
    /// The server has every event below this number.
    Acknowledged {
        /// Number of events stored without a gap.
        stored: u64,
    },
    /// The server's receipt.
    ReceiptArrived(Receipt),
    /// The completion code was copied.
    Copied,
    /// The button of the last page that keeps it from going back by itself.
    Stay,
    /// The server has deleted everything.
    WithdrawalConfirmed,
}

impl Input {
    /// Its name in the record of unexpected inputs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Opened(_) => "opened",
            Self::Resumed(_) => "resumed",
            Self::Begun => "begun",
            Self::ChooseLanguage(_) => "choose_language",
            Self::Consent => "consent",
            Self::Decline => "decline",
            Self::Shown { .. } => "shown",
            Self::Answer { .. } => "answer",
            Self::Press { .. } => "press",
            Self::Next => "next",
            Self::Play => "play",
            Self::PlayAlone(_) => "play_alone",
            Self::Played(_) => "played",
            Self::ClipProgress { .. } => "clip_progress",
            Self::ClipPrepared { .. } => "clip_prepared",
            Self::ClipFailed { .. } => "clip_failed",
            Self::Online => "online",
            Self::Retry => "retry",
            Self::FocusLost => "focus_lost",
            Self::FocusGained => "focus_gained",
            Self::Fullscreen(_) => "fullscreen",
            Self::Measured(_) => "measured",
            Self::MeasureAgain => "measure_again",
            Self::GiveUp => "give_up",
            Self::WithoutFullscreen => "without_fullscreen",
            Self::CardWidth { .. } => "card_width",
            Self::NoCard => "no_card",
            Self::Distance(_) => "distance",
            Self::PageScripted(_) => "page_scripted",
            Self::LevelChosen(_) => "level_chosen",
            Self::LevelsAhead(_) => "levels_ahead",
            Self::PairsDrawn(_) => "pairs_drawn",
            Self::ExtendTime => "extend_time",
            Self::Tick => "tick",
            Self::Withdraw => "withdraw",
            Self::Acknowledged { .. } => "acknowledged",
            Self::ReceiptArrived(_) => "receipt_arrived",
            Self::Copied => "copied",
            Self::Stay => "stay",
            Self::WithdrawalConfirmed => "withdrawal_confirmed",
        }
    }
}
