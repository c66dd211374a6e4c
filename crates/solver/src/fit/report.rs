//! What a solve hands back: weights, and what is to be said of each frame.

/// What is said of a frame beside its weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameReport {
    /// Root mean square distance of the markers (by importance) to where the weights put them,
    /// metres, over the markers that were seen.
    pub residual: f64,
    /// Newton steps, or exchanges of the active set.
    pub iterations: u32,
    /// How far a single weight could still move to improve the objective, in units of weight: the
    /// largest violation of the Karush-Kuhn-Tucker conditions divided by the curvature.
    pub kkt_error: f64,
    /// Thin-shell energy of the surface (`thin-shell-surface`), d^T K d of eq. 2.16 summed over the
    /// coordinates, m^2.
    pub energy: Option<f64>,
    /// Predictive standard deviation of the weights (`regression`), before the bounds.
    pub deviation: Option<f64>,
    /// Face markers not seen in the frame; their rows were dropped.
    pub missing_markers: u32,
    /// What is to be said aloud.
    pub warning: Option<FrameWarning>,
}

impl FrameReport {
    /// Of a blend: what is to be said of its frame, whose mixed weights have this residual.
    pub(crate) fn of_blend(&self, second: &FrameReport, residual: f64) -> FrameReport {
        FrameReport {
            residual,
            iterations: self.iterations + second.iterations,
            kkt_error: self.kkt_error.max(second.kkt_error),
            warning: self.warning.or(second.warning),
            ..*self
        }
    }
}

/// The largest weight that a face has any use for.
pub const LARGEST_WEIGHT: f64 = 10.0;
/// The largest displacement of a point of the face, metres.
pub const LARGEST_DISPLACEMENT: f64 = 0.2;

impl FrameWarning {
    /// Whether the frame's weights are no answer.
    pub fn is_unsolved(self) -> bool {
        matches!(self, FrameWarning::NotConverged | FrameWarning::BeyondSense)
    }
}

/// A frame that needs saying.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FrameWarning {
    /// The tolerance was not reached.
    #[error("the solver did not reach its tolerance; the weights are its best")]
    NotConverged,
    /// A weight beyond [`LARGEST_WEIGHT`], or a marker's point moved beyond [`LARGEST_DISPLACEMENT`].
    #[error("no face does this: a weight is over 10, or the face is moved by over 20 cm")]
    BeyondSense,
    /// The frame was not solved; its weights are interpolated between the solved frames around it.
    #[error("not solved; held from the solved frames around it")]
    Held,
    /// No marker was seen: the weights are those of the priors alone.
    #[error("no marker is seen; the weights follow from the priors alone")]
    NoMarkers,
    /// The residual vanished and the norm had to be smoothed with eps = 1e-4 l.
    #[error("the markers are met exactly, where the norm has no slope; smoothed with eps = 1e-4 l")]
    Smoothed,
    /// Nothing like the frame is among the frames that the regression has learnt from.
    #[error("far from the training data: more than half of the prior variance is left")]
    FarFromTraining,
}

/// The answer of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameSolution {
    /// N weights, in the avatar's order of shapes.
    pub weights: Vec<f64>,
    /// How it went.
    pub report: FrameReport,
}

/// The answer of a take.
#[derive(Debug, Clone, PartialEq)]
pub struct TakeSolution {
    /// frames x N.
    pub weights: Vec<f64>,
    /// One per frame.
    pub reports: Vec<FrameReport>,
}

impl Default for FrameReport {
    fn default() -> FrameReport {
        FrameReport {
            residual: 0.0,
            iterations: 0,
            kkt_error: 0.0,
            energy: None,
            deviation: None,
            missing_markers: 0,
            warning: None,
        }
    }
}
