//! The levels of adaptive blocks in the tidy form: each is chosen anew from seed and answers, and held against what
//! the page has recorded.

use std::collections::{BTreeMap, HashMap};

use mimique_study::columns::WEIGHTS_EXPECTED_COLUMN;
use mimique_study::{AdaptiveComponent, ChosenLevel, ClosedLoop, Draw, component_of};
use serde_json::Value;

use super::cells::number;
use super::step_cells::Cells;
use crate::event::LevelShown;
use crate::record::{FinishedStep, Record};
use crate::wire::SessionStarted;

/// The adaptive blocks of a study, by name.
pub(super) type Blocks = BTreeMap<String, AdaptiveComponent>;

/// What a replay finds of a trial.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Replayed {
    /// Whether the varied clip was chosen, or whether it was said rightly that the clips differ.
    right: Option<bool>,
    /// Mean and standard deviation of the track's threshold after the answer.
    threshold: Option<[f64; 2]>,
    /// Whether the recorded level is the one that seed and answers give.
    is_same: bool,
}

/// Replays the adaptive blocks of a session: by the place of the step among those that were finished.
pub(super) fn replay(
    blocks: &Blocks,
    started: &SessionStarted,
    record: &Record,
) -> HashMap<usize, Replayed> {
    let mut found = HashMap::new();
    for (component, block) in blocks {
        let draw = Draw {
            seed: started.seed,
            config_hash: &started.config_hash,
            participant: started.slot(),
            condition: started.condition.as_deref(),
        };
        let Ok(mut closed_loop) = ClosedLoop::new(block.clone(), component, draw) else { continue };
        let steps = record.finished.iter().enumerate();
        for (place, step) in steps.filter(|(_, step)| component_of(&step.id) == component) {
            let Some(shown) = &step.attempt.level else { continue };
            let chosen = closed_loop.next();
            let is_same = chosen.as_ref().is_some_and(|chosen| is_alike(chosen, shown, step));
            let answer = step.answers.get(&block.question).and_then(Value::as_str);
            closed_loop.answer(answer);
            let seen = answer.and_then(|answer| block.seen(answer, shown.left));
            let right = seen.map(|seen| block.is_right(seen, shown.catch));
            let threshold = closed_loop.threshold(shown.track as usize);
            found.insert(place, Replayed { right, threshold, is_same });
        }
    }
    found
}

fn is_alike(chosen: &ChosenLevel, shown: &LevelShown, step: &FinishedStep) -> bool {
    let ChosenLevel { track, level, entropy, catch, clip, against, left } = chosen;
    let bits = |number: Option<f64>| number.map(f64::to_bits);
    *track as f64 == shown.track
        && level.to_bits() == shown.level.to_bits()
        && bits(*entropy) == bits(shown.entropy)
        && *catch == shown.catch
        && *clip == shown.clip
        && *against == shown.against
        && *left == shown.left
        && step.clip.as_ref() == Some(clip)
}

/// Writes the cells of a trial. `prepared` are the hashes of the weights as they were solved beforehand, by clip.
pub(super) fn level_cells(
    step: &FinishedStep,
    replayed: &Replayed,
    prepared: &BTreeMap<String, String>,
    cells: &mut Cells<'_>,
) {
    let Some(shown) = &step.attempt.level else { return };
    let Replayed { right, threshold, is_same } = replayed;
    cells.put("track", (shown.track as u64).into());
    cells.put("level", number(shown.level));
    cells.put("level_catch", shown.catch.into());
    cells.put("correct", (*right).into());
    if let Some([mean, sd]) = threshold {
        cells.put("posterior_mean", number(*mean));
        cells.put("posterior_sd", number(*sd));
    }
    cells.put("level_replayed", (*is_same).into());
    let solved = step.attempt.play.as_ref().map(|play| play.weights_hash.as_str());
    let expected = step.clip.as_ref().and_then(|clip| prepared.get(clip));
    if let (Some(solved), Some(expected)) = (solved.filter(|hash| !hash.is_empty()), expected) {
        cells.put(WEIGHTS_EXPECTED_COLUMN.0, (solved == expected).into());
    }
}
