//! What a body does for a while, and its face.

use mimique_exertion::{
    Clip, ExertionError, FRAMES_PER_SECOND, Face, Heart, Person, Plan, Series, Start, WORK_LIMIT,
    Window,
};

/// What a body does by a plan, and its face in a window of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExertionTake {
    /// What the body does, second after second.
    pub series: Series,
    /// The face.
    pub clip: Clip,
}

/// What should be said of an exertion.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ExertionWarning {
    /// The law without a steady state takes constant work to the heart's maximum.
    #[error(
        "the heart passes nine tenths of its reserve at {second} s; the law of the thesis has no steady state, \
         constant work takes it to its maximum (the heart model steady settles)"
    )]
    NearMaximum {
        /// The first second.
        second: usize,
    },
    /// Work that no body does, and that counts as the most that one does.
    #[error(
        "{seconds} seconds, from {first} s on, have more than {WORK_LIMIT} J/kg, and count as that for the heart; \
         look for a fault of the motion, or of its rate"
    )]
    OverLimit {
        /// How many.
        seconds: usize,
        /// The first.
        first: usize,
    },
    /// Curves that leave the range of their controls.
    #[error("{frames} of {of} frames have a curve that is cut at the end of its range")]
    Cut {
        /// How many.
        frames: usize,
        /// Of so many.
        of: usize,
    },
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

    /// What should be said.
    pub fn warnings(&self) -> Vec<ExertionWarning> {
        let near = self.series.near_maximum.map(|second| ExertionWarning::NearMaximum { second });
        let over = self.series.over_limit.first().map(|&first| ExertionWarning::OverLimit {
            seconds: self.series.over_limit.len(),
            first,
        });
        let (frames, of) = (self.clip.controls.cut_frames, self.clip.times.len());
        let cut = (frames > 0).then_some(ExertionWarning::Cut { frames, of });
        near.into_iter().chain(over).chain(cut).collect()
    }
}
