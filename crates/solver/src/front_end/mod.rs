//! From captured markers to displacements on the avatar.

pub(crate) mod error;
pub(crate) mod head_lowpass;
pub(crate) mod head_pose;
pub(crate) mod lowpass;
pub(crate) mod marker_frames;
pub(crate) mod marker_scales;
pub(crate) mod rbf;
pub(crate) mod surface_depth;
pub(crate) mod take;
