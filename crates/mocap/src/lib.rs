//! Marker trajectories: the capture vocabulary, readers and writers, repair and filters.

mod capture;

pub use capture::{Capture, LengthUnit};
