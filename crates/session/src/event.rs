//! What happens in a session, as it is stored: the body of [`crate::wire::Event`].
//!
//! All times are the page's clock: milliseconds since 1970, from `performance.timeOrigin +
//! performance.now()`, so that within one load of the page they never run backwards.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use mimique_study::{Answers, Display};

/// What happened, tagged by `type`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
#[non_exhaustive]
pub enum EventKind {
    /// The page is open for the first time. Always sequence 0.
    Opened {
        /// The display and the page.
        client: Client,
        /// Language of the pages.
        language: String,
    },
    /// The language of the pages was changed.
    LanguageChosen {
        /// Language of the pages.
        language: String,
    },
    /// The participant agrees.
    Consented {
        /// Version of the text.
        version: String,
        /// Language it was read in.
        language: String,
    },
    /// The participant does not agree. The session ends.
    Declined,
    /// A page stands on the screen.
    PageShown {
        /// Identifier of the step.
        step: String,
    },
    /// An answer was given or changed.
    Answered {
        /// Identifier of the step.
        step: String,
        /// Identifier of the question.
        question: String,
        /// The answer; null where it was taken back.
        value: Value,
    },
    /// What the browser and its display can do.
    DeviceMeasured {
        /// What was found.
        display: Display,
    },
    /// The size of a CSS pixel and the distance of the eyes.
    Calibrated(Calibrated),
    /// The participant asked for more time.
    TimeExtended {
        /// Identifier of the step.
        step: String,
    },
    /// The study does not take this participant. The session ends.
    ScreenedOut {
        /// Identifier of the step that stood on the screen.
        step: String,
        /// `device`, `frames`, `sound`, `screening` or `training`.
        reason: String,
        /// What was missing: the rules' keys, or the question.
        details: Vec<String>,
    },
    /// More attention checks were failed than the study allows. The session ends.
    ChecksFailed {
        /// How many were failed.
        failed: u32,
    },
    /// A page was left by its button, or its time was over.
    PageFinished {
        /// Identifier of the step.
        step: String,
        /// Its answers, if it asked something.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        answers: Answers,
        /// Whether its time was over.
        #[serde(default, skip_serializing_if = "is_false")]
        timed_out: bool,
    },
    /// The first play of a trial was asked for.
    TrialStarted {
        /// Identifier of the step.
        step: String,
        /// Which clip.
        clip: String,
        /// What is played beside it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        beside: Option<ShownBeside>,
        /// Of a panel: its clips from the first place to the last.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        panel: Vec<String>,
        /// Of a pair that follows from answers: its batch, from 1.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        batch: Option<u32>,
    },
    /// The next pairs of an active schedule, by all answers before them.
    PairsDrawn {
        /// Identifier of the step that waited for them.
        step: String,
        /// Number of the batch, from 1.
        batch: u32,
        /// The pairs: the left clip, the right clip.
        pairs: Vec<[String; 2]>,
        /// Answers that they were drawn under, of all people.
        answers: u64,
        /// SHA-256 of these answers.
        hash: String,
    },
    /// A trial of an adaptive block has its level, by the answers before it.
    LevelChosen {
        /// Identifier of the step.
        step: String,
        /// Track, from 1.
        track: f64,
        /// The level.
        level: f64,
        /// The entropy expected after the answer, in nats; none of a staircase and of catch trials.
        entropy: Option<f64>,
        /// Whether it is a catch trial.
        catch: bool,
        /// Clip of the level.
        clip: String,
        /// Clip that it is held against.
        against: String,
        /// Whether that one stands left.
        left: bool,
    },
    /// Every track of an adaptive block has ended before its last trial: the rest is left out.
    LevelsOver {
        /// Identifier of the step.
        step: String,
    },
    /// The clip was played, wholly or not.
    TrialPlayed {
        /// Identifier of the step.
        step: String,
        /// What the stage measured.
        log: Box<PlayLog>,
    },
    /// The questions of a trial were sent.
    TrialFinished {
        /// Identifier of the step.
        step: String,
        /// Which clip.
        clip: String,
        /// The answers.
        answers: Answers,
        /// From the first frame of the first whole play to now, milliseconds.
        rt_ms: f64,
        /// Whole plays after the first.
        replays: u32,
        /// Whether their time was over.
        #[serde(default, skip_serializing_if = "is_false")]
        timed_out: bool,
    },
    /// A clip could not be loaded, solved or shown.
    ClipFailed {
        /// Which clip.
        clip: String,
        /// What the stage says, in English, for those who look for the cause.
        message: String,
        /// The code of what went wrong ([`StageFailure::code`]); empty in events of earlier versions.
        #[serde(default, skip_serializing_if = "String::is_empty")]
        code: String,
    },
    /// The page lost the focus or was hidden.
    FocusLost,
    /// The page has the focus again.
    FocusGained,
    /// The page fills the screen, or no longer does.
    Fullscreen {
        /// Whether it does.
        on: bool,
    },
    /// The page was opened again; a trial that had begun starts anew.
    Resumed {
        /// The display and the page.
        client: Client,
    },
    /// Every step is done.
    Finished,
    /// The participant takes everything back.
    Withdrawn,
    /// Something came that does not fit the state; it changed nothing.
    Unexpected {
        /// What came.
        input: String,
        /// The step that stood on the screen.
        step: String,
    },
}

