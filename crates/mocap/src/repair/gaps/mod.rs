//! Gaps of markers: found, reported, filled.

mod rigid;
mod spline;

use crate::Capture;
use mimique_geometry::Point;
use std::ops::Range;

/// A stretch of frames in which a marker is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Gap {
    /// Index of the marker.
    pub marker: usize,
    /// First missing frame, 0 = the first of the capture.
    pub first: usize,
    /// First frame after the gap.
    pub end: usize,
}

impl Gap {
    /// Frames missing.
    pub fn frames(&self) -> usize {
        self.end - self.first
    }
}

/// All gaps, marker by marker, in order of time.
pub fn gaps(capture: &Capture) -> Vec<Gap> {
    let frames = capture.frames();
    (0..capture.labels.len())
        .flat_map(|marker| {
            let mut from = 0;
            let mut found = Vec::new();
            for stretch in stretches(capture, marker) {
                if stretch.start > from {
                    found.push(Gap { marker, first: from, end: stretch.start });
                }
                from = stretch.end;
            }
            if from < frames {
                found.push(Gap { marker, first: from, end: frames });
            }
            found
        })
        .collect()
}

/// The stretches of frames in which a marker is present.
pub(crate) fn stretches(capture: &Capture, marker: usize) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for frame in 0..capture.frames() {
        match (capture.frame(frame)[marker][0].is_nan(), start) {
            (false, None) => start = Some(frame),
            (true, Some(from)) => {
                found.push(from..frame);
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|from| from..capture.frames()));
    found
}

/// How a gap was filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GapRepair {
    /// By a cubic between its ends.
    Spline,
    /// By the rigid motion of its neighbours.
    RigidNeighbourhood,
    /// Not: it stays missing.
    LeftMissing,
}

/// What was done about one gap.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FilledGap {
    /// The gap.
    #[serde(flatten)]
    pub gap: Gap,
    /// How it was filled.
    pub repair: GapRepair,
}

/// How far gaps are filled.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GapFill {
    /// Longest gap filled by a spline, seconds.
    pub spline_s: f64,
    /// Longest gap filled by the rigid motion of the neighbours, seconds.
    pub rigid_s: f64,
}

impl Default for GapFill {
    /// A tenth of a second by spline (expressions begin and end slower), one second by the
    /// neighbours.
    fn default() -> Self {
        Self { spline_s: 0.1, rigid_s: 1.0 }
    }
}

/// Positions for a gap, and how they were found.
type Filling = (Vec<Point>, GapRepair);

/// Fill gaps in place: short ones by a cubic, longer ones by the rigid motion of the neighbours,
/// others stay missing, as do those at the ends of the take. Returns every gap and what was done.
pub fn fill_gaps(capture: &mut Capture, how: &GapFill) -> Vec<FilledGap> {
    // Neighbours are taken as measured: no filled position serves to fill another.
    let measured = &*capture;
    let frames = measured.frames();
    let found: Vec<(Gap, Option<Filling>)> = gaps(measured)
        .into_iter()
        .map(|gap| {
            let seconds = gap.frames() as f64 / measured.rate_hz;
            let inside = gap.first > 0 && gap.end < frames;
            // Half a frame of slack: a gap of exactly the stated length counts.
            let half_frame = 0.5 / measured.rate_hz;
            let filled = if !inside {
                None
            } else if seconds <= how.spline_s + half_frame {
                Some((spline::fill(measured, gap), GapRepair::Spline))
            } else if seconds <= how.rigid_s + half_frame {
                rigid::fill(measured, gap).map(|p| (p, GapRepair::RigidNeighbourhood))
            } else {
                None
            };
            (gap, filled)
        })
        .collect();
    found
        .into_iter()
        .map(|(gap, filled)| {
            let Some((positions, repair)) = filled else {
                return FilledGap { gap, repair: GapRepair::LeftMissing };
            };
            let markers = capture.labels.len();
            for (frame, p) in (gap.first..gap.end).zip(positions) {
                capture.positions[frame * markers + gap.marker] = p;
            }
            FilledGap { gap, repair }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LengthUnit;

    /// Six markers on a head that turns and moves; marker 5 also rises slowly by itself.
    fn moving_head(frames: usize) -> Capture {
        let shape = [
            [0.0, 0.0, 0.0],
            [80.0, 5.0, -10.0],
            [-75.0, 0.0, -12.0],
            [5.0, 60.0, -20.0],
            [0.0, -55.0, 3.0],
            [30.0, 20.0, 8.0],
        ];
        let positions = (0..frames)
            .flat_map(|f| {
                let t = f as f64 / 100.0;
                let (s, c) = (0.4 * (2.0 * t).sin()).sin_cos();
                shape
                    .iter()
                    .enumerate()
                    .map(move |(m, p)| {
                        let lift = if m == 5 { t } else { 0.0 };
                        Point::new(
                            c * p[0] + s * p[2] + 20.0 * t,
                            p[1] + lift + 5.0 * t * t,
                            c * p[2] - s * p[0],
                        )
                    })
                    .collect::<Vec<_>>()
            })
            .collect();
        Capture {
            labels: (0..6).map(|m| format!("m{m}")).collect(),
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions,
            notes: Vec::new(),
        }
    }

    fn with_gap(mut capture: Capture, marker: usize, frames: Range<usize>) -> Capture {
        for frame in frames {
            capture.positions[frame * 6 + marker] = Point::UNSEEN;
        }
        capture
    }

    fn largest_error(a: &Capture, b: &Capture) -> f64 {
        let pairs = a.positions.iter().zip(&b.positions);
        pairs.map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max)
    }

    #[test]
    fn planted_motion_is_recovered_by_both_repairs() {
        let truth = moving_head(200);
        let mut capture = with_gap(with_gap(truth.clone(), 2, 40..50), 5, 80..170);
        let report = fill_gaps(&mut capture, &GapFill::default());
        let gap = |marker, first, end| Gap { marker, first, end };
        assert_eq!(
            report,
            [
                FilledGap { gap: gap(2, 40, 50), repair: GapRepair::Spline },
                FilledGap { gap: gap(5, 80, 170), repair: GapRepair::RigidNeighbourhood },
            ]
        );
        let error = largest_error(&capture, &truth);
        assert!(error < 0.1, "{error} mm");
        assert!(gaps(&capture).is_empty());
    }

    #[test]
    fn gaps_at_the_ends_and_too_long_ones_stay() {
        let mut capture = with_gap(moving_head(300), 0, 0..3);
        capture = with_gap(capture, 1, 100..250);
        capture = with_gap(capture, 3, 290..300);
        let before = gaps(&capture);
        let report = fill_gaps(&mut capture, &GapFill::default());
        assert!(report.iter().all(|f| f.repair == GapRepair::LeftMissing));
        assert_eq!((gaps(&capture), before.len()), (before, 3));
    }

    #[test]
    fn without_enough_neighbours_a_long_gap_stays() {
        let mut capture = moving_head(100);
        for marker in 1..5 {
            capture = with_gap(capture, marker, 30..31);
        }
        capture = with_gap(capture, 5, 20..60);
        let report = fill_gaps(&mut capture, &GapFill::default());
        assert_eq!(report.last().map(|f| f.repair), Some(GapRepair::LeftMissing));
    }
}
