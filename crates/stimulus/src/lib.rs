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

mod lids;
mod marker_map;
mod operators_pack;
#[cfg(feature = "prepare")]
mod prepare;
mod provenance;
#[cfg(feature = "prepare")]
mod repair_sidecar;
mod report;
#[cfg(feature = "prepare")]
mod segments;
mod skin;
mod solve_packs;
mod solve_take;
mod take_pack;
mod weights_file;

pub use lids::{Lid, LidEdge};
pub use marker_map::{MapError, MapFileError, MappedMarker, MarkerMap, MarkerPlace, TOLERANCE_M};
pub use operators_pack::{decode_operators, encode_operators};
#[cfg(feature = "prepare")]
pub use prepare::{Places, PrepareError, Prepared, Progress, prepare};
pub use provenance::{Provenance, SOLVER_VERSION, sha256_hex, weights_hash};
#[cfg(feature = "prepare")]
pub use repair_sidecar::{FileHash, RepairSidecar, SidecarError, sidecar_path};
pub use report::{FrameRow, FrameStatistics, SolveReport, StageSeconds};
#[cfg(feature = "prepare")]
pub use segments::{
    Activity, ActivityOptions, Channels, EafAnnotation, EafDocument, EafError, EafTier,
    SegmentFileError, SuggestError, SuggestOptions, Suggestion, TakeSegment, Timeline,
    TimelineSegment, cut, read_segments, suggest, write_segments,
};
pub use skin::AvatarSkin;
pub use solve_packs::{SolvePacksError, SolvedTake, solve_packs, solve_segment};
pub use solve_take::{JoinedTake, SolveError, SolvedCapture, TakeOptions, solve_take};
pub use take_pack::{SegmentMarkers, TakeContent, TakePack, decode_take, encode_take};
pub use weights_file::{WeightsFileError, WeightsTable};
