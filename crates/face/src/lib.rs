//! Meshes, blendshapes and avatars: vocabulary, readers, the built-in head, the avatar pack.

mod avatar;

pub use avatar::{Avatar, Eyeball, Look, Mesh, Part, SparseShape};
