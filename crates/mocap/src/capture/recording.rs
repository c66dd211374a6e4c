//! A capture together with what else its file said.

use crate::{Capture, Format};

/// A named instant of a recording.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Event {
    /// What happened, in the file's words.
    pub label: String,
    /// Seconds in the file's own clock.
    pub time_s: f64,
}

/// A capture, the format it came in and what the recording system said about itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The markers.
    pub capture: Capture,
    /// Format of the file.
    pub format: &'static Format,
    /// The recording system in the file's words, e.g. `Qualisys Track Manager 2.17`.
    pub system: Option<String>,
    /// Analog channels in the file (read past, not kept).
    pub analog_channels: usize,
    /// Named instants.
    pub events: Vec<Event>,
}
