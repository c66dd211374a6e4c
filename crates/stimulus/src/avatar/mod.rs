//! An avatar as the solver takes it, and what the solver gives back to an avatar.

mod sequence_avatar;
mod skin;
mod split_shapes;
mod surface_avatar;
mod vertex_bank;
mod vertex_frames;

pub use sequence_avatar::{NoSequenceAvatar, sequence_avatar};
pub use skin::{AvatarSkin, lock_shapes};
pub use split_shapes::{SplitError, split_shapes};
pub use surface_avatar::surface_avatar;
pub use vertex_bank::{VertexBank, VertexBankError, VertexBankOptions};
pub use vertex_frames::VertexFrames;
