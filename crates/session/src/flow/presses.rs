//! Questions that are answered while a clip plays: by keys, the first press being the answer, and by lines whose course is
//! the answer.

use mimique_study::{KindOfQuestion as _, Question};
use serde_json::Value;

use super::allowed::shown_questions;
use super::state::Play;
use super::update::Transition;
use crate::event::EventKind;

impl Transition<'_> {
    /// An option was pressed: the answer, if it is the first press of a play of all that the trial shows.
    pub(super) fn press(&mut self, question: &str, value: &str, at_ms: f64) -> bool {
        let live = &self.state.live;
        let plays = self.state.record.attempt.plays;
        let is_open = match live.play {
            Play::Running => live.alone.is_none(),
            Play::Still => plays > 0,
        };
        let Some(asked) = self.keyed().find(|asked| asked.id == question) else { return false };
        let is_known = asked.kind.keys().is_some_and(|keys| keys.contains_key(value));
        if !is_open || !is_known {
            return false;
        }
        if self.state.record.draft(question).is_none() {
            self.give(question, value.into(), at_ms);
            self.leave_when_pressed();
        }
        true
    }

    /// What a play means for these questions: one that does not count takes the answers back; after one that counts
    /// an option without a key is the answer where nothing was pressed.
    pub(super) fn after_play(&mut self) {
        let asked: Vec<(String, Option<String>)> = self
            .keyed()
            .map(|asked| (asked.id.clone(), unpressed(asked).map(str::to_owned)))
            .collect();
        let counts = self.state.record.attempt.plays > 0;
        for (question, unpressed) in asked {
            let given = self.state.record.draft(&question).is_some();
            match unpressed {
                _ if given && !counts => self.give(&question, Value::Null, self.now_ms),
                Some(value) if counts && !given => {
                    self.give(&question, value.into(), self.now_ms);
                }
                _ => {}
            }
        }
        self.leave_when_pressed();
    }

    /// Makes answers of the lines that followed a play, where it counts and is the first that does.
    pub(super) fn after_traces(&mut self, traces: &Value) {
        let Some(step) = self.step() else { return };
        let asked = shown_questions(step, &self.state).filter(|asked| asked.kind.is_traced());
        let open = asked.filter(|asked| self.state.record.draft(&asked.id).is_none());
        let open: Vec<String> = open.map(|asked| asked.id.clone()).collect();
        for question in open {
            if let Some(course) = traces.get(&question).filter(|course| course.is_array()) {
                self.give(&question, course.clone(), self.now_ms);
            }
        }
    }

    /// A trial that asks nothing else is over with its last press.
    fn leave_when_pressed(&mut self) {
        let Some(step) = self.step() else { return };
        let state = &self.state;
        let asked = || shown_questions(step, state);
        let meanwhile = |asked: &Question| asked.kind.keys().is_some() || asked.kind.is_traced();
        let only_keys = asked().all(meanwhile);
        let answered = asked().all(|asked| state.record.draft(&asked.id).is_some());
        let is_over = state.live.play == Play::Still && state.record.attempt.plays > 0;
        if only_keys && answered && is_over && asked().next().is_some() {
            self.next();
        }
    }

    /// The questions of this trial that keys answer.
    fn keyed(&self) -> impl Iterator<Item = &Question> {
        let step = self.step().filter(|step| step.trial().is_some());
        let asked = step.into_iter().flat_map(|step| shown_questions(step, &self.state));
        asked.filter(|asked| asked.kind.keys().is_some())
    }

    fn give(&mut self, question: &str, value: Value, at_ms: f64) {
        let Some(step) = self.step() else { return };
        let (step, question) = (step.id.clone(), question.to_owned());
        // Events never run backwards.
        let at_ms = at_ms.clamp(self.state.record.last_ms.min(self.now_ms), self.now_ms);
        self.record_at(EventKind::Answered { step, question, value }, at_ms);
    }
}

/// The option that stands for no press.
fn unpressed(asked: &Question) -> Option<&str> {
    let keys = asked.kind.keys()?;
    let mut options = asked.kind.options().iter();
    options.find(|option| !keys.contains_key(&option.value)).map(|option| option.value.as_str())
}
