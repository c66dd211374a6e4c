//! The gaze of a performance, given beside its markers: no marker on skin tells where the eyes look.

mod given;
mod track;

pub use given::GivenGaze;
pub use track::{GazeTrack, GazeTrackError};
