//! Why a layout cannot be made, as codes with values.

use mimique_solver::{FitError, FrontEndError, OperatorError, SurfaceError, TrainingError};

use crate::face::FaceError;
use crate::motion::DenseTakeError;

/// Why a layout cannot be made or judged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LayoutError {
    /// The avatar has no face that can be measured.
    #[error(transparent)]
    Face(#[from] FaceError),
    /// A dense take does not fit.
    #[error(transparent)]
    Dense(#[from] DenseTakeError),
    /// No shape moves anything, so there is no motion to make a layout for.
    #[error(
        "avatar: no shape moves its skin by 1 mm; a layout needs blendshapes, or --take with a dense take"
    )]
    NoMotion,
    /// Nothing is left to put markers on.
    #[error(
        "region: none of {moved} moved vertices may have a marker ({seen} are seen, {named} in the region); exclude \
         less, or name a larger region"
    )]
    EmptyRegion {
        /// Vertices moved by a millimetre.
        moved: usize,
        /// Of these, seen.
        seen: usize,
        /// Of these, in the region.
        named: usize,
    },
    /// More markers than fit.
    #[error(
        "markers: {fit} of {wanted} fit at {millimetres} mm; ask for fewer, lower the distance, or exclude less"
    )]
    TooMany {
        /// How many fit.
        fit: usize,
        /// How many are wanted.
        wanted: usize,
        /// The distance that they keep, millimetres.
        millimetres: f64,
    },
    /// Too few markers for a face.
    #[error("markers: {0}; a face needs at least 4 that are not in one plane")]
    TooFew(usize),
    /// The face is not symmetric.
    #[error(
        "avatar: {without} of {of} allowed vertices have no partner within {millimetres} mm on the other side; \
         take --free"
    )]
    Asymmetric {
        /// Vertices without a partner.
        without: usize,
        /// Allowed vertices.
        of: usize,
        /// How near a partner must be, millimetres.
        millimetres: f64,
    },
    /// Fewer than three places for head markers.
    #[error(
        "head: {found} places on skin that moves less than 0.2 mm where {wanted} markers keep their distance; ask \
         for fewer, or put them on a headband and give --head 0"
    )]
    NoHead {
        /// Places found.
        found: usize,
        /// Markers wanted.
        wanted: usize,
    },
    /// Too few head markers for a pose.
    #[error(
        "head: {0} markers tell no pose; give 3 or more, or 0 for a headband that is not laid out here"
    )]
    TooFewHeads(usize),
    /// Kept markers do not keep the distance, or are more than wanted.
    #[error("keep: {what}")]
    Kept {
        /// What is wrong, with a remedy.
        what: String,
    },
    /// Operators of the markers.
    #[error("markers: {0}")]
    Operators(#[from] OperatorError),
    /// The method.
    #[error("solve: {0}")]
    Fit(#[from] FitError),
    /// The front end.
    #[error("markers: {0}")]
    FrontEnd(#[from] FrontEndError),
    /// What a regression learns.
    #[error("solve: {0}")]
    Training(#[from] TrainingError),
    /// The thin shell.
    #[error("shell: {0}")]
    Surface(#[from] SurfaceError),
}
