//! The record of a session: what its events make of it. This is the one fold of the event log; page,
//! event store, dashboard, export and report read its result.
//!
//! How a session stands and what its finished pages and trials hold follow from the events alone. Where
//! the participant is follows from the events and the plan; without a plan (the export reads sessions of
//! any version of a study) every step that an event names counts as the one on the screen.

mod fold;
mod step;

use std::collections::BTreeMap;

use mimique_study::{Answers, Display, Question, alike, component_of};
use serde_json::Value;

use crate::event::{Calibrated, ChosenClips, Client, EventKind};
use crate::plan::{Plan, Step};
use crate::standing::Standing;
use crate::wire::Event;
pub use step::{Attempt, CutShort, EarlyEnd, EndReason, FinishedStep};

/// What the events of a session make of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Number of events: the sequence of the next one.
    pub events: u64,
    /// Events and inputs that did not fit.
    pub unexpected: u32,
    /// Time of the first event that opened the page, page clock.
    pub opened_ms: f64,
    /// Time of the last event, page clock.
    pub last_ms: f64,
    /// How the session stands, whatever the time is.
    pub standing: Standing,
    /// How the session ended before its last page.
    pub early_end: Option<EarlyEnd>,
    /// Language of the pages; empty before the first event.
    pub language: String,
    /// Version of the agreement.
    pub consent_version: Option<String>,
    /// The page as it was last opened.
    pub client: Client,
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
    /// How often the page was opened again.
    pub resumptions: u32,
    /// Index of the step that stands on the screen.
    pub step: usize,
    /// When that step was reached, page clock.
    pub entered_ms: f64,
    /// Answers on the screen, not yet sent.
    pub drafts: Answers,
    /// What was measured of the page or trial on the screen.
    pub attempt: Attempt,
    /// Number of events that a later trial must not start without: those up to the last finished
    /// step.
    pub checkpoint: u64,
    /// Answers of the pages of questions before (not of trials).
    pub answers: Answers,
    /// Answers to the practice clip before.
    pub practised: Answers,
    /// Practice clips of this round that were answered right.
    pub right: u32,
    /// Whether the last round of practice ended without success.
    pub practice_failed: bool,
    /// Batches of pairs that followed from answers, by block: the left clip and the right clip of each.
    pub drawn: BTreeMap<String, Vec<Vec<[String; 2]>>>,
    /// Pages and trials that were finished, in the order of their events, each once.
    pub finished: Vec<FinishedStep>,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            events: 0,
            unexpected: 0,
            opened_ms: 0.0,
            last_ms: 0.0,
            standing: Standing::default(),
            early_end: None,
            language: String::new(),
            consent_version: None,
            client: Client::default(),
            focused: true,
            fullscreen: false,
            display: None,
            measurements: 0,
            calibrated: None,
            resumptions: 0,
            step: 0,
            entered_ms: 0.0,
            drafts: Answers::new(),
            attempt: Attempt::default(),
            checkpoint: 0,
            answers: Answers::new(),
            practised: Answers::new(),
            right: 0,
            practice_failed: false,
            drawn: BTreeMap::new(),
            finished: Vec::new(),
        }
    }
}

impl Record {
    /// The clips of a trial that follow from answers, once they are known.
    pub fn chosen(&self, step: &Step) -> Option<ChosenClips> {
        if let Some(place) = step.trial()?.active {
            let [left, right] = self.batch_and_pair(&step.id, place)?.1;
            let (clip, against) = (left.clone(), right.clone());
            return Some(ChosenClips { clip, against, left: false });
        }
        let shown = self.attempt.level.as_deref().filter(|shown| shown.step == step.id)?;
        let (clip, against) = (shown.clip.clone(), shown.against.clone());
        Some(ChosenClips { clip, against, left: shown.left })
    }

    /// Batch (from 1) and pair of the trial at a place among those of its block that follow from answers.
    pub(crate) fn batch_and_pair(&self, step: &str, place: usize) -> Option<(u32, &[String; 2])> {
        let batches = self.drawn.get(component_of(step))?.iter().zip(1_u32..);
        batches.flat_map(|(pairs, batch)| pairs.iter().map(move |pair| (batch, pair))).nth(place)
    }

    /// The record of stored events, in ascending order of sequence. Events that this version cannot
    /// read, or that do not fit, change nothing but the counts.
    pub fn of(plan: Option<&Plan>, events: &[Event]) -> Self {
        let mut record = Self::default();
        for event in events {
            let kind = EventKind::from_body(&event.body);
            record.add(plan, event.sequence, event.at_ms, kind);
        }
        record
    }

    /// Adds the next stored event: the record of many events is made of one after the other. `kind` is none
    /// where this version cannot read it.
    pub fn add(&mut self, plan: Option<&Plan>, sequence: u64, at_ms: f64, kind: Option<EventKind>) {
        match kind {
            Some(kind) => self.apply(plan, kind, at_ms),
            None => self.unexpected += 1,
        }
        // The sequence is the event's own, so that a gap is never filled by another event.
        self.events = self.events.max(sequence + 1);
    }

    /// Whether the session ended since the device showed too few frames of a clip.
    pub fn was_too_slow(&self) -> bool {
        self.was_screened_out_by("frames")
    }

    /// Whether the session ended since the tones of the sound check were not heard.
    pub fn did_not_hear(&self) -> bool {
        self.was_screened_out_by("sound")
    }

    fn was_screened_out_by(&self, cause: &str) -> bool {
        self.early_end.as_ref().is_some_and(
            |end| matches!(&end.reason, EndReason::ScreenedOut { by, .. } if by == cause),
        )
    }

    /// The draft of a question, if there is one.
    pub fn draft(&self, question: &str) -> Option<&Value> {
        self.drafts.get(question)
    }

    /// How many attention checks were failed: answered otherwise than expected, or not at all where they
    /// were shown and their page was finished. `questions_of` gives the questions of a step.
    pub fn failed_checks<'q>(&self, questions_of: impl Fn(&str) -> Vec<&'q Question>) -> u32 {
        let mut failed = 0;
        let mut earlier = Answers::new();
        for step in &self.finished {
            for question in questions_of(&step.id) {
                let Some(check) = &question.attention_check else { continue };
                if question.is_shown(&step.answers, &earlier) {
                    let answer = step.answers.get(&question.id);
                    let passed = answer.is_some_and(|answer| alike(answer, &check.expected));
                    failed += u32::from(!passed);
                }
            }
            step.keep_answers(&mut earlier);
        }
        failed
    }
}
