//! Avatars: meshes with blendshapes, what the shapes of other rigs are called, and the pack in which an
//! avatar travels to the browser.
//!
//! ```
//! use mimique_avatar::pack::{decode_pack, encode_pack};
//! use mimique_avatar::{Avatar, Mesh, SparseShape, arkit_shapes, turns_eyes};
//!
//! // One triangle of skin, metres; the jaw's shape lowers its last corner by a centimetre.
//! let jaw = SparseShape { vertices: vec![2], deltas: vec![[0.0, -0.01, 0.0]] };
//! let skin = Mesh {
//!     name: "skin".to_owned(),
//!     positions: vec![[0.05, 0.0, 0.0], [-0.05, 0.0, 0.0], [0.0, -0.1, 0.02]],
//!     triangles: vec![[0, 2, 1]],
//!     shapes: vec![jaw],
//!     ..Mesh::default()
//! };
//! let avatar = Avatar {
//!     name: "triangle".to_owned(),
//!     shape_names: vec!["AU26".to_owned()],
//!     meshes: vec![skin],
//!     ..Avatar::default()
//! };
//! // What the shape is in ARKit's words, and whether it turns the eyes.
//! assert_eq!(arkit_shapes("AU26"), ["jawOpen"]);
//! assert!(!turns_eyes("AU26"));
//!
//! // To the browser and back; half a jaw's drop.
//! let there = decode_pack(&encode_pack(&avatar).bytes)?;
//! let posed = there.meshes[0].posed(&[0.5]);
//! assert!((posed[2][1] + 0.105).abs() < 1e-4);
//! # Ok::<(), mimique_avatar::pack::PackError>(())
//! ```

mod avatar;
mod gaze;
mod head_pose;
mod image;
pub mod pack;
mod shape_names;
mod texture;

pub use avatar::{
    Avatar, Expression, Eyeball, Look, MOST_EYEBALLS, MOST_SHAPES, Mesh, Part, SparseShape,
    Texture, Textured,
};
pub use gaze::{
    EyeAngles, GazeAngles, GazeShapes, LOOK_DEGREES, VERGENCE_DEGREES, VERTICAL_DISPARITY_DEGREES,
};
pub use head_pose::{HEAD_POSE_DEGREES, HEAD_POSE_SHAPES, HeadAngles};
pub use image::{Image, MOST_TEXTURE_SIDE};
pub use shape_names::{
    ARKIT_SHAPES, ActionUnit, BODY_SHAPES, BREATH, ShapeMap, arkit_shapes, blinks, map_shapes,
    shows_body, turns_eyes,
};
pub use texture::TextureError;
