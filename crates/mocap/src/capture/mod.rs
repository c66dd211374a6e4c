//! The vocabulary of captures: labelled marker trajectories at a rate.

use mimique_geometry::Point;

mod recording;
pub(crate) mod unit;
mod weights;

pub use recording::{Event, Recording};
pub use weights::{WeightOptions, WeightsTable};

/// A length unit a capture's coordinates are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum LengthUnit {
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metres.
    #[serde(rename = "m")]
    Metre,
}

impl LengthUnit {
    /// How many metres one of this unit is.
    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Metre => 1.0,
        }
    }
}

/// Marker trajectories. A missing marker is NaN in all three coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Capture {
    /// Marker labels, unique, in the file's order (P of them).
    pub labels: Vec<String>,
    /// Frames per second.
    pub rate_hz: f64,
    /// Number of the first frame in the file (QTM and Vicon do not start at 0).
    pub first_frame: u64,
    /// Unit of `positions`.
    pub unit: LengthUnit,
    /// Frame-major: `positions[frame * P + marker]` = x, y, z.
    pub positions: Vec<Point>,
    /// What the reader found worth saying (unit guessed, columns ignored...).
    pub notes: Vec<String>,
}

impl Capture {
    /// What a capture system delivers: frames from 0 on, nothing to note. `positions` frame-major,
    /// as many a frame as there are labels.
    pub fn new(
        labels: Vec<String>,
        rate_hz: f64,
        unit: LengthUnit,
        positions: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        let positions = positions.into_iter().map(Into::into).collect();
        Self { labels, rate_hz, first_frame: 0, unit, positions, notes: vec![] }
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        if self.labels.is_empty() { 0 } else { self.positions.len() / self.labels.len() }
    }

    /// Positions of all markers in one frame (0 = the first of the file).
    ///
    /// # Panics
    /// If `frame >= self.frames()`.
    pub fn frame(&self, frame: usize) -> &[Point] {
        let p = self.labels.len();
        &self.positions[frame * p..(frame + 1) * p]
    }

    /// Index of the marker of that label.
    pub fn marker_index(&self, label: &str) -> Option<usize> {
        self.labels.iter().position(|l| l == label)
    }
}
