//! Why a take cannot be solved.

use mimique_clip::{PipelineError, UnsolvedFrames};
use mimique_solver::{
    FitError, FrontEndError, MeshError, OperatorError, SurfaceError, TrainingError,
};

use crate::MapError;

/// Why a take cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum SolveError {
    /// The map does not fit the avatar.
    #[error("marker map, {0}")]
    Map(#[from] MapError),
    /// The capture and the map have no label in common.
    #[error(
        "markers: the capture has none of the map's labels (the map names {map}, the capture \
         {capture}); write the map with the capture's labels"
    )]
    NoCommonLabel {
        /// Some labels of the map.
        map: String,
        /// Some labels of the capture.
        capture: String,
    },
    /// Head markers that the capture does not have.
    #[error(
        "head {} {}: not in the capture, which has {capture}; name markers of the capture",
        if .labels.len() == 1 { "marker" } else { "markers" }, .labels.join(", ")
    )]
    NoHeadMarker {
        /// The labels.
        labels: Vec<String>,
        /// Some labels of the capture.
        capture: String,
    },
    /// A gaze is given, and no shape turns the eyes.
    #[error(
        "gaze: the avatar has no shape that turns its eyes (ARKit's eyeLook*, action units 61 to 64); leave the \
         gaze out"
    )]
    NoGazeShapes,
    /// A marker that is looked at is not in the capture.
    #[error(
        "gaze target {label}: not in the capture, which has {capture}; name a marker of the capture"
    )]
    NoGazeTarget {
        /// The label.
        label: String,
        /// Some labels of the capture.
        capture: String,
    },
    /// A marker that is to be scaled is not on the face.
    #[error("scale of marker {label}: not a face marker of map and capture, which have {markers}")]
    NoScaledMarker {
        /// The label.
        label: String,
        /// Some face markers.
        markers: String,
    },
    /// The frames of the range of motion are not in the capture.
    #[error(
        "automatic scale, frames {first}:{end} of {frames}; give the frames of the range of motion"
    )]
    ScaleFrames {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// Frames there are.
        frames: usize,
    },
    /// All markers lie in a plane of constant z.
    #[error(
        "capture: two-dimensional (z is {z_mm} mm throughout); take the depth from the surface \
         (--depth surface, or \"depth\": \"surface\" in the marker map)"
    )]
    Flat {
        /// The one depth, millimetres.
        z_mm: f64,
    },
    /// Two labels at one place, on the neutral face.
    #[error(
        "markers {first} and {second}: at one place on the neutral face; one of the two labels is wrong"
    )]
    OnePlace {
        /// One label.
        first: String,
        /// The other.
        second: String,
    },
    /// A marker that is never seen while the face is neutral.
    #[error(
        "face marker {0} is not seen in any neutral frame; give other neutral frames or leave the \
         marker out of the map"
    )]
    NeutralUnseen(String),
    /// The capture is empty.
    #[error("capture: no frames; record or export the take again")]
    NoFrames,
    /// A segment is not inside the capture.
    #[error("frames {first}:{end} of {frames}; give a range inside the capture")]
    Segment {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// Frames there are.
        frames: usize,
    },
    /// The skin cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// D and H cannot be built.
    #[error(transparent)]
    Operators(#[from] OperatorError),
    /// Head, neutral, alignment or adaptation fail.
    #[error(transparent)]
    FrontEnd(#[from] FrontEndError),
    /// The method does not solve.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// Frames are not solved.
    #[error("{}", frames.sentence(*first_frame))]
    Unsolved {
        /// Which, and why.
        frames: UnsolvedFrames,
        /// The number of the first frame in the capture.
        first_frame: u64,
    },
    /// The operators are of other markers.
    #[error(transparent)]
    Markers(PipelineError),
    /// The surface has no response to its markers.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Nothing can be learnt.
    #[error(transparent)]
    Training(#[from] TrainingError),
    /// The training take has other markers.
    #[error(
        "training: the take has no marker {missing}, which the take to be solved has; train with \
         the same markers, or leave them out of the map"
    )]
    TrainingMarkers {
        /// The labels.
        missing: String,
    },
    /// The training weights are of other shapes.
    #[error(
        "training: none of the weights' shapes ({weights}) is one of the avatar's ({avatar}); give \
         weights under the avatar's names, or ARKit's"
    )]
    TrainingShapes {
        /// Some names of the weights.
        weights: String,
        /// Some names of the avatar.
        avatar: String,
    },
}

impl From<PipelineError> for SolveError {
    fn from(error: PipelineError) -> Self {
        match error {
            PipelineError::FrontEnd(error) => error.into(),
            PipelineError::Fit(error) => error.into(),
            PipelineError::Unsolved(frames) => Self::Unsolved { frames, first_frame: 0 },
            other @ PipelineError::NoMarker(_) => Self::Markers(other),
        }
    }
}

impl SolveError {
    /// The same with frames numbered as the capture numbers them.
    pub(super) fn counted_from(self, first_frame: u64) -> Self {
        match self {
            Self::Unsolved { frames, .. } => Self::Unsolved { frames, first_frame },
            other => other,
        }
    }
}
