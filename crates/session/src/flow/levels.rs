//! Adaptive blocks: the level of a trial is asked for when the trial is reached, and once more after a reload that
//! came before the answer. What chooses it is a module of its own, which studies with such a block alone load.

use serde_json::{Value, json};

use super::effect::Effect;
use super::needs::needs_now;
use super::update::Transition;
use crate::event::EventKind;
use crate::plan::Step;
use mimique_study::{Component, component_of};

impl Transition<'_> {
    /// Asks for the level of the trial on the screen, if it has none yet; and has the levels of a block made ready while
    /// the step before it stands there.
    pub(super) fn choose_level(&mut self) {
        let Some(step) = self.step() else { return };
        if let Some(request) = self.level_request(step) {
            self.effects.push(Effect::ChooseLevel(request));
        }
        let Some(next) = self.plan.step(self.state.record.step + 1) else { return };
        if component_of(&next.id) == component_of(&step.id) {
            return;
        }
        if let Some(request) = self.level_request(next) {
            self.effects.push(Effect::ReadyLevels(request));
        }
    }

    /// What the level of a trial of an adaptive block follows from.
    fn level_request(&self, step: &Step) -> Option<Value> {
        let component = component_of(&step.id);
        let Some(Component::Adaptive(block)) = self.plan.study.components.get(component) else {
            return None;
        };
        // Before the session nobody's draw is known.
        if self.plan.started.config_hash.is_empty() {
            return None;
        }
        let record = &self.state.record;
        let own = record.finished.iter().filter(|done| component_of(&done.id) == component);
        let answers: Vec<Option<&Value>> =
            own.map(|done| done.answers.get(block.question())).collect();
        let started = &self.plan.started;
        Some(json!({
            "step": step.id,
            "component": component,
            "block": block.0,
            "seed": started.seed,
            "configHash": started.config_hash,
            "slot": started.slot(),
            "answers": answers,
        }))
    }

    /// The clips that may come next are made ready after those of the level on the screen. Who has gone on meanwhile
    /// needs them no more.
    pub(super) fn levels_ahead(&mut self, ahead: &[String]) -> bool {
        if let Some(step) = self.step().filter(|_| self.state.record.attempt.level.is_some()) {
            let mut clips = needs_now(step, &self.state);
            clips.extend_from_slice(ahead);
            self.effects.push(Effect::PrepareClips(clips));
        }
        true
    }

    /// The level of the trial on the screen, or word that none is left.
    pub(super) fn level_chosen(&mut self, event: &Value) -> bool {
        let Some(event) = EventKind::from_body(event) else { return false };
        if self.step().is_none_or(|here| event.step() != Some(&here.id)) {
            return false;
        }
        match &event {
            EventKind::LevelsOver { .. } => {
                self.record(event);
                self.arrive();
                return true;
            }
            EventKind::LevelChosen { clip, against, .. } => {
                let clips = vec![clip.clone(), against.clone()];
                // After a reload the level is known.
                if self.state.record.attempt.level.is_none() {
                    self.record(event);
                }
                self.effects.push(Effect::PrepareClips(clips));
            }
            _ => return false,
        }
        true
    }
}
