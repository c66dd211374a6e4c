//! The panels of a session in the tidy form: a row for each clip, with its condition, place and replays.

use std::collections::BTreeMap;

use mimique_study::{Clip, PanelComponent, answer_about, component_of};
use serde_json::Value;

use super::step_cells::Cells;
use super::tidy::TidyForm;
use crate::event::PlayLog;
use crate::record::FinishedStep;

/// The blocks of panels of a study, by name.
pub(super) type Blocks = BTreeMap<String, PanelComponent>;

/// What was answered about a clip of a panel.
pub(super) struct Rated<'s> {
    /// Which clip.
    pub clip: &'s str,
    /// The name under which the answer is kept.
    pub kept: String,
    /// The question.
    pub question: &'s str,
    /// The answer.
    pub answer: &'s Value,
}

impl TidyForm {
    /// What was answered about each clip of a panel, from the first place to the last; nothing of other trials.
    pub(super) fn rated<'s>(&'s self, step: &'s FinishedStep) -> Vec<Rated<'s>> {
        let Some(block) = self.panels.get(component_of(&step.id)) else { return Vec::new() };
        let of = |clip: &'s String| {
            let kept = answer_about(&block.question, clip);
            let answer = step.answers.get(&kept).unwrap_or(&Value::Null);
            Rated { clip, kept, question: &block.question, answer }
        };
        step.attempt.panel.iter().map(of).collect()
    }

    /// Writes the cells of a clip of a panel: the clip itself, its condition, place and replays.
    pub(super) fn panel_cells(&self, step: &FinishedStep, clip: &str, cells: &mut Cells<'_>) {
        let Some(block) = self.panels.get(component_of(&step.id)) else { return };
        let play = step.attempt.play.as_ref();
        let shown = play.into_iter().flat_map(PlayLog::shown_in_panel).find(|it| it.clip == clip);
        let shown = shown.as_ref();
        self.clip_cells(clip, shown.map(|shown| shown.provenance.as_str()), cells);
        let mut put = |name: &str, value: Value| cells.put(name, value);
        put("weights_hash", shown.map(|shown| shown.weights_hash.as_str()).into());
        let condition = self.clips.get(clip).and_then(|it: &Clip| it.factor_text(&block.compare));
        let role = match &condition {
            None => None,
            level if *level == block.reference => Some("reference"),
            level if *level == block.anchor => Some("anchor"),
            Some(_) => Some("condition"),
        };
        put("panel_condition", condition.into());
        put("panel_role", role.into());
        let place = step.attempt.panel.iter().position(|own| own == clip);
        let place = place.map(|at| at as u32 + 1);
        put("panel_place", place.into());
        let alone = place.map(|place| step.attempt.alone.get(&place).copied().unwrap_or_default());
        put("panel_replays", alone.into());
    }
}
