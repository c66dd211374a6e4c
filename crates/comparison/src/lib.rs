//! Clips of one performance held against each other: how far apart their faces are, part by part in millimetres;
//! how each of them moves, in the measures that the literature reports; and whether they differ in nothing but the
//! method.
//!
//! ```
//! use mimique_actor::{Density, HeadSpec, build_head};
//! use mimique_comparison::{ComparedFace, FaceMotion, difference};
//! use mimique_stimulus::AvatarSkin;
//!
//! let head = build_head(&HeadSpec { density: Density::COARSE, ..HeadSpec::default() });
//! let skin = AvatarSkin::of(&head)?;
//! let face = ComparedFace::of(&skin);
//! let (n, jaw) = (skin.shape_names.len(), head.shape_index("jawOpen").unwrap());
//! // Ten frames at rest, and ten with the mouth half open.
//! let rest = vec![0.0; 10 * n];
//! let mut open = rest.clone();
//! open.chunks_exact_mut(n).for_each(|row| row[jaw] = 0.5);
//! let motions = [rest, open].map(|weights| FaceMotion::of(&skin, &face, &weights, 60.0));
//! let apart = difference(&face, &motions[0], &motions[1])?;
//! let part = |name: &str| apart.parts.iter().find(|part| part.part == name).unwrap();
//! assert!(part("Jaw").largest_mm > 5.0 && part("Forehead").largest_mm < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clip_measures;
mod courses;
mod difference;
mod face;
mod lips;
mod markers;
mod measures;
mod motion;
mod same_but_method;

pub use clip_measures::ClipMeasures;
pub use courses::ClipCourses;
pub use difference::{Difference, LipClosures, NotComparable, PartDifference, difference};
pub use face::ComparedFace;
pub use lips::LipPair;
pub use markers::{MarkerCorrelation, marker_correlation, median_correlation};
pub use measures::{Measures, measures};
pub use motion::FaceMotion;
pub use same_but_method::{
    ClipDifference, ComparisonError, Disagreement, StudyComparison, Unlike, compare_clips,
};
