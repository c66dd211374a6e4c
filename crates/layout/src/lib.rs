//! Marker layouts: how many markers a face needs, and where.
//!
//! A [`Face`] has landmarks, parts and a mirror image; [`Candidates`] are where markers may be, [`FaceMotion`] is what
//! is to be told of it. A [`Method`] chooses [`Units`] that keep a [`Spacing`]; a [`Rehearsal`] solves simulated takes
//! of a layout with the real front end and solver, and [`Comparing`] draws curves of it. [`MapCheck`] tells what a
//! marker map cannot see, [`Sheet`] shows where markers go.
//!
//! ```
//! use mimique_actor::{Density, HeadSpec, build_head};
//! use mimique_layout::{Candidates, ExpectedCurve, Face, FaceMotion, Where, unseen_shapes};
//! use mimique_stimulus::AvatarSkin;
//!
//! let head = build_head(&HeadSpec { density: Density::nearest(4_000), ..HeadSpec::default() });
//! let skin = AvatarSkin::of(&head)?;
//! let face = Face::of(&skin)?;
//! let places = Candidates::of(&face, &Where::default()).vertices;
//! // No motion is given: every shape counts by itself.
//! let motion = FaceMotion::of(&face, &[], &unseen_shapes(&face, &places))?;
//! let mut curve = ExpectedCurve::new(&motion, 1e-4, 1.5e-3);
//! let errors = curve.of(&face.gradients, &motion, &[places[0], places[200], places[400]]);
//! assert!(errors.windows(2).all(|pair| pair[1] < pair[0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
pub use comparison::{Comparing, Comparison, CurveRow, MarkerWorth, RowTrial, missed, worth};
pub use curve::ExpectedCurve;
pub use error::LayoutError;
pub use evaluation::{Errors, Fold, Judge, Trial, enough, enough_for, folds};
pub use face::{
    Excluded, Face, FaceError, FacePart, Landmarks, MirrorVertices, MissingOpening, Openings,
    PARTNER_M,
};
pub use layout::{
    HEAD_NOISE_M, HEAD_STILL_M, Heads, Layout, LayoutMarker, Side, choose_heads, face_moments,
    head_places,
};
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
pub use spacing::{Camera, DISTANCE_M, Distance, Spacing, nearest_in_motion};
pub use units::Units;
pub use view::{DepthPicture, View};
