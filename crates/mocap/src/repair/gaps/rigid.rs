//! Long gaps: the marker rides on the rigid motion of its nearest neighbours, from the frame before
//! the gap and from the frame after it, and passes from one to the other.

use mimique_geometry::{Point, pose_between};

use super::Gap;
use crate::Capture;

/// Neighbours that carry the marker: more than three, so that one that moves by itself is outvoted.
const NEIGHBOURS: usize = 5;

/// Positions inside the gap; `None` where fewer than three neighbours are there throughout it. The
/// frames before and after the gap must be present.
pub(crate) fn fill(capture: &Capture, gap: Gap) -> Option<Vec<Point>> {
    let (before, after) = (gap.first - 1, gap.end);
    let start = capture.frame(before)[gap.marker];
    let finish = capture.frame(after)[gap.marker];
    let mut candidates: Vec<(f64, usize)> = (0..capture.labels.len())
        .filter(|&m| m != gap.marker)
        .filter(|&m| (before..=after).all(|f| capture.frame(f)[m].is_seen()))
        .map(|m| ((capture.frame(before)[m] - start).length_squared(), m))
        .collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    candidates.truncate(NEIGHBOURS);
    if candidates.len() < 3 {
        return None;
    }
    let carriers = |frame: usize| candidates.iter().map(move |(_, m)| capture.frame(frame)[*m]);
    let carried = |from: usize, to: usize, point: Point| -> Option<Point> {
        Some(pose_between(carriers(from).zip(carriers(to))).ok()?.motion().apply(point))
    };
    let span = (after - before) as f64;
    (gap.first..gap.end)
        .map(|frame| {
            let a = carried(before, frame, start)?;
            let b = carried(after, frame, finish)?;
            Some(a + (b - a) * ((frame - before) as f64 / span))
        })
        .collect()
}
