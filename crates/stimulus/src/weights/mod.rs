//! Weights over time: as a table and its file, recorded elsewhere, stored in steps.

mod recorded;
mod steps;

pub use recorded::{Driven, RecordedNames, RecordedWeights, WeightBeyondSense};
pub use steps::{WeightSteps, weight_steps};
