//! Meshes, blendshapes and avatars: vocabulary, readers, the built-in head, the avatar pack.

mod avatar;
mod driven;
#[cfg(feature = "readers")]
mod glb;
pub mod pack;
#[cfg_attr(not(feature = "readers"), allow(dead_code))]
mod parts;
#[cfg(feature = "readers")]
mod read;
#[cfg(feature = "readers")]
mod read_error;
mod shape_names;

pub use avatar::{Avatar, Eyeball, Look, Mesh, Part, SparseShape};
pub use driven::{Driven, DrivenError};
#[cfg(feature = "readers")]
pub use glb::read_gltf;
pub use parts::find_eyeballs;
#[cfg(feature = "readers")]
pub use read::{ReadAvatar, read_avatar};
#[cfg(feature = "readers")]
pub use read_error::ReadError;
pub use shape_names::{ARKIT_SHAPES, ShapeMap, arkit_shapes, map_shapes};

#[cfg(feature = "parametric")]
mod parametric_head;
#[cfg(feature = "parametric")]
pub use parametric_head::{
    Density, HeadSpec, Identity, MarkerSites, SHAPE_NAMES, build_head, marker_sites,
};
#[cfg(feature = "parametric")]
mod performance;
#[cfg(feature = "parametric")]
pub use performance::{
    Clip, Emotion, HeadPose, Performance, Segment, SyntheticTake, performance_weights,
    range_of_motion, range_of_motion_take, synthetic_take,
};
