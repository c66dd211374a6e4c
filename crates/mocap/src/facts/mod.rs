//! What a capture holds and what looks wrong with it.

mod motion;
mod neutral;

use crate::capture::unit;
use crate::repair::{Swap, gaps};
use crate::{Event, LengthUnit, Recording};

pub use motion::{Frozen, Jump};
pub use neutral::{Stillest, stillest};

/// Facts of a capture, to be printed or serialised.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct CaptureFacts {
    /// Format of the file.
    pub format: &'static str,
    /// Recording system, in the file's words.
    pub system: Option<String>,
    /// Frames per second.
    pub rate_hz: f64,
    /// Unit of the coordinates.
    pub unit: LengthUnit,
    /// Number of markers.
    pub markers: usize,
    /// Number of frames.
    pub frames: usize,
    /// Number of the first frame in the file.
    pub first_frame: u64,
    /// Seconds from the first frame to the end of the last.
    pub duration_s: f64,
    /// Median diagonal of the box around all markers, metres.
    pub extent_m: Option<f64>,
    /// Analog channels in the file.
    pub analog_channels: usize,
    /// Named instants.
    pub events: Vec<Event>,
    /// Presence of every marker, in the file's order.
    pub presence: Vec<MarkerPresence>,
    /// Labels that change places between two frames.
    pub swaps: Vec<Swap>,
    /// Markers that jump.
    pub jumps: Vec<Jump>,
    /// Markers that stand exactly still while others move.
    pub frozen: Vec<Frozen>,
    /// The stillest second: the neutral, when none is named.
    pub stillest: Option<Stillest>,
    /// What the reader said.
    pub notes: Vec<String>,
    /// What looks wrong, in sentences.
    pub warnings: Vec<String>,
}

/// How much of a marker is there.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct MarkerPresence {
    /// Label of the marker.
    pub label: String,
    /// Frames in which it is present.
    pub present: usize,
    /// Number of gaps.
    pub gaps: usize,
    /// Frames of the longest gap.
    pub longest_gap: usize,
}

impl CaptureFacts {
    /// Gather the facts of a recording.
    pub fn of(recording: &Recording) -> Self {
        let capture = &recording.capture;
        let (frames, markers) = (capture.frames(), capture.labels.len());
        let mut presence: Vec<MarkerPresence> = capture
            .labels
            .iter()
            .map(|label| MarkerPresence {
                label: label.clone(),
                present: frames,
                gaps: 0,
                longest_gap: 0,
            })
            .collect();
        for gap in gaps(capture) {
            let of = &mut presence[gap.marker];
            of.present -= gap.frames();
            of.gaps += 1;
            of.longest_gap = of.longest_gap.max(gap.frames());
        }
        let (swaps, jumps) = motion::swaps_and_jumps(capture);
        let mut facts = Self {
            format: recording.format.name,
            system: recording.system.clone(),
            rate_hz: capture.rate_hz,
            unit: capture.unit,
            markers,
            frames,
            first_frame: capture.first_frame,
            duration_s: frames as f64 / capture.rate_hz,
            extent_m: unit::marker_extent(&capture.positions, markers)
                .map(|extent| extent * capture.unit.metres()),
            analog_channels: recording.analog_channels,
            events: recording.events.clone(),
            presence,
            swaps,
            jumps,
            frozen: motion::frozen(capture),
            stillest: stillest(capture, 1.0),
            notes: capture.notes.clone(),
            warnings: Vec::new(),
        };
        facts.warnings = facts.what_looks_wrong();
        facts
    }

