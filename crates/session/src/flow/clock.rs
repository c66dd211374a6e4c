//! The time that a step may take, and how much of it is left.

use super::state::{Play, State};
use crate::plan::{Plan, Step};

/// Seconds before the end at which a participant is warned, where the limit is longer than twice
/// that: WCAG 2.2 asks for 20 seconds to press one key.
const WARNING_SECONDS: f64 = 20.0;

/// A running clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clock {
    /// Seconds left; below 0 when the time is over.
    pub left: f64,
    /// Seconds of the limit itself.
    pub seconds: f64,
    /// How often it can still be extended.
    pub extensions: u32,
}

impl Clock {
    /// Whether the end is so near that it must be told.
    pub fn warns(&self) -> bool {
        self.left <= WARNING_SECONDS
    }
}

/// The clock of the step on the screen; `None` where there is none, or where it has not begun.
pub(super) fn clock(plan: &Plan, state: &State) -> Option<Clock> {
    let record = &state.record;
    let step = plan.step(record.step).filter(|_| record.standing.is_open())?;
    let limit = step.time_limit.as_ref()?;
    let begun_ms = match step.trial() {
        Some(_) => record.attempt.answering_ms?,
        None => record.entered_ms,
    };
    let whole = limit.seconds * f64::from(1 + record.attempt.extensions);
    Some(Clock {
        left: whole - (state.live.now_ms - begun_ms) / 1000.0,
        seconds: limit.seconds,
        extensions: limit.extensions.saturating_sub(record.attempt.extensions),
    })
}

/// Whether the time of the step on the screen is over. A clip that is being played is played to its
/// end first.
pub(super) fn is_over(plan: &Plan, state: &State) -> bool {
    state.live.play == Play::Still && clock(plan, state).is_some_and(|clock| clock.left <= 0.0)
}

/// Whether a step's clock begins only when its clip was seen.
pub(super) fn begins_later(step: &Step, state: &State) -> bool {
    step.trial().is_some() && state.record.attempt.answering_ms.is_none()
}
