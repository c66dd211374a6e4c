//! Curves of exertion learnt from people: support vector regression from a body's state to a face's
//! weights (Boukhalfi 2012, 3.3.2).
//!
//! ```text
//! LessonTake (plan, heart, weights) --Lesson--> rows, targets --Grid--> C, gamma --train--> model file
//! ```
//!
//! The solver is [`mimique_stats::SupportVectorDual`]; the optimality conditions of each answer are computed again here.
//! Training runs natively only; predictions are [`mimique_exertion::SupportVectors`], the same in the browser.
//!
//! # Example
//!
//! ```
//! use mimique_exertion_training::EpsilonSvr;
//!
//! // A line of slope 2 between 0 and 1, forgiven by half: the flattest line in the tube.
//! let rows: [&[f64]; 3] = [&[0.0], &[0.5], &[1.0]];
//! let svr = EpsilonSvr { c: 1e4, gamma: 0.1, epsilon: 0.1, tolerance: 1e-6 };
//! let fitted = svr.fit(&rows, &[0.0, 1.0, 2.0])?;
//! assert!(fitted.violation < 1e-5);
//! assert!(fitted.coefficients.iter().sum::<f64>().abs() < 1e-6);
//! # Ok::<(), mimique_exertion_training::TrainingError>(())
//! ```

pub mod cross_validation;
mod error;
mod lesson;
mod regression;
mod search;
mod train;

pub use error::TrainingError;
pub use lesson::{Lesson, LessonTake, Pupil};
pub use regression::{EpsilonSvr, Fitted, ROWS};
pub use search::{Best, Grid};
pub use train::{LearntCurve, Trained, train};
