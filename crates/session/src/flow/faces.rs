//! Blocks of reverse correlation: the face of a trial is drawn for it alone, by a module of its own, which studies with
//! such a block alone load. The stage calls it by the trial's step; events and exports have the clip at rest.

use serde_json::{Value, json};

use crate::plan::Plan;
use mimique_study::{Component, component_of};

impl Plan {
    /// What a face is drawn from, by what the stage calls it: the clip of the avatar at rest, and the step, the block and
    /// whose draw it is. None of other clips.
    pub fn face(&self, name: &str) -> Option<(&str, Value)> {
        let Some(Component::ReverseCorrelation(block)) =
            self.study.components.get(component_of(name))
        else {
            return None;
        };
        let started = &self.started;
        let drawn_from = json!({
            "step": name,
            "block": block.0,
            "seed": started.seed,
            "configHash": started.config_hash,
            "slot": started.slot(),
        });
        Some((block.clip(), drawn_from))
    }
}