fn is_false(value: &bool) -> bool {
    !value
}

/// Types of the events that can end a session.
const ENDS: [&str; 5] = ["checks_failed", "declined", "finished", "screened_out", "withdrawn"];

impl EventKind {
    /// Whether a body is of a type that can end a session.
    pub fn may_end(body: &Value) -> bool {
        body.get("type").and_then(Value::as_str).is_some_and(|kind| ENDS.contains(&kind))
    }

    /// The step that it belongs to, if it is one of a page or a trial.
    pub fn step(&self) -> Option<&str> {
        match self {
            Self::PageShown { step }
            | Self::Answered { step, .. }
            | Self::TimeExtended { step }
            | Self::PageFinished { step, .. }
            | Self::TrialStarted { step, .. }
            | Self::PairsDrawn { step, .. }
            | Self::LevelChosen { step, .. }
            | Self::LevelsOver { step }
            | Self::TrialPlayed { step, .. }
            | Self::TrialFinished { step, .. } => Some(step),
            _ => None,
        }
    }

    /// Reads the body of a [`crate::wire::Event`]; `None` if this version does not know it.
    pub fn from_body(body: &Value) -> Option<Self> {
        Self::deserialize(body).ok()
    }

    /// Reads the text of a body, as a store keeps it: the same as [`Self::from_body`] of what it parses to,
    /// and quicker.
    pub fn from_text(body: &str) -> Option<Self> {
        /// The type stands behind what it is the type of: it is looked for first.
        #[derive(Deserialize)]
        struct Tagged<'b> {
            #[serde(rename = "type", borrow)]
            kind: Cow<'b, str>,
        }
        /// [`EventKind::TrialPlayed`]: the frames, most of what a session holds, are not gathered in some
        /// other form before the type is known.
        #[derive(Deserialize)]
        struct Played {
            step: String,
            log: PlayLog,
        }
        let tagged: Tagged<'_> = serde_json::from_str(body).ok()?;
        if tagged.kind != "trial_played" {
            return serde_json::from_str(body).ok();
        }
        let Played { step, log } = serde_json::from_str(body).ok()?;
        Some(Self::TrialPlayed { step, log: Box::new(log) })
    }

    /// The body of a [`crate::wire::Event`].
    pub fn to_body(&self) -> Value {
        serde_json::to_value(self).unwrap_or(Value::Null)
    }
}

/// Why something could not be loaded, solved or shown (`static/stage/failure.js`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StageFailure {
    /// A code of [`mimique_study::text::Words::stage_failure`].
    pub code: String,
    /// The values that the code's words name.
    pub values: BTreeMap<String, String>,
    /// What the stage says, in English, for those who look for the cause.
    pub message: String,
}

/// The clips of a trial that follow from answers.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenClips {
    /// The trial's own clip.
    pub clip: String,
    /// What is shown beside it.
    pub against: String,
    /// Whether that one stands left.
    pub left: bool,
}

/// What is played in step beside a clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShownBeside {
    /// Which clip.
    pub clip: String,
    /// Whether it stands left of the trial's own clip.
    pub left: bool,
}

/// A clip of a panel as it was shown.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ShownInPanel {
    /// Which clip.
    pub clip: String,
    /// Its provenance, as the page had it.
    pub provenance: String,
    /// SHA-256 of its weights as the browser solved them, hexadecimal.
    pub weights_hash: String,
}

/// What was chosen for a trial of an adaptive block ([`mimique_study::ChosenLevel`]), as its event says. It has no
/// reader of its own, which would weigh on every page.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LevelShown {
    /// Identifier of the step.
    pub step: String,
    /// Track, from 1.
    pub track: f64,
    /// The level.
    pub level: f64,
    /// The entropy expected after the answer, in nats; none of a staircase and of catch trials.
    pub entropy: Option<f64>,
    /// Whether it is a catch trial.
    pub catch: bool,
    /// Clip of the level.
    pub clip: String,
    /// Clip that it is held against.
    pub against: String,
    /// Whether that one stands left.
    pub left: bool,
}

/// The display and the page, no finer than the analysis needs.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Client {
    /// Width and height of the window, CSS pixels.
    #[serde(default)]
    pub viewport: [u32; 2],
    /// Device pixels per CSS pixel.
    #[serde(default)]
    pub device_pixel_ratio: f64,
    /// Browser name, its major version, platform class.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub about: BTreeMap<String, String>,
}

/// The size of a CSS pixel and the distance of the eyes, as the participant set them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Calibrated {
    /// CSS pixels per millimetre; none if it was left out.
    pub px_per_mm: Option<f64>,
    /// Device pixels per CSS pixel at that moment: zooming the page changes both.
    pub device_pixel_ratio: f64,
    /// Distance from eyes to screen, centimetres, as the participant says.
    pub distance_cm: Option<f64>,
}

