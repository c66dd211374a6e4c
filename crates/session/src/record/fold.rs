//! The fold: one event after the other.

use mimique_study::{Answers, Multilingual as _, alike, component_of};
use serde_json::Value;

use super::Record;
use super::step::{Attempt, EarlyEnd, EndReason, FinishedStep};
use crate::event::{Client, EventKind, LevelShown, PlayLog};
use crate::flow::unmet;
use crate::plan::{Plan, Step, StepKind, TrialStep};
use crate::standing::Standing;

impl Record {
    /// Applies one event. What does not fit is counted and changes neither the place nor the standing.
    pub(crate) fn apply(&mut self, plan: Option<&Plan>, event: EventKind, at_ms: f64) {
        self.events += 1;
        self.last_ms = at_ms;
        self.pass_unasked_gate(plan, &event, at_ms);
        if !self.takes(plan, event, at_ms) {
            self.unexpected += 1;
        }
    }

    /// A gate for which the study has no rules is passed by a measurement that lacks nothing. Sessions of
    /// before there was one go on behind it.
    fn pass_unasked_gate(&mut self, plan: Option<&Plan>, event: &EventKind, at_ms: f64) {
        let Some(plan) = plan.filter(|plan| plan.study.device.is_none()) else { return };
        if self.here(Some(plan)).is_none_or(|step| step.kind != StepKind::Device) {
            return;
        }
        let passes = match event {
            EventKind::DeviceMeasured { display } => unmet(&plan.study, display).is_empty(),
            event => {
                let behind = plan.step(self.step + 1).map(|step| step.id.as_str());
                event.step().is_some_and(|step| Some(step) == behind)
            }
        };
        if passes && self.standing.is_open() {
            self.enter(self.step + 1, at_ms);
        }
    }

    /// Takes an event; false if it does not fit.
    fn takes(&mut self, plan: Option<&Plan>, event: EventKind, at_ms: f64) -> bool {
        match event {
            EventKind::Opened { client, language } => self.opened(plan, client, &language, at_ms),
            EventKind::Resumed { client } => self.resumed(plan, client),
            EventKind::LanguageChosen { language } => self.speaks(plan, &language),
            EventKind::Consented { version, language } => {
                self.consented(plan, version, &language, at_ms)
            }
            EventKind::PageShown { step } => self.page_shown(plan, &step, at_ms),
            EventKind::Answered { step, question, value } => {
                self.answered(plan, &step, question, value, at_ms)
            }
            EventKind::TrialStarted { step, beside, panel, batch, .. } => {
                let fits = self.is_at(plan, &step);
                if fits {
                    self.attempt.started_ms = Some(at_ms);
                    self.attempt.beside = beside;
                    self.attempt.panel = panel;
                    self.attempt.batch = batch;
                }
                fits
            }
            EventKind::PairsDrawn { step, pairs, .. } => {
                let fits = self.is_at(plan, &step);
                if fits {
                    self.drawn.entry(component_of(&step).to_owned()).or_default().push(pairs);
                }
                fits
            }
            EventKind::LevelChosen { step, track, level, entropy, catch, clip, against, left } => {
                let fits = self.is_at(plan, &step);
                if fits {
                    let shown =
                        LevelShown { step, track, level, entropy, catch, clip, against, left };
                    self.attempt.level = Some(Box::new(shown));
                }
                fits
            }
            EventKind::LevelsOver { step } => {
                let fits = self.is_at(plan, &step);
                if let Some(plan) = plan.filter(|_| fits) {
                    self.enter(after_block(plan, self.step), at_ms);
                }
                fits
            }
            EventKind::TrialPlayed { step, log } => self.played(plan, &step, *log, at_ms),
            EventKind::PageFinished { step, answers, timed_out } => {
                let done = FinishedStep { id: step, answers, timed_out, ..Default::default() };
                self.page_finished(plan, done, at_ms)
            }
            EventKind::TrialFinished { step, clip, answers, rt_ms, replays, timed_out } => {
                let (clip, rt_ms) = (Some(clip), Some(rt_ms));
                let rest = FinishedStep::default();
                let done =
                    FinishedStep { id: step, clip, answers, rt_ms, replays, timed_out, ..rest };
                self.trial_finished(plan, done, at_ms)
            }
            EventKind::TimeExtended { step } => {
                let fits = self.is_at(plan, &step);
                self.attempt.extensions += u32::from(fits);
                fits
            }
            other => self.notes(other, at_ms),
        }
    }

