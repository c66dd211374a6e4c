//! Weights over time: as a table and its file, recorded elsewhere, stored in steps.

mod file;
mod recorded;
mod steps;

pub use file::{Performance, PerformanceError, read_performance, weights_for_file};
pub use recorded::{Driven, RecordedNames, RecordedWeights, WeightBeyondSense};
pub use steps::{WeightSteps, weight_steps};
