//! The built-in actor: a head made wholly by code, any number of people from a seed; its performances
//! of emotions, and synthetic motion capture of them; and a body that walks, runs and sprints.
//!
//! ```
//! use mimique_actor::{Clip, Density, Emotion, HeadSpec, build_head, marker_sites, synthetic_take};
//!
//! // The eleventh person, coarsely, with the shapes of ARKit's vocabulary.
//! let spec = HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(11) };
//! let head = build_head(&spec);
//! assert!(head.shape_index("jawOpen").is_some());
//!
//! // The person is glad, strongly, before a motion capture system without noise.
//! let joy = Clip { emotion: Emotion::Joy, intensity: 3, seed: 7 };
//! let take = synthetic_take(&head, &marker_sites(&spec), &[joy], 1, 0.0);
//! assert_eq!(take.positions.len(), take.frames() * take.labels.len());
//! let smile = head.shape_index("mouthSmileLeft").ok_or("no smile")?;
//! let played = take.truth.chunks_exact(head.shape_names.len()).map(|weights| weights[smile]);
//! assert!(played.fold(0.0, f64::max) > 0.3);
//! # Ok::<(), &str>(())
//! ```

mod gait;
mod head;
mod performance;

pub use gait::{Gait, gait_bvh};

/// The built-in head's shapes, and what each is of a face (`Left/Right` are two shapes):
///
#[doc = include_str!("facs.md")]
///
pub use head::SHAPE_NAMES;
pub use head::{
    Density, FaceLine, FaceLinePart, HeadSpec, Identity, MarkerSites, build_head, face_lines,
    marker_sites,
};
pub use performance::{
    Clip, Emotion, HeadPose, NOISE_MM, Performance, Phases, Segment, SyntheticTake,
    performance_weights, range_of_motion, range_of_motion_take, synthetic_take,
};
