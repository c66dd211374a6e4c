//! What a body does for a while, and its face.

use mimique_exertion::{
    Clip, ExertionError, FRAMES_PER_SECOND, Face, Heart, Person, Plan, Series, Start, Window,
};

/// What a body does by a plan, and its face in a window of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExertionTake {
    /// What the body does, second after second.
    pub series: Series,
    /// The face.
    pub clip: Clip,
}

impl ExertionTake {
    /// Of a plan; the face in `window`, or in all of it at [`FRAMES_PER_SECOND`].
    ///
    /// # Errors
    /// [`ExertionError`]: a heart that was not recorded and should have been, a window outside the plan.
    pub fn of(
        person: &Person,
        plan: &Plan,
        heart: Heart,
        window: Option<Window>,
        face: &Face,
    ) -> Result<Self, ExertionError> {
        let series = Series::of(person, plan, heart, Start::default())?;
        let whole = Window { seconds: [0.0, plan.span_s()], rate_hz: FRAMES_PER_SECOND };
        let clip = Clip::of(person, plan, &series, &window.unwrap_or(whole), face)?;
        Ok(Self { series, clip })
    }
}
