//! The studio's worker: an avatar's and a capture's file in; marker map, weights, expressions and
//! exports out. Nothing leaves the browser.
//!
//! ```js
//! const studio = new Studio();
//! studio.avatarFile("head.glb", bytes);      // facts as JSON
//! studio.takeFile("take.c3d", bytes, null, null);
//! studio.suggestMap();
//! studio.solve("a", '{"method": "lsts", "alpha": 0.3}');
//! studio.weights("a");                       // Float32Array, frames x shapes
//! ```
//!
//! Every call throws an `Error` whose message says file, place, value and remedy. What comes in and
//! goes out is JSON text and typed arrays; the work itself is [`Workspace`]'s, which tests use natively.

mod bindings;
mod capture_points;
mod difference;
mod exertion;
mod expressions;
mod gaze;
mod labels;
mod layout;
mod markers;
mod method_fields;
mod picture;
mod problem;
mod solved;
mod study;
mod training;
mod workspace;

pub use bindings::Studio;
pub use difference::Difference;
pub use picture::{Picture, pick};
pub use problem::Problem;
pub use workspace::Workspace;
