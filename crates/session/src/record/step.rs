//! What was measured of one page or trial: while it stands on the screen, and when it was finished.

use std::collections::BTreeMap;

use mimique_study::Answers;

use crate::event::{Calibrated, Client, LevelShown, PlayLog, ShownBeside};
use crate::tracked_face;

/// The page or trial on the screen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attempt {
    /// When it stood on the screen, page clock.
    pub shown_ms: f64,
    /// When the first play of the trial was asked for, page clock.
    pub started_ms: Option<f64>,
    /// What is played beside the trial's own clip.
    pub beside: Option<ShownBeside>,
    /// The clips of a panel, from the first place to the last; empty elsewhere.
    pub panel: Vec<String>,
    /// Whole plays of one clip of a panel alone, by its place from 1; 0 is the open reference.
    pub alone: BTreeMap<u32, u32>,
    /// Of a pair that follows from answers: its batch, from 1.
    pub batch: Option<u32>,
    /// The level of a trial of an adaptive block.
    pub level: Option<Box<LevelShown>>,
    /// Whole plays.
    pub plays: u32,
    /// Whole plays before the page was opened again, by which the trial began anew.
    pub earlier_plays: u32,
    /// The first whole play, without its frames and the pictures of the participant's face: these are counted.
    pub play: Option<PlayLog>,
    /// Frames that the first whole play showed.
    pub frames: usize,
    /// Plays that showed too few frames.
    pub slow_plays: u32,
    /// Plays whose sound was not played.
    pub mute_plays: u32,
    /// Whether the page filled the screen in that play.
    pub play_fullscreen: bool,
    /// Why the last play does not count, if it does not.
    pub cut_short: Option<CutShort>,
    /// When answers could first be given, page clock.
    pub answering_ms: Option<f64>,
    /// When each answer was last changed, page clock.
    pub answered_ms: BTreeMap<String, f64>,
    /// How often the time of the step was extended.
    pub extensions: u32,
    /// How often a play was cut short, or the page was opened again before the clip was seen whole.
    pub interruptions: u32,
    /// How often the page lost the focus or was hidden.
    pub focus_losses: u32,
}

impl Attempt {
    /// A page or trial that stands there from this time on.
    pub(super) fn shown_at(at_ms: f64) -> Self {
        Self { shown_ms: at_ms, ..Self::default() }
    }

    /// Whether the first play of the trial was asked for.
    pub fn is_started(&self) -> bool {
        self.started_ms.is_some()
    }

    /// Onset of the first whole play, page clock.
    pub fn onset_ms(&self) -> Option<f64> {
        self.play.as_ref().map(|play| play.onset_ms)
    }

    /// The clip was played, wholly or not.
    pub(super) fn played(&mut self, mut log: PlayLog, fullscreen: bool, at_ms: f64) {
        self.cut_short = CutShort::of(&log);
        if let Some(why) = self.cut_short {
            self.interruptions += 1;
            self.slow_plays += u32::from(why == CutShort::TooFewFrames);
            self.mute_plays += u32::from(why == CutShort::NoSound);
            return;
        }
        if let Some(place) = log.alone {
            *self.alone.entry(place).or_default() += 1;
            return;
        }
        self.plays += 1;
        self.answering_ms.get_or_insert(at_ms);
        if self.play.is_none() {
            self.frames = std::mem::take(&mut log.frames).len();
            tracked_face::in_short(&mut log.mimicry);
            self.play = Some(log);
            self.play_fullscreen = fullscreen;
        }
    }

    /// The page was opened again: a trial that had begun starts anew; the answers of a page stay, with
    /// their times.
    pub(super) fn resumed(&mut self) {
        self.interruptions += u32::from(self.plays == 0);
        if self.is_started() {
            *self = Self {
                shown_ms: self.shown_ms,
                // The same level again: it follows from the answers before.
                level: self.level.take(),
                earlier_plays: self.earlier_plays + self.plays,
                slow_plays: self.slow_plays,
                mute_plays: self.mute_plays,
                interruptions: self.interruptions,
                focus_losses: self.focus_losses,
                ..Self::default()
            };
        }
    }
}

/// Why a play does not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CutShort {
    /// It was stopped, the page was hidden, or the renderer was lost.
    Interrupted,
    /// A part of the picture was not in the window.
    OutOfView,
    /// It showed fewer frames than the study wants.
    TooFewFrames,
    /// Its sound was not played.
    NoSound,
}

impl CutShort {
    /// Why a play does not count; none for one that does.
    fn of(log: &PlayLog) -> Option<Self> {
        match log.aborted.as_deref()? {
            PlayLog::OUT_OF_VIEW => Some(Self::OutOfView),
            PlayLog::TOO_FEW_FRAMES => Some(Self::TooFewFrames),
            PlayLog::NO_SOUND => Some(Self::NoSound),
            _ => Some(Self::Interrupted),
        }
    }
}

/// A page or trial that was finished.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FinishedStep {
    /// Identifier of the step.
    pub id: String,
    /// The clip, of a trial.
    pub clip: Option<String>,
    /// The answers that were sent.
    pub answers: Answers,
    /// When it began: of a trial when its first play was asked for, of a page when it stood there; page
    /// clock.
    pub start_ms: f64,
    /// When it was finished, page clock.
    pub end_ms: f64,
    /// From the first frame of the first whole play to the end of a trial, milliseconds.
    pub rt_ms: Option<f64>,
    /// Whole plays after the first.
    pub replays: u32,
    /// Whether its time was over.
    pub timed_out: bool,
    /// Whether the page filled the screen when the clip was played (of a page: when it was sent).
    pub fullscreen: bool,
    /// What was measured of it before.
    pub attempt: Attempt,
    /// The page as it was opened.
    pub client: Client,
    /// The size of a CSS pixel.
    pub calibrated: Calibrated,
}

impl FinishedStep {
    /// Adds the answers that conditions on later questions go by: those of pages, not of trials.
    pub(crate) fn keep_answers(&self, kept: &mut Answers) {
        if self.clip.is_none() {
            kept.extend(self.answers.iter().map(|(id, value)| (id.clone(), value.clone())));
        }
    }
}

/// How a session ended before its last page.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlyEnd {
    /// Identifier of the step that stood on the screen.
    pub step: String,
    /// Why.
    pub reason: EndReason,
    /// When, page clock.
    pub at_ms: f64,
}

/// Why a session ended before its last page.
#[derive(Debug, Clone, PartialEq)]
pub enum EndReason {
    /// The study does not take this participant.
    ScreenedOut {
        /// `device`, `frames`, `sound`, `screening` or `training`.
        by: String,
        /// What was missing: the rules' keys, or the question.
        details: Vec<String>,
    },
    /// More attention checks were failed than the study allows.
    ChecksFailed {
        /// How many were failed.
        failed: u32,
    },
}
