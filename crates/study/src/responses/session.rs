//! One session's events, read into finished steps.

use std::collections::BTreeMap;

use crate::answer::alike;
use crate::event::{Answers, Calibrated, Client, EventKind, PlayLog, ShownBeside};
use crate::study_file::Study;
use crate::wire::{Event, SessionStarted};

/// One session as the server keeps it.
#[derive(Debug, Clone, Copy)]
pub struct SessionRecord<'a> {
    /// As at its start.
    pub started: &'a SessionStarted,
    /// Its events, in ascending order of sequence.
    pub events: &'a [Event],
    /// What the server knows better than the events (`excluded`, `expired`).
    pub status: Option<&'a str>,
}

/// How a session stands, from its events: `completed`, `screened_out`, `failed_checks`, `declined`,
/// `withdrawn` or `active`.
pub fn session_status(events: &[Event]) -> &'static str {
    let mut status = "active";
    for event in events {
        match event.body.get("type").and_then(|word| word.as_str()) {
            Some("finished") => status = "completed",
            Some("declined") => status = "declined",
            Some("screened_out") => status = "screened_out",
            Some("checks_failed") => status = "failed_checks",
            Some("withdrawn") => return "withdrawn",
            _ => {}
        }
    }
    status
}

/// What the events say, step by step.
#[derive(Debug, Default)]
pub(super) struct Walk {
    pub opened_ms: f64,
    pub client: Client,
    pub language: String,
    pub consent_version: Option<String>,
    pub steps: Vec<FinishedStep>,
    /// How a session ended before its last page.
    pub end: Option<EarlyEnd>,
    calibrated: Calibrated,
    fullscreen: bool,
}

/// A session that ended before its last page.
#[derive(Debug)]
pub(super) struct EarlyEnd {
    pub step: String,
    /// `screened_out` or `failed_checks`.
    pub what: &'static str,
    /// Why: `device: minimumWidth`; or how many checks were failed.
    pub why: serde_json::Value,
    pub at_ms: f64,
}

/// A page or a trial that was finished.
#[derive(Debug, Default, Clone)]
pub(super) struct FinishedStep {
    pub id: String,
    pub clip: Option<String>,
    pub beside: Option<ShownBeside>,
    pub answers: Answers,
    /// When each answer was last changed, page clock.
    pub answered_ms: BTreeMap<String, f64>,
    pub start_ms: f64,
    pub end_ms: f64,
    /// The first whole play of the attempt that was finished.
    pub play: Option<PlayLog>,
    pub replays: u32,
    pub rt_ms: Option<f64>,
    /// How often the page was opened again, or a play was cut short, in this step.
    pub interruptions: u32,
    pub focus_losses: u32,
    pub client: Client,
    /// Whether its time was over.
    pub timed_out: bool,
    /// Whether the page filled the screen when the clip was played (of a page: when it was sent).
    pub fullscreen: bool,
    pub calibrated: Calibrated,
}

