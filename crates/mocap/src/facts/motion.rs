//! Swapped labels, jumps and frozen markers, from one frame to the next.

use crate::Capture;
use crate::repair::{Swap, swaps_and_others};

/// A marker that is elsewhere from one frame to the next.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Jump {
    /// Label of the marker.
    pub label: String,
    /// First frame after the jump, 0 = the first of the capture.
    pub frame: usize,
    /// How far, metres.
    pub distance_m: f64,
}

/// A marker that does not move at all while others do.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Frozen {
    /// Label of the marker.
    pub label: String,
    /// First frame of the stretch, 0 = the first of the capture.
    pub first: usize,
    /// First frame after it.
    pub end: usize,
}

/// Step that counts as a jump, metres: faces do 1 m/s at most, 10 mm a frame at 100 Hz.
const JUMP_M: f64 = 0.010;

/// Swaps, and the jumps that are no swaps, in order of time.
pub(crate) fn swaps_and_jumps(capture: &Capture) -> (Vec<Swap>, Vec<Jump>) {
    let metres = capture.unit.metres();
    let (swaps, others) = swaps_and_others(capture);
    let name = |marker: usize| capture.labels[marker].clone();
    let swaps = swaps.into_iter().map(|change| Swap {
        labels: change.cycle.into_iter().map(name).collect(),
        frame: change.frame,
    });
    let jumps = others.iter().filter(|(_, s)| s.step * metres >= JUMP_M).map(|(frame, s)| Jump {
        label: name(s.marker),
        frame: *frame,
        distance_m: s.step * metres,
    });
    (swaps.collect(), jumps.collect())
}

/// Stretches of at least a tenth of a second (and five frames) in which a marker has the same
/// coordinates to the last bit while at least half of the other markers move.
pub(crate) fn frozen(capture: &Capture) -> Vec<Frozen> {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let shortest = ((0.1 * capture.rate_hz).ceil() as usize).max(5);
    let still: Vec<usize> = (0..frames)
        .map(|f| {
            let pairs = capture.frame(f.saturating_sub(1)).iter().zip(capture.frame(f));
            if f == 0 { 0 } else { pairs.filter(|(p, q)| p == q).count() }
        })
        .collect();
    let mut found = Vec::new();
    for marker in 0..markers {
        let mut first = 0;
        for frame in 1..=frames {
            let same = frame < frames
                && capture.frame(frame)[marker] == capture.frame(frame - 1)[marker]
                && still.get(frame).is_some_and(|still| 2 * still <= markers + 1);
            if !same {
                if frame - first >= shortest {
                    let label = capture.labels[marker].clone();
                    found.push(Frozen { label, first, end: frame });
                }
                first = frame;
            }
        }
    }
    found
}
