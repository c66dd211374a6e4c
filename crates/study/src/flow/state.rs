//! The state of a session: what its events make of it, and what only this page knows.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::plan::{Plan, StepKind};
use crate::event::{Answers, EventKind};
use crate::wire::{self, Receipt};

/// The state of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// What the stored events make of it: the same after every reload.
    pub record: Record,
    /// What only this page knows.
    pub live: Live,
}

/// How far the session is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Status {
    /// Under way.
    #[default]
    Active,
    /// The participant did not agree.
    Declined,
    /// Every step is done.
    Finished,
    /// The participant took everything back.
    Withdrawn,
}

/// A fold of the events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Number of events: the sequence of the next one.
    pub events: u64,
    /// Language of the pages; empty before the first event.
    pub language: String,
    /// How far the session is.
    pub status: Status,
    /// Index of the step that stands on the screen.
    pub step: usize,
    /// When that step was reached, page clock.
    pub entered_ms: f64,
    /// Answers on the screen, not yet sent.
    pub drafts: Answers,
    /// Answers of the pages of questions before (not of trials).
    pub answers: Answers,
    /// The trial on the screen.
    pub trial: Progress,
    /// How often the page was opened again.
    pub resumptions: u32,
    /// Number of events that a later trial must not start without: those up to the last finished
    /// step.
    pub checkpoint: u64,
    /// Version of the agreement.
    pub consent_version: Option<String>,
    /// Whether the page has the focus.
    pub focused: bool,
    /// Events and inputs that did not fit.
    pub unexpected: u32,
    /// Time of the last event, page clock.
    pub last_ms: f64,
}

/// The trial on the screen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// Whether its first play was asked for.
    pub started: bool,
    /// Whole plays.
    pub plays: u32,
    /// Onset of the first whole play, page clock.
    pub onset_ms: Option<f64>,
    /// Whether the last play was cut short.
    pub cut_short: bool,
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
    /// Clips that can be played.
    pub prepared: BTreeSet<String>,
    /// Clips on their way, 0..1.
    pub progress: BTreeMap<String, f64>,
    /// Clips that failed, and why.
    pub failed: BTreeMap<String, String>,
    /// Whether a clip is being played.
    pub play: Play,
    /// Whether missing answers are pointed out.
    pub show_problems: bool,
    /// Events that the server has.
    pub stored: u64,
    /// Whether the server was asked to complete the session.
    pub completing: bool,
    /// The server's receipt.
    pub receipt: Option<Receipt>,
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
        state.record.focused = true;
        state
    }

    /// The state after stored events, in ascending order of sequence without gaps (merge what the
    /// server has with what still lies in the outbox). Events that this version cannot read, or
    /// that do not fit, change nothing but the count.
    pub fn replay(plan: &Plan, events: &[wire::Event]) -> Self {
        let mut state = Self::new(plan, plan.study.default_language());
        for event in events {
            match EventKind::from_body(&event.body) {
                Some(kind) => state.record.apply(plan, &kind, event.at_ms),
                None => state.record.unexpected += 1,
            }
            // The sequence is the event's own, so that a gap is never filled by another event.
            state.record.events = state.record.events.max(event.sequence + 1);
        }
        state.live.now_ms = state.record.last_ms;
        state
    }
}

impl Record {
    /// Applies one event. What does not fit is counted and changes nothing.
    pub(super) fn apply(&mut self, plan: &Plan, event: &EventKind, at_ms: f64) {
        self.events += 1;
        self.last_ms = at_ms;
        if !self.take(plan, event, at_ms) {
            self.unexpected += 1;
        }
    }

    fn take(&mut self, plan: &Plan, event: &EventKind, at_ms: f64) -> bool {
        let active = self.status == Status::Active;
        let here = |step: &String| plan.step(self.step).is_some_and(|each| each.id == *step);
        match event {
            EventKind::Opened { language, .. } => {
                self.language = plan.study.language_for(language).to_owned();
                self.entered_ms = at_ms;
                true
            }
            EventKind::LanguageChosen { language } => {
                self.language = plan.study.language_for(language).to_owned();
                true
            }
            EventKind::Consented { version, .. } => {
                if !active || !self.is_at_consent(plan) {
                    return false;
                }
                self.consent_version = Some(version.clone());
                self.enter(self.step + 1, at_ms);
                true
            }
            EventKind::Declined => {
                if !active || !self.is_at_consent(plan) {
                    return false;
                }
                self.status = Status::Declined;
                true
            }
            EventKind::PageShown { step } => active && here(step),
            EventKind::Answered { step, question, value } => {
                if !active || !here(step) {
                    return false;
                }
                if value.is_null() {
                    self.drafts.remove(question);
                } else {
                    self.drafts.insert(question.clone(), value.clone());
                }
                true
            }
            EventKind::PageFinished { step, answers } => {
                let is_trial = plan.step(self.step).is_some_and(|each| each.trial().is_some());
                if !active || !here(step) || is_trial {
                    return false;
                }
                self.answers.extend(answers.iter().map(|(id, value)| (id.clone(), value.clone())));
                self.enter(self.step + 1, at_ms);
                true
            }
            EventKind::TrialStarted { step, .. } => {
                if !active || !here(step) {
                    return false;
                }
                self.trial.started = true;
                true
            }
            EventKind::TrialPlayed { step, log } => {
                if !active || !here(step) || !self.trial.started {
                    return false;
                }
                self.trial.cut_short = !log.is_whole();
                if log.is_whole() {
                    self.trial.plays += 1;
                    self.trial.onset_ms.get_or_insert(log.onset_ms);
                }
                true
            }
            EventKind::TrialFinished { step, .. } => {
                if !active || !here(step) {
                    return false;
                }
                self.enter(self.step + 1, at_ms);
                true
            }
            EventKind::FocusLost => {
                self.focused = false;
                true
            }
            EventKind::FocusGained => {
                self.focused = true;
                true
            }
            EventKind::Resumed { .. } => {
                self.resumptions += 1;
                self.focused = true;
                if plan.step(self.step).is_some_and(|step| step.trial().is_some()) {
                    self.drafts.clear();
                    self.trial = Progress::default();
                }
                true
            }
            EventKind::Finished => {
                if !active || self.step < plan.steps.len() {
                    return false;
                }
                self.status = Status::Finished;
                true
            }
            EventKind::Withdrawn => {
                self.status = Status::Withdrawn;
                true
            }
            EventKind::ClipFailed { .. } | EventKind::Fullscreen { .. } => true,
            EventKind::Unexpected { .. } => false,
        }
    }

    fn is_at_consent(&self, plan: &Plan) -> bool {
        plan.step(self.step).is_some_and(|step| step.kind == StepKind::Consent)
    }

    fn enter(&mut self, step: usize, at_ms: f64) {
        self.step = step;
        self.entered_ms = at_ms;
        self.drafts.clear();
        self.trial = Progress::default();
        self.checkpoint = self.events;
    }

    /// The draft of a question, if there is one.
    pub(super) fn draft(&self, question: &str) -> Option<&Value> {
        self.drafts.get(question)
    }
}
