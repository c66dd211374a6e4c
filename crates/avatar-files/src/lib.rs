//! Avatar files: GLB, glTF and OBJ poses in, checked avatars in metres out; and an avatar with its
//! animation as GLB.
//!
//! ```
//! use mimique_actor::{Density, HeadSpec, build_head};
//! use mimique_avatar_files::{read_avatar, write_glb};
//!
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("head.glb");
//! let head = build_head(&HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(1) });
//! std::fs::write(&file, write_glb(&head, &[], 60.0)?)?;
//!
//! // Shapes, parts, unit and eyeballs are found in the file.
//! let read = read_avatar(&file)?;
//! assert_eq!(read.avatar.shape_names, head.shape_names);
//! assert_eq!(read.avatar.eyeballs.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod driven;
mod eye_pairs;
mod files;
mod glb;
mod lids_follow;
mod obj;
mod part_words;
mod parts;
mod pictures;
mod read;
mod read_error;
mod settings;
mod template;

pub use driven::{Driven, DrivenError};
pub use glb::{GlbWriteError, WeightAnimation, read_gltf, read_weight_animation, write_glb};
pub use obj::is_folder_of_poses;
pub use parts::find_eyeballs;
pub use read::{ReadAvatar, read_avatar, read_avatar_bytes};
pub use read_error::ReadError;
pub use settings::AvatarSettings;
pub use template::{Template, read_template};
