//! The vocabulary of captures: labelled marker trajectories at a rate.

use mimique_geometry::Point;

mod recording;
pub(crate) mod unit;
mod weights;

pub use recording::{Event, Recording};
pub(crate) use weights::ROTATIONS;
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

    /// Index of the marker of that label. Where none has it letter for letter, that of the only marker
    /// that has it but for a subject's name before a colon, on either side: `Actor:brow` is `brow`.
    pub fn marker_index(&self, label: &str) -> Option<usize> {
        marker_index(&self.labels, label)
    }
}

/// [`Capture::marker_index`] among some labels.
pub(crate) fn marker_index(labels: &[String], label: &str) -> Option<usize> {
    let exact = labels.iter().position(|l| l == label);
    exact.or_else(|| {
        let alike = |l: &str| without_subject(l) == label || l == without_subject(label);
        let mut found = labels.iter().enumerate().filter(|(_, l)| alike(l));
        let (index, _) = found.next()?;
        found.next().is_none().then_some(index)
    })
}

/// A label without the name of the subject that recording systems put before it.
fn without_subject(label: &str) -> &str {
    label.rsplit_once(':').map_or(label, |(_, own)| own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subject_before_a_label_is_looked_past_where_only_one_is_meant() {
        let labels = |labels: &[&str]| Capture {
            labels: labels.iter().map(ToString::to_string).collect(),
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Metre,
            positions: Vec::new(),
            notes: Vec::new(),
        };
        let one = labels(&["Actor:brow", "Actor:jaw", "jaw", "Actor:nose:tip"]);
        assert_eq!(one.marker_index("brow"), Some(0));
        assert_eq!(one.marker_index("Actor:brow"), Some(0));
        assert_eq!(one.marker_index("Other:brow"), None, "another subject's");
        assert_eq!(one.marker_index("jaw"), Some(2), "letter for letter first");
        assert_eq!(one.marker_index("tip"), Some(3));
        assert_eq!(labels(&["A:brow", "B:brow"]).marker_index("brow"), None, "which of the two?");
        assert_eq!(labels(&["brow"]).marker_index("A:brow"), Some(0), "the map has the subject");
    }
}
