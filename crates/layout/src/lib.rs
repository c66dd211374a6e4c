//! Marker layouts.

mod candidates;
mod draws;
mod error;
mod face;
mod method;
mod motion;
mod progress;
mod rehearsal;
mod spacing;
mod units;
mod view;

pub use candidates::{CandidateCounts, Candidates, MOVED_M, Where, unseen_shapes};
pub use error::LayoutError;
pub use face::{Excluded, Face, FaceError, FacePart, Landmarks, MirrorVertices, MissingOpening, Openings, PARTNER_M};
pub use method::{Choice, Chosen, ClusterOptions, Method, RehearseOptions, Task};
pub use motion::{DenseTake, DenseTakeError, FaceMotion, MotionSource, PersonMotion, Take, TakeContent};
pub use progress::{Progress, Silent};
pub use rehearsal::{BankSolver, Conditions, Effort, Person, Rehearsal, square_errors};
pub use spacing::{Camera, Distance, Spacing};
pub use units::Units;
pub use view::{DepthPicture, View};
