//! Moves that no face makes from one frame to the next: the raw material of swaps, spikes, jumps.

use mimique_geometry::Point;

use crate::Capture;

/// Step that may be half of a swap or the edge of a spike, metres: markers stand hardly closer than
/// 3 mm, and sensors are ten times more exact.
pub(crate) const ABRUPT_STEP_M: f64 = 0.003;
/// How many times larger than the marker's steps around it, and than the other markers' step in
/// the same frame, an abrupt step is.
const TIMES: f64 = 5.0;
/// Seconds over which a marker that was missing is still compared with where it was.
pub(crate) const MEMORY_S: f64 = 0.25;

/// A marker that is elsewhere from one frame to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AbruptStep {
    /// Index of the marker.
    pub(crate) marker: usize,
    /// Where it was last.
    pub(crate) from: Point,
    /// Where it is.
    pub(crate) to: Point,
    /// How far that is, in the capture's unit.
    pub(crate) step: f64,
}

/// Calls `found` with every frame that has abrupt steps, and with them, in order of time.
pub(crate) fn each_abrupt_step(capture: &Capture, mut found: impl FnMut(usize, &[AbruptStep])) {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let least = ABRUPT_STEP_M / capture.unit.metres();
    let memory = ((MEMORY_S * capture.rate_hz) as usize).max(1);
    // The frame in which each marker was seen last, before the present one.
    let mut last: Vec<Option<usize>> = vec![None; markers];
    let mut abrupt = Vec::new();
    let mut steps = Vec::with_capacity(markers);
    for frame in 0..frames {
        let now = capture.frame(frame);
        abrupt.clear();
        for (marker, &to) in now.iter().enumerate() {
            let Some(before) = last[marker].filter(|l| frame - l <= memory) else { continue };
            let from = capture.frame(before)[marker];
            let step = distance(from, to);
            if step >= least {
                abrupt.push(AbruptStep { marker, from, to, step });
            }
        }
        if !abrupt.is_empty() {
            let usual = usual_step(capture, frame, &mut steps);
            abrupt.retain(|s| {
                let elapsed = last[s.marker].map_or(1, |l| frame - l) as f64;
                let around = step_around(capture, s.marker, last[s.marker].unwrap_or(0), frame);
                s.step > TIMES * elapsed * usual.max(around)
            });
            if !abrupt.is_empty() {
                found(frame, &abrupt);
            }
        }
        for (last, p) in last.iter_mut().zip(now) {
            if p.is_seen() {
                *last = Some(frame);
            }
        }
    }
}

/// Median step of the markers from the frame before; 0 where none is seen in both.
pub(crate) fn usual_step(capture: &Capture, frame: usize, steps: &mut Vec<f64>) -> f64 {
    steps.clear();
    if frame > 0 {
        let pairs = capture.frame(frame - 1).iter().zip(capture.frame(frame));
        steps.extend(pairs.map(|(p, q)| distance(*p, *q)).filter(|s| !s.is_nan()));
    }
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The smaller of a marker's steps into frame `before` and out of frame `after`; 0 where neither
/// is known.
pub(crate) fn step_around(capture: &Capture, marker: usize, before: usize, after: usize) -> f64 {
    let at = |frame: usize| capture.frame(frame)[marker];
    let into = if before > 0 { distance(at(before - 1), at(before)) } else { f64::NAN };
    let out =
        if after + 1 < capture.frames() { distance(at(after), at(after + 1)) } else { f64::NAN };
    let smaller = into.min(out);
    if smaller.is_nan() { 0.0 } else { smaller }
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a - b).length()
}
