//! Why the front end of a take cannot go on.

use mimique_geometry::RigidError;

use crate::front_end::lowpass::LowpassError;
use crate::front_end::rbf::RbfError;

/// Where and why the front end cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FrontEndError {
    /// The head's pose cannot be told in a frame.
    #[error("frame {frame}, head markers: {cause}; name other head markers, or fill the gap")]
    Head {
        /// Index of the frame.
        frame: usize,
        /// Why.
        cause: RigidError,
    },
    /// The neutral frames are not in the take.
    #[error("neutral frames {start}:{end} of {frames}; give a range inside the take")]
    NeutralRange {
        /// First frame.
        start: usize,
        /// One past the last.
        end: usize,
        /// Frames of the take.
        frames: usize,
    },
    /// A face marker is never seen while the face is neutral.
    #[error(
        "face marker {marker} is not seen in any neutral frame; give other neutral frames or leave the marker out of the map"
    )]
    NeutralUnseen {
        /// Index in [`crate::MarkerColumns::face`].
        marker: usize,
    },
    /// The neutral cannot be laid onto the avatar.
    #[error("face markers: {0}; map more markers")]
    Alignment(RigidError),
    /// The adaptation of shape has no solution.
    #[error(transparent)]
    Rbf(#[from] RbfError),
    /// The head's low-pass does not exist.
    #[error("headLowpassHz: {0}")]
    Lowpass(#[from] LowpassError),
    /// Numbers that should be equal are not.
    #[error("{what}: {found}, {expected} expected")]
    Size {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
}

pub(crate) fn equal(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), FrontEndError> {
    if found == expected { Ok(()) } else { Err(FrontEndError::Size { what, found, expected }) }
}
