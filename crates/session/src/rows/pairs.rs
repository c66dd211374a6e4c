//! The pairs of a session in the tidy form: which levels stood left and right, and which was chosen.

use std::collections::BTreeMap;

use mimique_study::{Clip, PairsComponent, component_of};

use super::step_cells::Cells;
use crate::record::FinishedStep;

/// The blocks of pairs of a study, by name.
pub(super) type Blocks = BTreeMap<String, PairsComponent>;

/// Writes the cells of a trial of one of the `blocks`: its items, and its cell.
pub(super) fn pair_cells(
    step: &FinishedStep,
    blocks: &Blocks,
    clips: &BTreeMap<String, Clip>,
    cells: &mut Cells<'_>,
) {
    let Some(block) = blocks.get(component_of(&step.id)) else { return };
    let Some([left, right]) = sides(step) else { return };
    let level = |clip: &str| clips.get(clip)?.factor_text(&block.compare);
    cells.put("item_left", level(left).into());
    cells.put("item_right", level(right).into());
    let alike = |name: &String| clips.get(left)?.factor_text(name);
    let alike: Vec<String> = block.within.iter().filter_map(alike).collect();
    cells.put("cell", alike.join("|").into());
    cells.put("batch", step.attempt.batch.into());
}

/// Writes which level was chosen, where the answer is the block's choice.
pub(super) fn chosen_item(
    (step, question): (&FinishedStep, &str),
    chosen: Option<&str>,
    blocks: &Blocks,
    clips: &BTreeMap<String, Clip>,
    cells: &mut Cells<'_>,
) {
    let Some(block) = blocks.get(component_of(&step.id)) else { return };
    if block.question == question {
        let level = chosen.and_then(|clip| clips.get(clip)?.factor_text(&block.compare));
        cells.put("item_chosen", level.into());
    }
}

/// The two clips of a trial, from left to right; none where a single one was shown.
fn sides(step: &FinishedStep) -> Option<[&str; 2]> {
    let (clip, beside) = (step.clip.as_deref()?, step.attempt.beside.as_ref()?);
    Some(if beside.left { [&beside.clip, clip] } else { [clip, &beside.clip] })
}
