//! Active schedules of pairs: the next batch is asked for when its first trial is reached. What draws it is a module of
//! its own, which studies with such a schedule alone load; it is told the answers of all others by the server.

use serde_json::{Value, json};

use super::effect::Effect;
use super::update::Transition;
use crate::event::EventKind;
use crate::plan::Plan;
use crate::record::{FinishedStep, Record};
use mimique_study::{Component, KindOfQuestion as _, OwnChoice, component_of};

impl Record {
    /// What the participant has answered to the pairs of a block so far.
    pub fn pair_choices(&self, plan: &Plan, component: &str) -> Vec<OwnChoice> {
        let steps = plan.steps.iter().filter(|step| component_of(&step.id) == component);
        let mut questions = steps.flat_map(|step| step.questions());
        let choice = questions.find(|question| question.kind.compares_clips());
        let own = |done: &FinishedStep| {
            let (clip, beside) = (done.clip.as_ref()?, done.attempt.beside.as_ref()?);
            let [left, right] =
                if beside.left { [&beside.clip, clip] } else { [clip, &beside.clip] };
            let answer = choice.and_then(|question| done.answers.get(&question.id)?.as_str());
            let answer = answer.map(str::to_owned);
            Some(OwnChoice { left: left.clone(), right: right.clone(), answer })
        };
        let done = self.finished.iter().filter(|done| component_of(&done.id) == component);
        done.filter_map(own).collect()
    }
}

impl Transition<'_> {
    /// Asks for the next batch, if the trial on the screen waits for it.
    pub(super) fn draw_pairs(&mut self) {
        let Some(step) = self.step() else { return };
        let Some(place) = step.trial().and_then(|trial| trial.active) else { return };
        let component = component_of(&step.id);
        let Some(Component::Trials(block)) = self.plan.study.components.get(component) else {
            return;
        };
        let started = &self.plan.started;
        let Some(pairs) = &block.pairs else { return };
        // Before the session nobody's draw is known.
        if started.config_hash.is_empty() || self.state.record.chosen(step).is_some() {
            return;
        }
        let record = &self.state.record;
        let own = record.pair_choices(self.plan, component);
        let batches = record.drawn.get(component).map_or(0, Vec::len);
        self.effects.push(Effect::DrawPairs(json!({
            "step": step.id,
            "component": component,
            "pairs": {
                "clips": pairs.clips,
                "levels": pairs.levels,
                "active": pairs.active,
            },
            "seed": started.seed,
            "configHash": started.config_hash,
            "slot": started.slot(),
            "batch": batches + 1,
            "left": pairs.active - place,
            "own": own,
        })));
    }

    /// The next batch.
    pub(super) fn pairs_drawn(&mut self, event: &Value) -> bool {
        let Some(event) = EventKind::from_body(event) else { return false };
        let EventKind::PairsDrawn { pairs, .. } = &event else { return false };
        let waits = self.step().filter(|here| event.step() == Some(&here.id));
        let waits = waits.is_some_and(|here| self.state.record.chosen(here).is_none());
        if !waits || pairs.is_empty() {
            return false;
        }
        self.record(event);
        self.prepare();
        true
    }
}
