//! The state of a session: what its events make of it, and what only this page knows.

use std::collections::BTreeMap;

use crate::event::{Calibrated, StageFailure};
use crate::plan::Plan;
use crate::record::Record;
use crate::wire::{Event, Receipt};
use mimique_study::Multilingual as _;

/// The state of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// What the stored events make of it: the same after every reload.
    pub record: Record,
    /// What only this page knows.
    pub live: Live,
}

/// A play in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Play {
    /// Nothing is being played.
    #[default]
    Still,
    /// The stage was asked to play.
    Running,
}

/// What only this page knows; gone after a reload.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Live {
    /// Clips that can be played: their names alone.
    pub prepared: BTreeMap<String, ()>,
    /// Clips on their way, 0..1.
    pub progress: BTreeMap<String, f64>,
    /// Clips that failed, and why.
    pub failed: BTreeMap<String, StageFailure>,
    /// Whether a clip is being played.
    pub play: Play,
    /// The place of a panel that is being played alone; none where all are.
    pub alone: Option<u32>,
    /// Whether missing answers are pointed out.
    pub show_problems: bool,
    /// Whether the device gate waits for the screen to be filled.
    pub entering: bool,
    /// The calibration on the screen.
    pub calibration: Calibrated,
    /// Whether the participant has no card.
    pub no_card: bool,
    /// Whether the time of the step before was over.
    pub timed_out: bool,
    /// Events that the server has.
    pub stored: u64,
    /// Whether the server was asked to complete the session.
    pub completing: bool,
    /// The server's receipt.
    pub receipt: Option<Receipt>,
    /// When the last page goes back by itself, page clock.
    pub return_ms: Option<f64>,
    /// Whether the completion code was copied.
    pub copied: bool,
    /// Whether the server was asked to delete everything.
    pub withdrawing: bool,
    /// Whether it has done so.
    pub withdrawal_confirmed: bool,
    /// The latest time given, page clock.
    pub now_ms: f64,
}

impl State {
    /// The state before the first event.
    pub fn new(plan: &Plan, language: &str) -> Self {
        let mut state = Self::default();
        state.record.language = plan.study.language_for(language).to_owned();
        state
    }

    /// The state after stored events, in ascending order of sequence without gaps (merge what the
    /// server has with what still lies in the outbox). Events that this version cannot read, or
    /// that do not fit, change nothing but the counts.
    pub fn replay(plan: &Plan, events: &[Event]) -> Self {
        let mut state = Self { record: Record::of(Some(plan), events), live: Live::default() };
        if state.record.language.is_empty() {
            state.record.language = plan.study.default_language().to_owned();
        }
        state.live.now_ms = state.record.last_ms;
        state
    }
}
