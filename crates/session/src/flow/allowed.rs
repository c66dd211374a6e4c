//! What the participant can do now: which questions are asked, whether the page leads on, whether the clip
//! can be played.

use super::gate;
use super::needs::{Needs, needs_of};
use super::state::{Play, State};
use crate::plan::{Plan, Step, StepKind};
use mimique_study::Question;

/// How long a trial waits for the last answers to reach the server, milliseconds. Beyond that the
/// participant goes on: the outbox keeps what is not yet sent.
const SAVING_GRACE_MS: f64 = 3_000.0;

/// The questions of a step that are asked, given the answers so far.
pub(super) fn shown_questions<'a>(
    step: &'a Step,
    state: &'a State,
) -> impl Iterator<Item = &'a Question> {
    step.questions()
        .iter()
        .filter(|question| question.is_shown(&state.record.drafts, &state.record.answers))
}

/// Whether the button that leads on does so.
pub(super) fn can_submit(plan: &Plan, state: &State) -> bool {
    let Some(step) = plan.step(state.record.step) else { return false };
    let answered = shown_questions(step, state)
        .all(|question| question.accept(state.record.draft(&question.id)).is_ok());
    match &step.kind {
        StepKind::Consent | StepKind::Sound | StepKind::Mimicry => false,
        StepKind::Page(_) | StepKind::Debriefing(_) | StepKind::Feedback { .. } => true,
        StepKind::Device => {
            gate::device_problems(plan, state).is_some_and(|unmet| unmet.is_empty())
        }
        StepKind::Calibration(calibration) => gate::is_calibrated(calibration, state),
        StepKind::Break(_) => break_seconds_left(plan, state) == 0,
        StepKind::Questions { .. } => answered,
        StepKind::Trial(_) => {
            answered && state.record.attempt.plays > 0 && state.live.play == Play::Still
        }
    }
}

/// Seconds until the break on the screen may end.
pub(super) fn break_seconds_left(plan: &Plan, state: &State) -> u64 {
    let Some(Step { kind: StepKind::Break(rest), .. }) = plan.step(state.record.step) else {
        return 0;
    };
    let passed = (state.live.now_ms - state.record.entered_ms) / 1000.0;
    (rest.minimum_seconds - passed).ceil().max(0.0) as u64
}

/// Whether the answers before this trial are still on their way, and it is worth waiting for them.
pub(super) fn is_saving(state: &State) -> bool {
    !state.record.attempt.is_started()
        && state.live.stored < state.record.checkpoint
        && state.live.now_ms - state.record.entered_ms < SAVING_GRACE_MS
}

/// Whether the clip on the screen may be played, or played again.
pub(super) fn can_play(plan: &Plan, state: &State) -> bool {
    may_play(plan, state, state.record.attempt.plays)
}

/// Whether the clip at a place of a panel may be played alone: once all were seen, as often as replays are left.
pub(super) fn can_play_alone(plan: &Plan, state: &State, place: u32) -> bool {
    let attempt = &state.record.attempt;
    let alone = attempt.alone.get(&place).copied().unwrap_or_default();
    attempt.plays > 0 && may_play(plan, state, attempt.plays + alone)
}

/// Whether what has been seen so often may be played.
fn may_play(plan: &Plan, state: &State, plays: u32) -> bool {
    let Some(step) = plan.step(state.record.step) else { return false };
    let Some(trial) = step.trial() else { return false };
    let replays_left = match (plays, trial.maximum_replays) {
        (0, _) | (_, None) => true,
        (plays, Some(most)) => plays <= most,
    };
    state.record.standing.is_open()
        && state.live.play == Play::Still
        && matches!(needs_of(step, state), Needs::Ready)
        && replays_left
        && !is_saving(state)
}
