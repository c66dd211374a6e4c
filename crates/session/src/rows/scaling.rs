//! Judgements of differences in the tidy form: which levels stood where, and which pair was said to differ more.

use std::collections::BTreeMap;

use mimique_study::columns::{SCALING_COLUMNS, WEIGHTS_EXPECTED_COLUMN};
use mimique_study::{KindOfQuestion as _, ScalingComponent, Study, component_of};
use serde_json::Value;

use super::step_cells::Cells;
use crate::event::PlayLog;
use crate::record::FinishedStep;

/// The blocks of difference scaling of a study.
#[derive(Debug, Clone, Default)]
pub(super) struct Scalings {
    /// By name: the block's question, and the answer that says that the second pair differs more.
    blocks: BTreeMap<String, [String; 2]>,
    /// Level of each clip.
    levels: BTreeMap<String, f64>,
}

impl Scalings {
    /// Those of a study.
    pub fn of(study: &Study) -> Self {
        let of = |(name, block): (&str, ScalingComponent)| {
            let question = study.questions.iter().find(|each| each.id == block.question)?;
            let second = question.kind.options().get(1)?.value.clone();
            Some((name.to_owned(), [block.question, second]))
        };
        let blocks: BTreeMap<_, _> = study.scalings().filter_map(of).collect();
        let clips = study.level_clips().into_iter();
        let clips = clips.filter(|_| !blocks.is_empty());
        Self { levels: clips.map(|level| (level.clip.id, level.level)).collect(), blocks }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Writes the cells of a trial. `prepared` are the hashes of the weights as they were solved beforehand, by clip.
    pub fn cells(
        &self,
        step: &FinishedStep,
        prepared: &BTreeMap<String, String>,
        cells: &mut Cells<'_>,
    ) {
        let Some([question, second]) = self.blocks.get(component_of(&step.id)) else { return };
        let [(of_levels, ..), (of_second, ..)] = SCALING_COLUMNS;
        let levels = step.attempt.panel.iter().map(|clip| self.levels.get(clip).copied());
        if let Some(levels) = levels.collect::<Option<Vec<f64>>>() {
            cells.put(of_levels, serde_json::to_string(&levels).unwrap_or_default().into());
        }
        let answer = step.answers.get(question).and_then(Value::as_str);
        cells.put(of_second, answer.map(|answer| answer == second).into());
        let shown = step.attempt.play.iter().flat_map(PlayLog::shown_in_panel);
        let expected: Vec<bool> = shown
            .filter(|shown| !shown.weights_hash.is_empty())
            .filter_map(|shown| Some(*prepared.get(&shown.clip)? == shown.weights_hash))
            .collect();
        if !expected.is_empty() {
            cells.put(WEIGHTS_EXPECTED_COLUMN.0, expected.iter().all(|own| *own).into());
        }
    }
}
