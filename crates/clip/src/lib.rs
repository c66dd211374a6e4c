//! The pipeline of a clip: operators and markers in, weights out, the same bits in the command line,
//! the studio, the server and the browser; and the packs that a clip travels in.
//!
//! ```text
//! operators pack --decode_operators--> Operators --+
//!                                                  +--> solve_packs --> weights, their hash, statistics
//! take pack --decode_take--> TakePack -------------+
//! ```
//!
//! ```
//! use mimique_clip::{SegmentMarkers, TakeContent, TakePack, encode_operators, encode_take, solve_packs};
//! use mimique_geometry::{Point, coordinates};
//! use mimique_solver::{Method, MethodSpec, OperatorOptions, OperatorParts, Operators};
//!
//! // Four markers on the avatar, metres; one shape lowers the last of them by 1 cm.
//! let labels: Vec<String> = ["left", "right", "top", "chin"].map(str::to_owned).to_vec();
//! let rest = [[0.05, 0.0, 0.01], [-0.05, 0.0, 0.01], [0.0, 0.05, 0.0], [0.0, -0.05, 0.03]];
//! let rest = rest.map(Point::from).to_vec();
//! let mut marker_deltas = vec![0.0; 12];
//! marker_deltas[10] = -0.01;
//! let operators = Operators::from_parts(OperatorParts {
//!     options: OperatorOptions::default(),
//!     shape_names: vec!["jawOpen".to_owned()],
//!     marker_labels: labels.clone(),
//!     marker_positions: rest.clone(),
//!     vertex_count: 4,
//!     marker_deltas,
//!     shell_gram: vec![1e-4],
//!     associated: None,
//!     regression: None,
//! })?;
//!
//! // An actor of the same shape, in one frame; the chin goes down by 5 mm.
//! let mut positions = coordinates(&rest).to_vec();
//! positions[10] -= 0.005;
//! let take = TakePack {
//!     rate_hz: 60.0,
//!     first_frame: 0,
//!     played: 0..1,
//!     content: TakeContent::Markers(SegmentMarkers {
//!         labels,
//!         face: vec![0, 1, 2, 3],
//!         head: None,
//!         head_reference: vec![],
//!         neutral: rest,
//!         scales: None,
//!         depth: None,
//!         positions,
//!         driven_shapes: vec![],
//!         driven_weights: vec![],
//!     }),
//! };
//! let packs = (encode_operators(&operators), encode_take(&take));
//! let solved = solve_packs(&packs.0, &packs.1, &MethodSpec::new(Method::Box))?;
//! assert!((solved.weights[0] - 0.5).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing here knows a mesh, a file or a study: the browser's worker is built of this crate alone.

mod frame_statistics;
mod gaze;
mod hashes;
mod packs;
mod pipeline;
mod solve_packs;
mod unsolved;
mod weight_timing;

pub use frame_statistics::{FrameStatistics, FramesWarning};
pub use gaze::with_gaze_at_rest;
pub use hashes::{SOLVER_VERSION, sha256_hex};
pub use mimique_solver::weights_hash;
pub use packs::{
    SegmentMarkers, TakeContent, TakePack, decode_inflated_operators, decode_operators,
    decode_take, encode_operators, encode_take, encode_take_in_steps, stored_step,
};
pub use pipeline::{
    MarkerMotion, MarkerSolution, MarkerTake, PipelineError, PipelineSeconds, marker_motion,
    solve_markers,
};
pub use solve_packs::{SolvePacksError, SolvedTake, solve_inflated, solve_packs, solve_segment};
pub use unsolved::UnsolvedFrames;
