//! The faces of blocks of reverse correlation in the tidy form: each is drawn anew from the seed, and its weights are
//! held against those that were shown.

use std::collections::BTreeMap;

use mimique_study::{
    ClipSource, Draw, ReverseCorrelationComponent, Study, UnitShapes, component_of,
};
use serde_json::Value;

use super::step_cells::Cells;
use crate::record::FinishedStep;
use crate::wire::SessionStarted;
use mimique_study::columns::{TRAJECTORIES_COLUMN, WEIGHTS_EXPECTED_COLUMN};

/// A block, and how the avatar of its clip shows the units; none where the clip was not prepared.
#[derive(Debug, Clone)]
pub(super) struct Faces {
    block: ReverseCorrelationComponent,
    units: Option<UnitShapes>,
}

/// The blocks of reverse correlation of a study, by name.
pub(super) type Blocks = BTreeMap<String, Faces>;

/// The blocks of a study, with the clips as they were prepared.
pub(super) fn blocks(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Blocks {
    let of = |(name, block): (&str, ReverseCorrelationComponent)| {
        let units = clips.get(&block.clip).and_then(|clip| clip.units.clone());
        (name.to_owned(), Faces { block, units })
    };
    study.reverse_correlations().map(of).collect()
}

/// Writes the cells of a trial: what it showed, and whether the weights are those that the seed gives.
pub(super) fn face_cells(
    step: &FinishedStep,
    blocks: &Blocks,
    started: &SessionStarted,
    cells: &mut Cells<'_>,
) {
    let Some(Faces { block, units }) = blocks.get(component_of(&step.id)) else { return };
    let draw = Draw {
        seed: started.seed,
        config_hash: &started.config_hash,
        participant: started.slot(),
        condition: started.condition.as_deref(),
    };
    let Ok(shown) = block.trajectories(&step.id, draw) else { return };
    let courses = serde_json::to_string(&block.courses(&shown)).unwrap_or_default();
    cells.put(TRAJECTORIES_COLUMN.0, courses.into());
    let played = step.attempt.play.as_ref().map(|play| play.weights_hash.as_str());
    if let (Some(played), Some(units)) = (played.filter(|hash| !hash.is_empty()), units) {
        let is_same: Value = (played == block.face(&shown, units).weights_hash).into();
        cells.put(WEIGHTS_EXPECTED_COLUMN.0, is_same);
    }
}
