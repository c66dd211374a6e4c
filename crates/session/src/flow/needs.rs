//! What a step shows that has to be fetched first: its clips, and the pictures and signed videos of its
//! questions. All of them are prepared before it, and none of them is missing when a trial starts.

use super::state::{Live, State};
use crate::event::{ChosenClips, StageFailure};
use crate::plan::{Plan, Step, TrialStep};
use mimique_study::MEDIA_PREFIX;

/// How many steps ahead this is prepared, the one on the screen included; steps that need nothing do
/// not count.
const STEPS_AHEAD: usize = 3;

impl Step {
    /// The clips of a trial (those that follow from answers once they are `chosen`, of a panel all), then the media of the questions (`media:` and the path), each once.
    pub fn needs(&self, language: &str, chosen: Option<&ChosenClips>) -> Vec<String> {
        let mut needs: Vec<String> = Vec::new();
        let placed = self.trial().map_or_else(Vec::new, |trial| trial.placed(chosen));
        let clips = placed.into_iter().map(|placed| placed.clip).filter(|clip| !clip.is_empty());
        let media = self.questions().iter().flat_map(|question| question.media(language));
        for need in clips.chain(media.map(|path| [MEDIA_PREFIX, path].concat())) {
            if !needs.contains(&need) {
                needs.push(need);
            }
        }
        needs
    }
}

/// What the step on the screen and the next ones need, the most urgent first, each once.
pub(super) fn needs_ahead(plan: &Plan, state: &State) -> Vec<String> {
    let steps = plan.steps.iter().skip(state.record.step);
    let needs = steps.map(|step| needs_now(step, state));
    let mut all: Vec<String> = Vec::new();
    for need in needs.filter(|needs| !needs.is_empty()).take(STEPS_AHEAD).flatten() {
        if !all.contains(&need) {
            all.push(need);
        }
    }
    all
}

/// What a step needs as far as it is known.
pub(super) fn needs_now(step: &Step, state: &State) -> Vec<String> {
    step.needs(&state.record.language, state.record.chosen(step).as_ref())
}

/// How far a step's needs are.
pub(super) enum Needs {
    /// Everything is there.
    Ready,
    /// On their way, 0..1.
    Loading(f64),
    /// One of them could not be had: its name, and why.
    Failed(String, StageFailure),
}

/// How far the needs of a step are.
pub(super) fn needs_of(step: &Step, state: &State) -> Needs {
    let is_open = state.record.chosen(step).is_none();
    if is_open && step.trial().is_some_and(TrialStep::is_adaptive) {
        return Needs::Loading(0.0);
    }
    let needs = needs_now(step, state);
    let Live { prepared, progress, failed, .. } = &state.live;
    if let Some(need) = needs.iter().find(|need| failed.contains_key(*need)) {
        return Needs::Failed(need.clone(), failed.get(need).cloned().unwrap_or_default());
    }
    let part = |need: &String| match progress.get(need) {
        _ if prepared.contains_key(need) => 1.0,
        fraction => fraction.copied().unwrap_or(0.0),
    };
    if needs.iter().all(|need| prepared.contains_key(need)) {
        return Needs::Ready;
    }
    Needs::Loading(needs.iter().map(part).sum::<f64>() / needs.len() as f64)
}
