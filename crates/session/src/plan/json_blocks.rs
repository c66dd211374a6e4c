//! Blocks that pages carry as JSON: each trial is told its clips by a module of its own.

use mimique_study::{Answers, Component, LocalText, StudyProjection};
use serde::Deserialize as _;
use serde_json::Value;

use super::{TrialStep, questions};

/// A block of trials that is carried as JSON, and what it asks.
pub(super) fn as_json(component: &Component) -> Option<(&Value, Vec<String>)> {
    match component {
        Component::Adaptive(block) => Some((&block.0, vec![block.question().to_owned()])),
        Component::Scaling(block) => Some((&block.0, vec![block.question().to_owned()])),
        Component::ReverseCorrelation(block) => Some((&block.0, block.questions())),
        _ => None,
    }
}

/// A trial of a block that is carried as JSON, without its clip.
pub(super) fn json_trial(
    study: &StudyProjection,
    block: &Value,
    asked: &[String],
    number: usize,
    condition: &str,
) -> TrialStep {
    TrialStep {
        clip: String::new(),
        questions: questions(study, asked),
        instruction: LocalText::deserialize(&block["instruction"]).ok(),
        maximum_replays: block["maximumReplays"].as_u64().map(|most| most as u32),
        training: false,
        number,
        condition: condition.to_owned(),
        beside: None,
        panel: None,
        face: None,
        active: None,
        right: Answers::new(),
    }
}
