//! What a participant saw: the views of the stored events in their order, each as it stood when it was left, with the
//! plays of its clips. Where somebody was is what [`crate::Record`] says.

use std::collections::BTreeMap;

use super::placed::PlacedClip;
use super::render::view;
use super::state::State;
use super::view::View;
use crate::event::{EventKind, PlayLog};
use crate::plan::{Plan, Step};

/// A page or a trial as it stood on the screen.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenPage {
    /// Identifier of the step.
    pub step: String,
    /// The screen with its last answers; its machinery (what is loaded, what can be pressed) is that of no time.
    pub view: View,
    /// When it stood on the screen, page clock.
    pub shown_ms: f64,
    /// When it was left, page clock; none of the page that was not left.
    pub left_ms: Option<f64>,
    /// When each answer was last changed, page clock.
    pub answered_ms: BTreeMap<String, f64>,
    /// The plays of its clips, one after the other.
    pub plays: Vec<SeenPlay>,
}

/// A play of the clips of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenPlay {
    /// The clips, each on its canvas.
    pub clips: Vec<PlacedClip>,
    /// Whether they were played one after the other, not in step.
    pub in_turn: bool,
    /// How many frames were shown.
    pub frames: usize,
    /// What the stage measured; its frames on the pages of which they are kept.
    pub log: PlayLog,
}

/// Of which pages frames are kept: they are most of what a session holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptFrames {
    /// Of none.
    None,
    /// Of the page at this place, from 0.
    OfPage(usize),
    /// Of every page.
    All,
}

impl KeptFrames {
    fn has(self, page: usize) -> bool {
        match self {
            Self::None => false,
            Self::OfPage(place) => place == page,
            Self::All => true,
        }
    }
}

/// Follows the events of a session, one after the other.
#[derive(Debug)]
pub struct Seen<'p> {
    plan: &'p Plan,
    state: State,
    frames: KeptFrames,
    plays: Vec<SeenPlay>,
    pages: Vec<SeenPage>,
}

impl<'p> Seen<'p> {
    /// Before the first event.
    pub fn new(plan: &'p Plan, frames: KeptFrames) -> Self {
        let state = State::new(plan, "");
        Self { plan, state, frames, plays: Vec::new(), pages: Vec::new() }
    }

    /// Adds the next stored event; `kind` is none where this version cannot read it.
    pub fn add(&mut self, sequence: u64, at_ms: f64, kind: Option<EventKind>) {
        self.state.live.now_ms = at_ms;
        let left = kind.as_ref().and_then(|kind| self.left_by(kind, at_ms));
        let play = kind.as_ref().and_then(|kind| self.play(kind));
        let before = self.state.record.step;
        self.state.record.add(Some(self.plan), sequence, at_ms, kind);
        self.plays.extend(play);
        let record = &self.state.record;
        if record.step == before && record.standing.is_open() {
            return;
        }
        let plays = std::mem::take(&mut self.plays);
        if let Some(page) = left {
            self.pages.push(SeenPage { plays, ..page });
        }
    }

    /// Every page that was seen; the last one of a session under way was not left.
    pub fn pages(mut self) -> Vec<SeenPage> {
        let record = &self.state.record;
        if record.events > 0 && record.standing.is_open() && self.here().is_some() {
            let plays = std::mem::take(&mut self.plays);
            let page = self.page(self.here(), None);
            self.pages.push(SeenPage { plays, ..page });
        }
        self.pages
    }

    fn here(&self) -> Option<&'p Step> {
        self.plan.step(self.state.record.step)
    }

    /// The page on the screen, where an event is one that can leave it.
    fn left_by(&mut self, kind: &EventKind, at_ms: f64) -> Option<SeenPage> {
        let here = self.here()?;
        let answers = match kind {
            EventKind::PageFinished { step, answers, .. }
            | EventKind::TrialFinished { step, answers, .. }
                if *step == here.id =>
            {
                Some(answers)
            }
            EventKind::ScreenedOut { step, .. } if *step == here.id => None,
            EventKind::Consented { .. } | EventKind::Declined => None,
            _ => return None,
        };
        if let Some(answers) = answers {
            // What was sent is what stood there last.
            self.state.record.drafts = answers.clone();
        }
        Some(self.page(Some(here), Some(at_ms)))
    }

    /// The page on the screen, without its plays.
    fn page(&self, here: Option<&Step>, left_ms: Option<f64>) -> SeenPage {
        let attempt = &self.state.record.attempt;
        SeenPage {
            step: here.map_or_else(String::new, |step| step.id.clone()),
            view: view(self.plan, &self.state),
            shown_ms: attempt.shown_ms,
            left_ms,
            answered_ms: attempt.answered_ms.clone(),
            plays: Vec::new(),
        }
    }

    /// The play that an event tells of, where it is one of the trial on the screen.
    fn play(&self, kind: &EventKind) -> Option<SeenPlay> {
        let EventKind::TrialPlayed { step, log } = kind else { return None };
        let here = self.here().filter(|here| here.id == *step)?;
        let trial = here.trial()?;
        let alone = trial.panel.as_ref().zip(log.alone);
        let clips = match alone {
            Some((panel, place)) => panel.placed(place).into_iter().collect(),
            None => trial.placed(self.state.record.chosen(here).as_ref()),
        };
        let mut log = (**log).clone();
        let frames = log.frames.len();
        if !self.frames.has(self.pages.len()) {
            log.frames = Vec::new();
        }
        Some(SeenPlay { clips, in_turn: alone.is_none() && trial.is_in_turn(), frames, log })
    }
}