    fn what_looks_wrong(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if let Some(extent) = self.extent_m {
            // A face's markers span 4 to 40 cm; half and half again leave room for few and many.
            if !(0.03..0.6).contains(&extent) {
                let in_file = extent / self.unit.metres();
                let likely = unit::unit_of_face_extent(in_file);
                let fits = (0.03..0.6).contains(&(in_file * likely.metres()));
                warnings.push(if fits && likely != self.unit {
                    format!(
                        "the markers span {extent:.3} m, not a face: the unit may be {} rather than {}",
                        likely.symbol(),
                        self.unit.symbol()
                    )
                } else {
                    format!("the markers span {extent:.3} m, more or less than a face")
                });
            }
        }
        // From the slowest cameras to the fastest of capture systems.
        if !(5.0..=2000.0).contains(&self.rate_hz) {
            warnings
                .push(format!("{} frames per second: no usual rate of a capture", self.rate_hz));
        }
        for marker in self.presence.iter().filter(|m| m.present == 0) {
            warnings.push(format!("{} is missing in every frame", marker.label));
        }
        for Swap { labels, frame } in &self.swaps {
            warnings.push(format!("{} change places at frame {frame}", labels.join(" and ")));
        }
        for Jump { label, frame, distance_m } in &self.jumps {
            warnings.push(format!("{label} jumps {:.1} mm at frame {frame}", distance_m * 1e3));
        }
        for Frozen { label, first, end } in &self.frozen {
            warnings.push(format!("{label} stands exactly still in frames {first} to {}", end - 1));
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Capture;
    use mimique_geometry::Point;

    /// Five face markers that all sway; 200 frames at 100 Hz, millimetres.
    fn recording() -> Recording {
        let rest = [
            [0.0, 0.0, 0.0],
            [60.0, 0.0, 0.0],
            [0.0, 90.0, 0.0],
            [55.0, 80.0, 9.0],
            [30.0, 40.0, 30.0],
        ];
        let positions = (0..200)
            .flat_map(|f| {
                let t = f64::from(f) / 100.0;
                rest.map(|[x, y, z]| {
                    Point::new(x + 5.0 * (3.0 * t).sin(), y + 4.0 * (2.0 * t).cos(), z + 1500.0)
                })
            })
            .collect();
        Recording {
            capture: Capture {
                labels: (0..5).map(|m| format!("m{m}")).collect(),
                rate_hz: 100.0,
                first_frame: 0,
                unit: LengthUnit::Millimetre,
                positions,
                notes: Vec::new(),
            },
            format: &crate::WIDE_CSV,
            system: None,
            analog_channels: 0,
            events: Vec::new(),
        }
    }

    #[test]
    fn a_clean_take_has_no_warning() {
        let facts = CaptureFacts::of(&recording());
        assert_eq!(facts.warnings, Vec::<String>::new());
        assert_eq!((facts.markers, facts.frames, facts.duration_s), (5, 200, 2.0));
        assert!(facts.extent_m.is_some_and(|e| (e - 0.109).abs() < 0.005), "{:?}", facts.extent_m);
    }

    #[test]
    fn planted_faults_are_found_where_they_are() {
        let mut faulty = recording();
        let positions = &mut faulty.capture.positions;
        for frame in 50..80 {
            positions.swap(5 * frame, 5 * frame + 4);
        }
        positions[5 * 120 + 2][1] += 25.0;
        for frame in 140..170 {
            positions[5 * frame + 3] = positions[5 * 140 + 3];
        }
        for frame in 10..14 {
            positions[5 * frame + 1] = Point::UNSEEN;
        }
        let facts = CaptureFacts::of(&faulty);
        let frames: Vec<usize> = facts.swaps.iter().map(|s| s.frame).collect();
        assert_eq!(frames, [50, 80]);
        assert_eq!(facts.swaps[0].labels, ["m0", "m4"]);
        let jumps: Vec<_> = facts.jumps.iter().map(|j| (j.label.as_str(), j.frame)).collect();
        assert_eq!(jumps, [("m2", 120), ("m2", 121)]);
        assert!((facts.jumps[0].distance_m - 0.025).abs() < 0.002);
        assert_eq!(facts.frozen, [Frozen { label: "m3".to_owned(), first: 140, end: 170 }]);
        let gap = &facts.presence[1];
        assert_eq!((gap.present, gap.gaps, gap.longest_gap), (196, 1, 4));
    }

    #[test]
    fn a_wrong_unit_is_named() {
        let mut wrong = recording();
        wrong.capture.unit = LengthUnit::Metre;
        assert!(
            CaptureFacts::of(&wrong).warnings[0]
                .ends_with("not a face: the unit may be mm rather than m")
        );
    }
}
