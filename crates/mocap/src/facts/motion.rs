//! Swapped labels, jumps and frozen markers, from one frame to the next.

use crate::Capture;

/// Two markers whose labels change places.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Swap {
    /// The two labels.
    pub labels: [String; 2],
    /// First frame after the change, 0 = the first of the capture.
    pub frame: usize,
}

/// A marker that is suddenly elsewhere.
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
/// Step that may be half of a swap, metres: markers stand hardly closer than 3 mm.
const SWAP_M: f64 = 0.003;
/// How many times larger than the steps around it, and than the other markers' step in the same
/// frame, a sudden step is.
const SUDDEN: f64 = 5.0;

/// Swaps, and the jumps that are no swaps, in order of time.
pub(crate) fn swaps_and_jumps(capture: &Capture) -> (Vec<Swap>, Vec<Jump>) {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let metres = capture.unit.metres();
    let at = |frame: usize, marker: usize| capture.frame(frame)[marker];
    let step = |frame: usize, marker: usize| distance(at(frame - 1, marker), at(frame, marker));
    let (mut swaps, mut jumps) = (Vec::new(), Vec::new());
    let mut steps = Vec::with_capacity(markers);
    for frame in 1..frames {
        steps.clear();
        steps.extend((0..markers).map(|m| step(frame, m)).filter(|s| !s.is_nan()));
        if steps.iter().all(|s| s * metres < SWAP_M) {
            continue;
        }
        steps.sort_by(f64::total_cmp);
        let usual = steps[steps.len() / 2];
        // Steps around this one; NaN (a gap, an end) does not count.
        let around = |m: usize| {
            let before = if frame >= 2 { step(frame - 1, m) } else { f64::NAN };
            let after = if frame + 1 < frames { step(frame + 1, m) } else { f64::NAN };
            let smaller = before.min(after);
            if smaller.is_nan() { 0.0 } else { smaller }
        };
        let mut sudden: Vec<(usize, f64)> = (0..markers)
            .map(|m| (m, step(frame, m)))
            .filter(|(m, s)| s * metres >= SWAP_M && *s > SUDDEN * usual.max(around(*m)))
            .collect();
        let mut first = 0;
        while first < sudden.len() {
            let (a, step_a) = sudden[first];
            let partner = sudden[first + 1..].iter().position(|&(b, step_b)| {
                let crossed = distance(at(frame - 1, a), at(frame, b))
                    + distance(at(frame - 1, b), at(frame, a));
                crossed < 0.25 * (step_a + step_b)
            });
            if let Some(partner) = partner {
                let (b, _) = sudden.remove(first + 1 + partner);
                sudden.remove(first);
                let labels = [a, b].map(|m| capture.labels[m].clone());
                swaps.push(Swap { labels, frame });
            } else {
                first += 1;
            }
        }
        jumps.extend(sudden.iter().filter(|(_, s)| s * metres >= JUMP_M).map(|(m, s)| Jump {
            label: capture.labels[*m].clone(),
            frame,
            distance_m: s * metres,
        }));
    }
    (swaps, jumps)
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

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}
