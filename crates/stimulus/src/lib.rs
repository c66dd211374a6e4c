//! What joins avatar, capture and marker map to a clip: the take that is solved, what looks wrong in
//! it, weight files, expressions of a long take, and the packs of a study.
//!
//! ```text
//! Avatar --AvatarSkin--> skin --+
//! MarkerMap --------------------+--> JoinedTake --+--> solve_take --> WeightsTable + SolveReport
//! Capture ----------------------+                 +--> operators pack + take pack
//!                                                        |
//!                                  mimique_clip::solve_packs (server, browser) --> weights
//! ```
//!
//! The built-in actor's joy on the built-in head of another person:
//!
//! ```
//! use mimique_actor::{
//!     Clip, Density, Emotion, HeadSpec, Identity, build_head, marker_sites, synthetic_take,
//! };
//! use mimique_mocap::{Capture, LengthUnit};
//! use mimique_solver::{Method, MethodSpec};
//! use mimique_stimulus::{
//!     AvatarSkin, MappedMarker, MarkerMap, MarkerPlace, TakeOptions, solve_take,
//! };
//!
//! let head = |seed| HeadSpec { identity: Identity::from_seed(seed), density: Density::COARSE };
//! let (actor, person) = (head(41), head(3));
//! let joy = Clip { emotion: Emotion::Joy, intensity: 2, seed: 9 };
//! let take = synthetic_take(&build_head(&actor), &marker_sites(&actor), &[joy], 6, 0.1);
//! let capture = Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions);
//! let sites = marker_sites(&person);
//! let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
//!     MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
//! });
//! let map = MarkerMap {
//!     face: face.collect(),
//!     head: take.head_labels,
//!     neutral: Some(0..60),
//!     ..MarkerMap::default()
//! };
//! let skin = AvatarSkin::of(&build_head(&person))?;
//! let (spec, options) = (MethodSpec::new(Method::Lsts), TakeOptions::default());
//! let solved = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0)?;
//! assert_eq!(solved.table.frames.len(), capture.frames());
//! assert!(solved.report.summary.residual_rms_mm < 3.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod avatar;
mod built_in;
mod checks;
mod exertion;
mod face;
mod gaze;
mod marker_map;
mod prepare;
mod provenance;
mod segments;
mod sound;
mod suggest_map;
mod take;
mod warning;
mod weights;

pub use avatar::{
    AvatarSkin, NoSequenceAvatar, SplitError, VertexBank, VertexBankError, VertexBankOptions,
    VertexFrames, lock_shapes, sequence_avatar, split_shapes, surface_avatar,
};
pub use built_in::{
    built_in_capture, built_in_labels, built_in_map, built_in_training, built_in_weights,
};
pub use checks::{
    ADVISED_SMOOTHING, BankDiagnosis, DependentShape, GazeBeyond, GazeFault, GazeStatistics,
    HeadMarker, LabelFault, LabelProblem, MarkerDiagnosis, STILL_MM, SmoothingAdvice,
    SmoothingReason,
};
pub use exertion::{
    Drawn, DrawnCourse, DrawnLine, ExertionDrawing, ExertionPart, ExertionPartError, ExertionTake,
    MotionOptions, PartFacts, built_in_bvh, built_in_motion,
};
pub use face::{Landmarks, MissingOpening, NoProfile, Openings, moved_by};
pub use gaze::{GazeTrack, GazeTrackError, GivenGaze};
pub use marker_map::{
    Depth, MapError, MapFileError, MapOrigin, MappedMarker, MarkerAssociation, MarkerMap,
    MarkerPlace, REACH_M, ScaleRule, TOLERANCE_M,
};
pub use prepare::{
    AdvisedMethod, Places, PrepareError, Prepared, Progress, StudySound, advised_methods,
    avatar_key, exertion_drawing, is_source, prepare, source_faults, study_sounds,
};
pub use provenance::{Provenance, sha256_of_file};
pub use segments::{
    Activity, ActivityOptions, BorderRule, Channels, EafAnnotation, EafDocument, EafError,
    EafSegments, EafTier, LeftOut, Literal, SegmentFileError, SuggestError, SuggestOptions,
    Suggestion, TakeSegment, Timeline, TimelineSegment, bridge, cut, identifier,
    read_labelled_segments, read_segments, stretches, study_segments, suggest, write_segments,
    write_segments_with,
};
pub use sound::{SoundError, SoundFacts, SoundFormat, read_sound};
pub use suggest_map::{
    MarkerRole, OFF_SKIN_M, SuggestMapError, SuggestedMap, SuggestedMarker, suggest_map,
};
pub use take::{
    FileHash, FrameRow, JoinedTake, Lid, LidEdge, RegressionSummary, RepairSidecar, SetUp,
    ShapeRow, ShapeState, SidecarError, SolveError, SolveReport, SolvedCapture, StageSeconds,
    TakeOptions, Training, sidecar_path, solve_take,
};
pub use warning::TakeWarning;
pub use weights::{
    Driven, Performance, PerformanceError, RecordedNames, RecordedWeights, WeightBeyondSense,
    WeightSteps, read_performance, weight_steps, weights_for_file,
};