    /// Takes an event that belongs to no step: what was measured, or an end.
    fn notes(&mut self, event: EventKind, at_ms: f64) -> bool {
        match event {
            EventKind::DeviceMeasured { display } => {
                self.display = Some(display);
                self.measurements += 1;
                true
            }
            EventKind::Calibrated(calibrated) => {
                self.calibrated = Some(calibrated);
                true
            }
            EventKind::FocusLost => {
                self.focused = false;
                self.attempt.focus_losses += 1;
                true
            }
            EventKind::FocusGained => {
                self.focused = true;
                true
            }
            EventKind::Fullscreen { on } => {
                self.fullscreen = on;
                true
            }
            EventKind::ClipFailed { .. } => true,
            EventKind::Unexpected { .. } => false,
            end => self.ends(end, at_ms),
        }
    }

    /// Takes an event that ends the session. The first end counts; only who takes everything back does so
    /// at any time. This asks for no plan, so that everybody agrees on how a session stands.
    fn ends(&mut self, event: EventKind, at_ms: f64) -> bool {
        let (standing, early_end) = match event {
            EventKind::Withdrawn => {
                self.standing = Standing::Withdrawn;
                return true;
            }
            EventKind::Finished => (Standing::Completed, None),
            // Whoever has agreed, or has gone on without being asked, can no longer decline.
            EventKind::Declined if self.consent_version.is_some() || !self.finished.is_empty() => {
                return false;
            }
            EventKind::Declined => (Standing::Declined, None),
            EventKind::ScreenedOut { step, reason: by, details } => {
                let standing = match by.as_str() {
                    "device" | "frames" => Standing::DeviceRefused,
                    "training" => Standing::PracticeFailed,
                    _ => Standing::ScreenedOut,
                };
                (standing, Some((step, EndReason::ScreenedOut { by, details })))
            }
            EventKind::ChecksFailed { failed } => {
                let end = ("end".to_owned(), EndReason::ChecksFailed { failed });
                (Standing::ChecksFailed, Some(end))
            }
            _ => return false,
        };
        if !self.standing.is_open() {
            return false;
        }
        self.standing = standing;
        self.early_end = early_end.map(|(step, reason)| EarlyEnd { step, reason, at_ms });
        true
    }

    fn opened(&mut self, plan: Option<&Plan>, client: Client, language: &str, at_ms: f64) -> bool {
        self.opened_ms = at_ms;
        self.entered_ms = at_ms;
        self.attempt.shown_ms = at_ms;
        self.client = client;
        self.speaks(plan, language)
    }

    fn resumed(&mut self, plan: Option<&Plan>, client: Client) -> bool {
        self.resumptions += 1;
        self.client = client;
        self.focused = true;
        self.fullscreen = false;
        let is_trial = self.here(plan).is_some_and(|step| step.trial().is_some());
        if is_trial || self.attempt.is_started() {
            self.drafts.clear();
        }
        self.attempt.resumed();
        true
    }

    /// The language of the pages: one that the study has, where the study is known.
    fn speaks(&mut self, plan: Option<&Plan>, language: &str) -> bool {
        let language = plan.map_or(language, |plan| plan.study.language_for(language));
        self.language = language.to_owned();
        true
    }

    fn consented(
        &mut self,
        plan: Option<&Plan>,
        version: String,
        language: &str,
        at_ms: f64,
    ) -> bool {
        if !self.standing.is_open() || self.consent_version.is_some() {
            return false;
        }
        self.consent_version = Some(version);
        self.speaks(plan, language);
        let fits = plan.is_none() || self.here(plan).is_some_and(|it| it.kind == StepKind::Consent);
        if fits {
            self.enter(self.step + 1, at_ms);
        }
        fits
    }

    fn page_shown(&mut self, plan: Option<&Plan>, step: &str, at_ms: f64) -> bool {
        let fits = self.is_at(plan, step);
        if fits && !self.attempt.is_started() {
            self.attempt.shown_ms = at_ms;
        }
        fits
    }

    fn answered(
        &mut self,
        plan: Option<&Plan>,
        step: &str,
        question: String,
        value: Value,
        at_ms: f64,
    ) -> bool {
        if !self.is_at(plan, step) {
            return false;
        }
        self.attempt.answered_ms.insert(question.clone(), at_ms);
        if value.is_null() {
            self.drafts.remove(&question);
        } else {
            self.drafts.insert(question, value);
        }
        true
    }

