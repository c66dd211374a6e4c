//! The study: its file, its order of trials, its flow as a state machine, its responses. Pure.

pub mod wire;
