//! A take: avatar, marker map and capture joined, and solved.

mod adjustments;
mod found_neutral;
mod gaze;
mod head_motion;
mod joined;
mod lid_opening;
mod lids;
mod provenance;
mod repair_sidecar;
mod report;
mod segment;
mod shape_row;
mod solve;
mod solve_error;
mod training;

pub use joined::{JoinedTake, SetUp};
pub use lid_opening::{Lid, LidEdge};
pub use repair_sidecar::{FileHash, RepairSidecar, SidecarError, sidecar_path};
pub(crate) use report::untold_shapes;
pub use report::{FrameRow, RegressionSummary, SolveReport, StageSeconds};
pub(crate) use shape_row::held_shapes;
pub use shape_row::{ShapeRow, ShapeState};
pub use solve::{SolvedCapture, TakeOptions, solve_take};
pub use solve_error::SolveError;
pub use training::Training;