impl Walk {
    pub fn of(events: &[Event]) -> Self {
        let mut walk = Self::default();
        let mut here = FinishedStep::default();
        // Time of the last event that opened a step: its start unless it says so itself.
        let mut begun_ms = 0.0;
        let mut started_ms = None;
        for event in events {
            let Some(kind) = EventKind::from_body(&event.body) else { continue };
            let at_ms = event.at_ms;
            match kind {
                EventKind::Opened { client, language } => {
                    (walk.opened_ms, begun_ms) = (at_ms, at_ms);
                    walk.client = client;
                    walk.language = language;
                }
                EventKind::Fullscreen { on } => walk.fullscreen = on,
                EventKind::Calibrated(calibrated) => walk.calibrated = calibrated,
                EventKind::ScreenedOut { step, reason, details } => {
                    let why = format!("{reason}: {}", details.join(", "));
                    let why = why.trim_end_matches([':', ' ']).into();
                    walk.end = Some(EarlyEnd { step, what: "screened_out", why, at_ms });
                }
                EventKind::ChecksFailed { failed } => {
                    let step = "end".to_owned();
                    let why = failed.into();
                    walk.end = Some(EarlyEnd { step, what: "failed_checks", why, at_ms });
                }
                EventKind::Resumed { client } => {
                    walk.fullscreen = false;
                    walk.client = client;
                    here.interruptions += 1;
                    here.play = None;
                    // A trial starts anew; the answers of a page stay, with their times.
                    if started_ms.take().is_some() {
                        here.answered_ms.clear();
                    }
                }
                EventKind::LanguageChosen { language } => walk.language = language,
                EventKind::Consented { version, language } => {
                    walk.consent_version = Some(version);
                    walk.language = language;
                    (here, begun_ms) = (FinishedStep::default(), at_ms);
                }
                EventKind::PageShown { .. } if started_ms.is_none() => begun_ms = at_ms,
                EventKind::Answered { question, .. } => {
                    here.answered_ms.insert(question, at_ms);
                }
                EventKind::TrialStarted { beside, .. } => {
                    started_ms = Some(at_ms);
                    here.beside = beside;
                }
                EventKind::TrialPlayed { log, .. } => {
                    if !log.is_whole() {
                        here.interruptions += 1;
                    } else if here.play.is_none() {
                        here.play = Some(log);
                        here.fullscreen = walk.fullscreen;
                    }
                }
                EventKind::FocusLost => here.focus_losses += 1,
                EventKind::PageFinished { step, answers, timed_out } => {
                    let fullscreen = walk.fullscreen;
                    let done = FinishedStep { id: step, answers, timed_out, fullscreen, ..here };
                    walk.finish(done, begun_ms, at_ms);
                    (here, begun_ms, started_ms) = (FinishedStep::default(), at_ms, None);
                }
                EventKind::TrialFinished { step, clip, answers, rt_ms, replays, timed_out } => {
                    let start_ms = started_ms.unwrap_or(begun_ms);
                    let (clip, rt_ms) = (Some(clip), Some(rt_ms));
                    let done =
                        FinishedStep { id: step, clip, answers, rt_ms, replays, timed_out, ..here };
                    walk.finish(done, start_ms, at_ms);
                    (here, begun_ms, started_ms) = (FinishedStep::default(), at_ms, None);
                }
                _ => {}
            }
        }
        walk
    }

    fn finish(&mut self, mut step: FinishedStep, start_ms: f64, end_ms: f64) {
        // A step is finished once; a second report of it is another tab's, and is left out.
        if self.steps.iter().any(|done| done.id == step.id) {
            return;
        }
        step.start_ms = start_ms;
        step.end_ms = end_ms;
        step.client = self.client.clone();
        step.calibrated = self.calibrated.clone();
        self.steps.push(step);
    }
}

impl FinishedStep {
    /// Adds the answers that conditions on later questions go by: those of pages, not of trials.
    pub fn keep_answers(&self, kept: &mut Answers) {
        if self.clip.is_none() {
            kept.extend(self.answers.iter().map(|(id, value)| (id.clone(), value.clone())));
        }
    }
}

/// How many attention checks of a session were failed: answered otherwise than expected, or not at
/// all where they were shown and their page was finished.
pub fn failed_attention_checks(study: &Study, events: &[Event]) -> u32 {
    let mut failed = 0;
    let mut earlier = Answers::new();
    for step in Walk::of(events).steps {
        for question in study.questions_of(&step.id) {
            let Some(check) = &question.attention_check else { continue };
            if !question.is_shown(&step.answers, &earlier) {
                continue;
            }
            let answer = step.answers.get(&question.id);
            failed += u32::from(!answer.is_some_and(|answer| alike(answer, &check.expected)));
        }
        step.keep_answers(&mut earlier);
    }
    failed
}