    fn played(&mut self, plan: Option<&Plan>, step: &str, log: PlayLog, at_ms: f64) -> bool {
        let fits = self.is_at(plan, step) && (plan.is_none() || self.attempt.is_started());
        if fits {
            self.attempt.played(log, self.fullscreen, at_ms);
        }
        fits
    }

    fn page_finished(&mut self, plan: Option<&Plan>, mut done: FinishedStep, at_ms: f64) -> bool {
        let is_trial = self.here(plan).is_some_and(|step| step.trial().is_some());
        let fits = self.is_at(plan, &done.id) && !is_trial;
        let answers = if fits { done.answers.clone() } else { Answers::new() };
        done.fullscreen = self.fullscreen;
        done.start_ms = self.attempt.shown_ms;
        self.keep(done, fits, at_ms);
        if fits {
            self.answers.extend(answers);
            self.advance(plan, at_ms);
        }
        fits
    }

    fn trial_finished(&mut self, plan: Option<&Plan>, mut done: FinishedStep, at_ms: f64) -> bool {
        let trial = self.here(plan).and_then(Step::trial);
        let fits = self.is_at(plan, &done.id) && (plan.is_none() || trial.is_some());
        if let Some(trial) = trial.filter(|trial| fits && trial.training) {
            self.right += u32::from(is_right(trial, &done.answers));
            self.practised = done.answers.clone();
        }
        done.fullscreen = self.attempt.play_fullscreen;
        done.start_ms = self.attempt.started_ms.unwrap_or(self.attempt.shown_ms);
        self.keep(done, fits, at_ms);
        if fits {
            self.advance(plan, at_ms);
        }
        fits
    }

    /// Keeps what was finished, once: a second report of a step is another tab's. What is finished
    /// without having stood on the screen is kept without measurements.
    fn keep(&mut self, done: FinishedStep, fits: bool, at_ms: f64) {
        let attempt = if fits { std::mem::take(&mut self.attempt) } else { Attempt::default() };
        if fits {
            self.attempt = Attempt::shown_at(at_ms);
        }
        if self.finished.iter().any(|known| known.id == done.id) {
            return;
        }
        self.finished.push(FinishedStep {
            end_ms: at_ms,
            attempt,
            client: self.client.clone(),
            calibrated: self.calibrated.clone().unwrap_or_default(),
            ..done
        });
    }

    /// To the next step; from the end of a round of practice that is the next round, or what follows
    /// practice.
    fn advance(&mut self, plan: Option<&Plan>, at_ms: f64) {
        let mut next = self.step + 1;
        if let Some(plan) = plan.filter(|plan| plan.rounds.contains(&next)) {
            let training = plan.study.training.as_ref();
            let wanted = training.and_then(|it| it.criterion.as_ref()).map(|rule| rule.correct);
            let enough = wanted.is_none_or(|wanted| self.right >= wanted);
            let last = plan.rounds.last().copied().unwrap_or(next);
            if enough {
                next = last;
            } else if next == last {
                self.practice_failed = true;
            }
            self.right = 0;
        }
        self.enter(next, at_ms);
    }

    fn enter(&mut self, step: usize, at_ms: f64) {
        self.step = step;
        self.entered_ms = at_ms;
        self.drafts.clear();
        self.attempt = Attempt::shown_at(at_ms);
        self.checkpoint = self.events;
    }

    /// The step on the screen; none without a plan.
    fn here<'p>(&self, plan: Option<&'p Plan>) -> Option<&'p Step> {
        plan.and_then(|plan| plan.step(self.step))
    }

    /// Whether this step can be the one on the screen.
    fn is_at(&self, plan: Option<&Plan>, step: &str) -> bool {
        plan.is_none()
            || self.standing.is_open() && self.here(plan).is_some_and(|here| here.id == step)
    }
}

/// The first step behind the trials of an adaptive block; what interrupts them is left out with them.
fn after_block(plan: &Plan, from: usize) -> usize {
    let component = |step: &Step| component_of(&step.id).to_owned();
    let Some(own) = plan.step(from).map(component) else { return from };
    plan.steps.iter().rposition(|step| component(step) == own).map_or(from, |last| last + 1)
}

/// Whether every answer to a practice clip is the right one.
fn is_right(trial: &TrialStep, answers: &Answers) -> bool {
    let is_right =
        |(id, right): (&String, &Value)| answers.get(id).is_some_and(|given| alike(given, right));
    trial.right.iter().all(is_right)
}
