//! The state of a session: what its events make of it, and what only this page knows.

use serde_json::Value;

use super::plan::{Plan, Step, StepKind};
use crate::answer::alike;
use crate::event::{Answers, Calibrated, Display, EventKind};
use crate::sorted_map::SortedMap;
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
    /// The study does not take this participant.
    ScreenedOut,
    /// More attention checks were failed than the study allows.
    ChecksFailed,
    /// The participant took everything back.
    Withdrawn,
}

impl Status {
    /// Whether a session with this status waits for its receipt, and then shows its code.
    pub fn has_receipt(self) -> bool {
        matches!(self, Self::Finished | Self::ScreenedOut | Self::ChecksFailed)
    }
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
    /// Whether the page fills the screen.
    pub fullscreen: bool,
    /// What browser and display can do, as last measured.
    pub display: Option<Display>,
    /// How often that was recorded.
    pub measurements: u32,
    /// The size of a CSS pixel.
    pub calibrated: Option<Calibrated>,
    /// Answers to the practice clip before.
    pub practised: Answers,
    /// Practice clips of this round that were answered right.
    pub right: u32,
    /// Whether the last round of practice ended without success.
    pub training_failed: bool,
    /// Attention checks that were failed.
    pub failed_checks: u32,
    /// Why the study does not take this participant: reason and details.
    pub screened_out: Option<(String, Vec<String>)>,
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
    /// When answers could first be given, page clock.
    pub answering_ms: Option<f64>,
    /// How often the time of the step was extended.
    pub extensions: u32,
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
    pub prepared: SortedMap<String, ()>,
    /// Clips on their way, 0..1.
    pub progress: SortedMap<String, f64>,
    /// Clips that failed, and why.
    pub failed: SortedMap<String, String>,
    /// Whether a clip is being played.
    pub play: Play,
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
            EventKind::PageFinished { step, answers, .. } => {
                let is_trial = plan.step(self.step).is_some_and(|each| each.trial().is_some());
                if !active || !here(step) || is_trial {
                    return false;
                }
                self.count_failed_checks(plan, answers);
                self.answers.extend(answers.iter().map(|(id, value)| (id.clone(), value.clone())));
                self.advance(plan, at_ms);
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
                    self.trial.answering_ms.get_or_insert(at_ms);
                }
                true
            }
            EventKind::TrialFinished { step, answers, .. } => {
                let trial = plan.step(self.step).and_then(Step::trial);
                let Some(trial) = trial.filter(|_| active && here(step)) else { return false };
                if trial.training {
                    let is_right = |(id, right): (&String, &Value)| {
                        answers.get(id).is_some_and(|given| alike(given, right))
                    };
                    self.right += u32::from(trial.right.iter().all(is_right));
                    self.practised = answers.clone();
                }
                self.count_failed_checks(plan, answers);
                self.advance(plan, at_ms);
                true
            }
            EventKind::TimeExtended { step } => {
                if !active || !here(step) {
                    return false;
                }
                self.trial.extensions += 1;
                true
            }
            EventKind::DeviceMeasured { display } => {
                self.display = Some(display.clone());
                self.measurements += 1;
                true
            }
            EventKind::Calibrated(calibrated) => {
                self.calibrated = Some(calibrated.clone());
                true
            }
            EventKind::ScreenedOut { reason, details, .. } => {
                if !active {
                    return false;
                }
                self.status = Status::ScreenedOut;
                self.screened_out = Some((reason.clone(), details.clone()));
                true
            }
            EventKind::ChecksFailed { .. } => {
                if !active {
                    return false;
                }
                self.status = Status::ChecksFailed;
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
                self.fullscreen = false;
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
            EventKind::Fullscreen { on } => {
                self.fullscreen = *on;
                true
            }
            EventKind::ClipFailed { .. } => true,
            EventKind::Unexpected { .. } => false,
        }
    }

    fn is_at_consent(&self, plan: &Plan) -> bool {
        plan.step(self.step).is_some_and(|step| step.kind == StepKind::Consent)
    }

    /// To the next step; from the end of a round of practice that is the next round, or what follows
    /// practice.
    fn advance(&mut self, plan: &Plan, at_ms: f64) {
        let mut next = self.step + 1;
        if plan.rounds.contains(&next) {
            let training = plan.study.training.as_ref();
            let wanted = training.and_then(|it| it.criterion.as_ref()).map(|rule| rule.correct);
            let enough = wanted.is_none_or(|wanted| self.right >= wanted);
            let last = plan.rounds.last().copied().unwrap_or(next);
            if enough {
                next = last;
            } else if next == last {
                self.training_failed = true;
            }
            self.right = 0;
        }
        self.enter(next, at_ms);
    }

    /// Counts the attention checks of the page or trial on the screen that these answers fail.
    fn count_failed_checks(&mut self, plan: &Plan, answers: &Answers) {
        let questions = plan.step(self.step).map_or(&[][..], Step::questions);
        for question in questions.iter().filter(|each| each.is_shown(answers, &self.answers)) {
            if let Some(check) = &question.attention_check {
                let given = answers.get(&question.id);
                let passed = given.is_some_and(|given| alike(given, &check.expected));
                self.failed_checks += u32::from(!passed);
            }
        }
    }

    fn enter(&mut self, step: usize, at_ms: f64) {
        self.step = step;
        self.entered_ms = at_ms;
        self.drafts.clear();
        self.trial = Progress::default();
        self.checkpoint = self.events;
    }

    /// The draft of a question, if there is one.
    pub fn draft(&self, question: &str) -> Option<&Value> {
        self.drafts.get(question)
    }
}
