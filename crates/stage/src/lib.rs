//! Renders heads with wgpu: WebGPU, WebGL2 and offscreen.
//!
//! One WGSL path that WebGL2 can run: no compute, no storage buffers. A frame is six steps, all
//! over tables that stay on the GPU; the CPU writes two small uniform buffers.
//!
//! | pass | shader | a fragment a | gives |
//! |---|---|---|---|
//! | 1 deform | `deform.wgsl` | vertex | position = neutral + sum of weight x delta, eyeballs turned |
//! | 2 light | `shade.wgsl` | pixel of the key light's view | depth |
//! | 3 surface | `surface.wgsl` | vertex | normal of the deformed surface, visibility of the key light |
//! | 4 soften | `soften.wgsl` | vertex, four times | visibility averaged with the vertices round it |
//! | 5 strain | `strain.wgsl` | vertex | how the skin is stretched and pressed |
//! | 6 picture | `shade.wgsl`, `hair.wgsl`, `creases.wgsl` | pixel, 4x MSAA | colour, creases where skin is pressed |
//!
//! Colours are computed in linear light, pass a filmic response and are stored in an sRGB format,
//! so that the resolve of the samples is linear too; a target that does not encode sRGB by itself
//! gets one more pass (`encode.wgsl`). At loading, `occlusion.wgsl` finds how open each vertex lies.
//!
//! Where a head is in the picture is known without a GPU:
//!
//! ```
//! use mimique_actor::{Density, HeadSpec, build_head};
//! use mimique_stage::{Landmarks, Look};
//!
//! let head = build_head(&HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(1) });
//! let landmarks = Landmarks::find(&head);
//! // The person's left eye is at larger x, the chin below the mouth; eyes stand 5 to 8 cm apart.
//! assert!(landmarks.eye_left[0] > landmarks.eye_right[0]);
//! assert!(landmarks.chin[1] < landmarks.mouth[1]);
//! assert!((0.05..0.08).contains(&landmarks.eye_span()));
//! let grey = Look::STIMULUS.with_background_srgb([128, 128, 128]);
//! assert_ne!(grey, Look::STIMULUS.with_background_srgb([0, 0, 0]));
//! ```
//!
//! and drawn by a [`Renderer`] that has loaded it, in a browser or offscreen (`offscreen`).

mod along_hair;
mod error;
mod eye_guess;
mod framing;
mod geometry;
mod head;
mod layouts;
mod look;
mod neck;
#[cfg(feature = "native")]
pub mod offscreen;
mod pipelines;
mod renderer;
mod tables;
mod targets;
mod textures;

pub use error::StageError;
pub use framing::{Landmarks, View};
pub use head::Head;
pub use look::Look;
pub use renderer::Renderer;
pub use wgpu;
