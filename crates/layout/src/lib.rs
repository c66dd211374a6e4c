//! Marker layouts.

mod candidates;
mod check;
mod comparison;
mod curve;
mod draws;
mod error;
mod evaluation;
mod face;
mod layout;
mod method;
mod motion;
mod progress;
mod rehearsal;
mod sets;
mod sheet;
mod spacing;
mod units;
mod view;

pub use candidates::{CandidateCounts, Candidates, MOVED_M, Where, gaze_shapes, unseen_shapes};
pub use check::{
    CheckOptions, HeadSight, MapCheck, NearestPair, PartSight, PlacementSight, ShapeSight,
};
pub use comparison::{Comparing, Comparison, CurveRow, MarkerWorth, RowTrial, worth};
pub use curve::ExpectedCurve;
pub use error::LayoutError;
pub use evaluation::{Errors, Fold, Judge, Trial, enough, enough_for, folds};
pub use face::{
    Excluded, Face, FaceError, FacePart, Landmarks, MirrorVertices, MissingOpening, Openings,
    PARTNER_M,
};
pub use layout::{HEAD_STILL_M, Heads, Layout, LayoutMarker, Side, choose_heads, face_moments};
pub use method::{Choice, Chosen, ClusterOptions, Method, RehearseOptions, Task};
pub use motion::{
    Basis, DenseTake, DenseTakeError, FaceMotion, MotionSource, PersonMotion, Take, TakeContent,
};
pub use progress::{Progress, Silent};
pub use rehearsal::{
    BankSolver, Conditions, Effort, KernelNumbers, Person, Rehearsal, VertexGroup,
};
pub use sets::{NamedSet, face_robot, mixed, mpeg4, random};
pub use sheet::{AlongSkin, Measures, Sheet, SheetOptions, ToLandmark, face_height, face_width};
pub use spacing::{Camera, Distance, Spacing, nearest_in_motion};
pub use units::Units;
pub use view::{DepthPicture, View};
