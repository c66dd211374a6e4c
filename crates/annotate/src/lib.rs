//! Labels of facial motion: numbers and intervals in, labels out.
//!
//! ```text
//! weights --Take--> stretches, features --+
//! intervals --Vocabulary--> Marked -------+--Lesson--> Model --label--> Answer
//!                                                        |               |
//!                                                      JSON          evaluate <-- Marked
//! ```
//!
//! Nothing here knows files, clocks or how many threads there are: what is random comes from ChaCha
//! streams of a seed, sums are added in one order, exponentials and logarithms are `libm`'s. Errors
//! are codes with values ([`AnnotateError`]).
//!
//! | source | here |
//! |---|---|
//! | thesis 4.4, 4.5: energies and borders | [`Segmentation`] |
//! | thesis 4.6: mean of a segment | [`features`] |
//! | thesis 4.5: neighbours, support vector machines, forest | [`Neighbours`], [`Svm`], [`Forest`] |
//! | short paper 6-8: a hidden Markov model a label, joined | [`Composite`] |
//!
//! The classifiers and hidden Markov models are our own (the support vector machine's solver is
//! [`mimique_stats::SupportVectorDual`]), because no maintained crate fits: linfa 0.8 does
//! not build for wasm32 as it is, draws a forest's columns per tree and has support vector machines one
//! against all; smartcore 0.7 has an approximate support vector machine, and its saved models break between
//! versions; of the crates for hidden Markov models none has mixtures without LAPACK.
//!
//! # Example
//!
//! A smile of two seconds is learnt from one take and found in another:
//!
//! ```
//! use mimique_annotate::{AnnotatedTake, Decode, Decoding, Lesson, Mark, Marked, Method, Take};
//!
//! // Weights of one shape at 30 Hz: two seconds of neutral, two of a smile.
//! let smile = |height: f64| {
//!     let values = (0..120).map(|frame| if frame < 60 { 0.02 } else { height }).collect();
//!     Take::new(values, 1, 30.0)
//! };
//! let annotated = AnnotatedTake {
//!     name: "first".to_owned(),
//!     person: "a".to_owned(),
//!     kind: "posed".to_owned(),
//!     take: smile(0.8)?,
//!     marked: vec![
//!         Marked { frames: 0..60, mark: Mark::Stable(0) },
//!         Marked { frames: 60..120, mark: Mark::Stable(1) },
//!     ],
//! };
//! let lesson = Lesson {
//!     channel: "affect".to_owned(),
//!     labels: vec!["neutral".to_owned(), "joy".to_owned()],
//!     shapes: vec!["mouthSmile".to_owned()],
//!     method: Method::Knn { k: 3 },
//!     thinned_to_hz: Some(10.0),
//!     decoding: Decoding::default(),
//! };
//! let model = lesson.learn(&[annotated])?;
//! let answer = model.label(&smile(0.7)?, &Decode::default())?;
//! let found: Vec<_> = answer.segments.iter().map(|s| (s.frames.clone(), s.label)).collect();
//! assert_eq!(found, [(0..60, 0), (60..120, 1)]);
//! # Ok::<(), mimique_annotate::AnnotateError>(())
//! ```

pub mod calibration;
mod error;
pub mod evaluate;
pub mod features;
mod forest;
mod hmm;
mod kernel;
mod label_path;
pub mod labels;
mod logistic;
mod mixture;
mod model;
mod neighbours;
mod numbers;
mod one_against_one;
mod rows;
pub mod stretches;
mod take;
mod tiles;
mod tree;

pub use calibration::Temperature;
pub use error::AnnotateError;
pub use forest::{Forest, ForestOptions};
pub use hmm::{BaumWelch, Beginning, BestPath, Composite, Hmm, Learnt, Posterior, Topology};
pub use kernel::Kernel;
pub use label_path::{LabelPath, Run, runs};
pub use labels::{Mark, Marked, ReadMarks, Vocabulary};
pub use logistic::{Logistic, LogisticOptions};
pub use mixture::Mixture;
pub use model::{
    AnnotatedTake, Answer, Classifier, Decode, Decoding, HmmOptions, Isolation, LARGEST,
    LearntFrom, LearntLabel, LearntTake, Lesson, Method, Model, Suggested, VERSION, columns,
};
pub use neighbours::{Neighbours, Vote};
pub use one_against_one::{Pair, Svm, SvmOptions};
pub use rows::{ClassWeight, Examples, Rows};
pub use stretches::Segmentation;
pub use take::{CUTOFF_HZ, Take};
pub use tree::Tree;
