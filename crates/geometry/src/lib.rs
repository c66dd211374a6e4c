//! The geometry that the other crates share: places and ways between them, rigid motions, the
//! decompositions of small matrices, the low-pass filter over time.
//!
//! Vectors are glam's, decompositions nalgebra's; both compute with f64 and with `libm` in the place
//! of the platform's own functions, so that the bits are the same natively and in WebAssembly.
//!
//! ```
//! use mimique_geometry::{DQuat, Point, RigidMotion, align_rigidly};
//!
//! // Four markers of a head, metres, and where they are after a nod and a step to the left.
//! let rest = [[0.0, 0.1, 0.09], [0.06, 0.08, 0.05], [-0.06, 0.08, 0.05], [0.0, 0.16, -0.02]];
//! let rest = rest.map(Point::from);
//! let nod = RigidMotion::turn(DQuat::from_xyzw(0.6, 0.0, 0.0, 0.8)).then_by([0.2, 0.0, 0.0].into());
//! let moved = rest.map(|p| nod.apply(p));
//!
//! let found = align_rigidly(&rest, &moved)?;
//! let (there, expected) = (found.apply(Point::ORIGIN), Point::new(0.2, 0.0, 0.0));
//! assert!((there - expected).length() < 1e-12);
//! // The way back.
//! assert!((found.inverse().apply(moved[3]) - rest[3]).length() < 1e-12);
//! # Ok::<(), mimique_geometry::RigidError>(())
//! ```

mod alignment;
mod butterworth;
mod decompositions;
mod point;
mod rigid_motion;

pub use alignment::{RigidError, align_rigidly, best_pose, pose_between};
pub use butterworth::Butterworth;
pub use decompositions::{eigenvectors, orthogonal_triangular, pseudo_inverse, solve_linear};
pub use glam::{DMat3, DQuat, DVec3};
pub use point::{Displacement, Point, centroid, coordinates, rows_mut};
pub use rigid_motion::{Pose, RigidMotion};
