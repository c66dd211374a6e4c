//! Spikes: a marker that is elsewhere for an instant and comes back.

use std::ops::Range;

use super::abrupt_steps::{ABRUPT_STEP_M, MEMORY_S, distance, step_around, usual_step};
use crate::Capture;

/// A marker that leaves its place for an instant.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Spike {
    /// Label of the marker.
    pub label: String,
    /// First frame elsewhere, 0 = the first of the capture.
    pub first: usize,
    /// First frame after it.
    pub end: usize,
    /// How far it was off the line between the frames before and after, metres.
    pub distance_m: f64,
}

/// Longest spike, seconds: a twitch of the face takes longer.
const LONGEST_S: f64 = 0.05;
/// How many times larger than usual both edges are.
const TIMES: f64 = 5.0;

/// All spikes, marker by marker, in order of time.
pub(crate) fn find_spikes(capture: &Capture) -> Vec<(usize, Spike)> {
    let frames = capture.frames();
    let memory = memory(capture);
    let mut steps = Vec::with_capacity(capture.labels.len());
    let mut found = Vec::new();
    for marker in 0..capture.labels.len() {
        // The frame before `first` in which the marker is seen.
        let mut before: Option<usize> = None;
        let mut first = 0;
        while first < frames {
            if capture.frame(first)[marker][0].is_nan() {
                first += 1;
                continue;
            }
            let from = before.filter(|b| first - b <= memory);
            before = Some(first);
            let jump = from.and_then(|from| excursion(capture, marker, from, first, &mut steps));
            let Some(Excursion { from, end, after }) = jump else {
                first += 1;
                continue;
            };
            let distance_m = farthest(capture, marker, from, first..end, after);
            let label = capture.labels[marker].clone();
            found.push((marker, Spike { label, first, end, distance_m }));
            // The place before the spike is the one to compare with after it.
            before = Some(from);
            first = end;
        }
    }
    found
}

/// The frames about a spike.
struct Excursion {
    /// The last frame before it in which the marker is seen.
    from: usize,
    /// The first frame after it.
    end: usize,
    /// The first frame after it in which the marker is seen.
    after: usize,
}

/// Frames over which a marker's place is remembered.
fn memory(capture: &Capture) -> usize {
    ((MEMORY_S * capture.rate_hz) as usize).max(1)
}

/// The spike that begins in frame `first`, if the marker leaves its place of frame `from` there and
/// comes back.
fn excursion(
    capture: &Capture,
    marker: usize,
    from: usize,
    first: usize,
    steps: &mut Vec<f64>,
) -> Option<Excursion> {
    let frames = capture.frames();
    let least = ABRUPT_STEP_M / capture.unit.metres();
    let at = |frame: usize| capture.frame(frame)[marker];
    let entry = distance(at(from), at(first));
    // Cheap first: nearly every frame ends here.
    if entry < least {
        return None;
    }
    let usual = usual_step(capture, first, steps);
    let calm = step_into(capture, marker, from).max(usual);
    if entry <= TIMES * calm * (first - from) as f64 {
        return None;
    }
    let longest = ((LONGEST_S * capture.rate_hz).round() as usize).max(1);
    let memory = memory(capture);
    (1..=longest).map(|n| first + n).find_map(|end| {
        let after = (end..frames.min(end + memory)).find(|&f| !at(f)[0].is_nan())?;
        let last = (first..end).rev().find(|&f| !at(f)[0].is_nan())?;
        let exit = distance(at(last), at(after));
        let usual_out = usual_step(capture, after, steps);
        let calm_out = step_out(capture, marker, after).max(usual_out);
        let back = distance(at(from), at(after));
        let elapsed = (after - from) as f64;
        let returns = back <= 0.3 * entry.min(exit) + elapsed * calm.max(calm_out);
        (exit >= least && exit > TIMES * calm_out && returns).then_some(Excursion {
            from,
            end,
            after,
        })
    })
}

/// How far the marker is off the line between the frames `from` and `after` at most, metres.
fn farthest(
    capture: &Capture,
    marker: usize,
    from: usize,
    frames: Range<usize>,
    after: usize,
) -> f64 {
    let at = |frame: usize| capture.frame(frame)[marker];
    let (p, q) = (at(from), at(after));
    let off = frames
        .map(|frame| {
            let t = (frame - from) as f64 / (after - from) as f64;
            distance(at(frame), p + (q - p) * t)
        })
        .fold(0.0, f64::max);
    off * capture.unit.metres()
}

/// The marker's step into a frame; 0 where it is not known.
fn step_into(capture: &Capture, marker: usize, frame: usize) -> f64 {
    step_around(capture, marker, frame, capture.frames())
}

/// The marker's step out of a frame; 0 where it is not known.
fn step_out(capture: &Capture, marker: usize, frame: usize) -> f64 {
    step_around(capture, marker, 0, frame)
}
