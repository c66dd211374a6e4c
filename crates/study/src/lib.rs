//! The study: its file, its order of trials, its flow as a state machine, its responses. Pure.

mod study_file;
pub mod wire;

pub use study_file::*;
