//! Meshes, blendshapes and avatars: vocabulary, readers, the built-in head, the avatar pack.

mod avatar;
mod driven;
#[cfg(feature = "readers")]
mod eye_pairs;
#[cfg(feature = "readers")]
mod files;
#[cfg(feature = "readers")]
mod glb;
mod glb_write;
mod image;
#[cfg(feature = "readers")]
mod obj;
pub mod pack;
#[cfg(feature = "readers")]
mod part_words;
#[cfg(feature = "readers")]
mod parts;
#[cfg(feature = "readers")]
mod read;
#[cfg(feature = "readers")]
mod read_error;
#[cfg(feature = "readers")]
mod settings;
mod shape_names;
#[cfg(feature = "textures")]
mod texture;
#[cfg(feature = "readers")]
mod texture_in;

pub use avatar::{
    Avatar, Eyeball, Look, MOST_EYEBALLS, MOST_SHAPES, Mesh, Part, SparseShape, Texture, Textured,
};
pub use driven::{Driven, DrivenError};
#[cfg(feature = "readers")]
pub use glb::read_gltf;
pub use glb_write::{GlbWriteError, write_glb};
pub use image::{Image, MOST_TEXTURE_SIDE};
#[cfg(feature = "readers")]
pub use parts::find_eyeballs;
#[cfg(feature = "readers")]
pub use read::{ReadAvatar, read_avatar, read_avatar_bytes};
#[cfg(feature = "readers")]
pub use read_error::ReadError;
#[cfg(feature = "readers")]
pub use settings::AvatarSettings;
pub use shape_names::{ARKIT_SHAPES, ShapeMap, arkit_shapes, map_shapes};

#[cfg(feature = "textures")]
pub use texture::TextureError;

#[cfg(feature = "parametric")]
mod parametric_head;
#[cfg(feature = "parametric")]
/// The built-in head's shapes, and what each is of a face (`Left/Right` are two shapes):
///
#[doc = include_str!("facs.md")]
///
pub use parametric_head::SHAPE_NAMES;
#[cfg(feature = "parametric")]
pub use parametric_head::{Density, HeadSpec, Identity, MarkerSites, build_head, marker_sites};
#[cfg(feature = "parametric")]
mod performance;
#[cfg(feature = "parametric")]
pub use performance::{
    Clip, Emotion, HeadPose, Performance, Segment, SyntheticTake, performance_weights,
    range_of_motion, range_of_motion_take, synthetic_take,
};