impl Calibrated {
    /// CSS pixels per millimetre in a window of that many device pixels per CSS pixel.
    pub fn px_per_mm_at(&self, device_pixel_ratio: f64) -> Option<f64> {
        let ratio = self.device_pixel_ratio / device_pixel_ratio;
        self.px_per_mm.map(|px| if ratio.is_finite() && ratio > 0.0 { px * ratio } else { px })
    }
}

/// What was heard while a clip was played once (`static/sound/sound.js`), as [`PlayLog::sound`] holds it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SoundLog {
    /// `played`, or why not: `suspended`, `undecodable`, `no_audio`, `interrupted`, `not_started`.
    pub status: String,
    /// When the sound of the segment's first frame was heard, milliseconds after the first drawn frame.
    pub offset_ms: Option<f64>,
    /// The delay that the study asks for, milliseconds.
    pub delay_ms: f64,
    /// How much later the sound was at the last frame than at the first, milliseconds.
    pub drift_ms: Option<f64>,
    /// From the audio clock to the loudspeaker, milliseconds.
    pub latency_ms: Option<f64>,
    /// What gave it: `timestamp`, `outputLatency`, `baseLatency` or `none`.
    pub latency_source: String,
    /// Whether captions were shown.
    pub captions: bool,
    /// Hash of the file.
    pub file: String,
}

/// What the stage measured while a clip was played once (`static/stage/host.js`, `stage.play`).
/// Fields that this version does not know are left out, those that are missing are zero.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PlayLog {
    /// `webgpu` or `webgl2`.
    pub backend: String,
    /// When the first frame was presented, page clock.
    pub onset_ms: f64,
    /// When the last frame was presented, page clock.
    pub end_ms: f64,
    /// The display's rate as measured, Hz.
    pub refresh_hz: f64,
    /// A frame each: when it was presented (ms after the onset), clip time (ms), 1 if late.
    pub frames: Vec<(f64, f64, f64)>,
    /// Number of late frames.
    pub late: u32,
    /// The longest time between two frames, milliseconds.
    pub longest_ms: f64,
    /// Width of the canvas, CSS pixels.
    pub width: f64,
    /// Height of the canvas, CSS pixels.
    pub height: f64,
    /// Device pixels per CSS pixel.
    pub device_pixel_ratio: f64,
    /// SHA-256 of the weights as the browser solved them, hexadecimal.
    pub weights_hash: String,
    /// Provenance of the clip that was shown, as the page had it; empty in logs of earlier versions.
    pub provenance: String,
    /// Side by side: that of the other clip.
    pub beside_provenance: String,
    /// What drew it: the hash in the address of the page's modules and shaders.
    pub renderer: String,
    /// Of several clips in step: the largest time between what two of them showed in one frame, milliseconds.
    pub drift_ms: f64,
    /// Of a panel: each clip that was played, [`ShownInPanel`]s, which the page hands on as they are; else null.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub panel: Value,
    /// Of a panel: the place of the clip that was played alone, from 1; 0 is the open reference. Null where all were
    /// played.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alone: Option<u32>,
    /// What was heard: a [`SoundLog`], which the page hands on as it is; null for a clip without sound.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub sound: Value,
    /// The participant's face: a [`crate::TrackedFace`], which the page hands on as it is; null where none was to be
    /// measured.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub mimicry: Value,
    /// How many messages of the play another program on the machine was sent; null where it was not there, or where
    /// the study tells none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triggers: Option<u32>,
    /// Of ratings that follow the clip: question -> where its line stood, `mimique_study::TRACE_HZ` times a second. The
    /// machine makes answers of it and keeps none.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub traces: Value,
    /// Why the play ended early; null for a whole play.
    pub aborted: Option<String>,
}

impl PlayLog {
    /// What the page notes of a play that showed fewer frames than the study wants.
    pub const TOO_FEW_FRAMES: &str = "too few frames";
    /// Why a play ended early that was not wholly in view (`static/participant/bridge.js`).
    pub const OUT_OF_VIEW: &str = "out of view";

    /// What the page notes of the first play of a trial whose sound was not played.
    pub const NO_SOUND: &str = "no sound";

    /// Whether a clip with sound was played without it.
    pub fn is_mute(&self) -> bool {
        self.sound.get("status").is_some_and(|status| status != "played")
    }

    /// What was heard; none for a clip without sound.
    pub fn sound_log(&self) -> Option<SoundLog> {
        SoundLog::deserialize(&self.sound).ok()
    }

    /// The clips of a panel as they were played; none of other trials.
    pub fn shown_in_panel(&self) -> Vec<ShownInPanel> {
        Vec::deserialize(&self.panel).unwrap_or_default()
    }

    /// Whether the clip was shown to its end.
    pub fn is_whole(&self) -> bool {
        self.aborted.is_none()
    }
}
