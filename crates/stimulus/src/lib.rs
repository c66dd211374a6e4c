//! What joins avatar, capture and method: marker maps, the solve of a take, weight files, packs, provenance.
//!
//! ```text
//! Avatar --AvatarSkin--> skin --+
//! MarkerMap --------------------+--> solve_take --> WeightsTable + SolveReport
//! Capture ----------------------+
//!                               +--> JoinedTake --> operators pack + take pack
//!                                                      (server)     |
//!                                              solve_packs (server, browser) --> weights
//! ```

#[cfg(feature = "prepare")]
mod bank_diagnosis;
#[cfg(feature = "prepare")]
mod found_neutral;
#[cfg(feature = "prepare")]
mod head_check;
#[cfg(feature = "prepare")]
mod joined_take;
#[cfg(feature = "prepare")]
mod label_check;
mod lids;
mod marker_map;
mod operators_pack;
#[cfg(feature = "prepare")]
mod prepare;
mod provenance;
#[cfg(feature = "prepare")]
mod recorded;
#[cfg(feature = "prepare")]
mod repair_sidecar;
mod report;
#[cfg(feature = "prepare")]
mod segments;
mod skin;
#[cfg(feature = "prepare")]
mod solve_error;
mod solve_packs;
#[cfg(feature = "prepare")]
mod solve_take;
#[cfg(feature = "prepare")]
mod split_shapes;
#[cfg(feature = "prepare")]
mod suggest_map;
#[cfg(feature = "prepare")]
mod surface_avatar;
#[cfg(feature = "prepare")]
mod take_adjustments;
#[cfg(feature = "prepare")]
mod take_checks;
#[cfg(feature = "prepare")]
mod take_lids;
mod take_pack;
#[cfg(feature = "prepare")]
mod take_provenance;
#[cfg(feature = "prepare")]
mod take_segment;
mod tracks;
#[cfg(feature = "prepare")]
mod training;
#[cfg(feature = "prepare")]
mod vertex_frames;
#[cfg(feature = "prepare")]
mod weight_steps;
mod weights_file;

#[cfg(feature = "prepare")]
pub use bank_diagnosis::{BankDiagnosis, DependentShape, MarkerDiagnosis};
#[cfg(feature = "prepare")]
pub use head_check::{HeadMarker, STILL_MM};
#[cfg(feature = "prepare")]
pub use joined_take::{JoinedTake, SetUp};
#[cfg(feature = "prepare")]
pub use label_check::{LabelFault, LabelProblem};
pub use lids::{Lid, LidEdge};
pub use marker_map::{
    Depth, MapError, MapFileError, MappedMarker, MarkerAssociation, MarkerMap, MarkerPlace,
    REACH_M, ScaleRule, TOLERANCE_M,
};
pub use operators_pack::{decode_inflated_operators, decode_operators, encode_operators};
#[cfg(feature = "prepare")]
pub use prepare::{Places, PrepareError, Prepared, Progress, prepare};
pub use provenance::{Provenance, SOLVER_VERSION, sha256_hex, sha256_of_file, weights_hash};
#[cfg(feature = "prepare")]
pub use recorded::{Driven, RecordedNames, RecordedWeights};
#[cfg(feature = "prepare")]
pub use repair_sidecar::{FileHash, RepairSidecar, SidecarError, sidecar_path};
#[cfg(feature = "prepare")]
pub use report::SolveReport;
pub use report::{FrameRow, FrameStatistics, RegressionSummary, StageSeconds};
#[cfg(feature = "prepare")]
pub use segments::{
    Activity, ActivityOptions, Channels, EafAnnotation, EafDocument, EafError, EafTier,
    SegmentFileError, SuggestError, SuggestOptions, Suggestion, TakeSegment, Timeline,
    TimelineSegment, cut, read_segments, study_segments, suggest, write_segments,
};
pub use skin::{AvatarSkin, lock_shapes};
#[cfg(feature = "prepare")]
pub use solve_error::SolveError;
pub use solve_packs::{SolvePacksError, SolvedTake, solve_inflated, solve_packs, solve_segment};
#[cfg(feature = "prepare")]
pub use solve_take::{SolvedCapture, TakeOptions, solve_take};
#[cfg(feature = "prepare")]
pub use split_shapes::{SplitError, split_shapes};
#[cfg(feature = "prepare")]
pub use suggest_map::{
    MarkerRole, OFF_SKIN_M, SuggestMapError, SuggestedMap, SuggestedMarker, suggest_map,
};
#[cfg(feature = "prepare")]
pub use surface_avatar::surface_avatar;
pub use take_pack::{
    SegmentMarkers, TakeContent, TakePack, decode_take, encode_take, encode_take_in_steps,
};
#[cfg(feature = "prepare")]
pub use training::Training;
#[cfg(feature = "prepare")]
pub use vertex_frames::VertexFrames;
#[cfg(feature = "prepare")]
pub use weight_steps::{WeightSteps, weight_steps};
pub use weights_file::{WeightsFileError, WeightsTable};
