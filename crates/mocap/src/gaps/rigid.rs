//! Long gaps: the marker rides on the rigid motion of its nearest neighbours, from the frame before
//! the gap and from the frame after it, and passes from one to the other.

use super::Gap;
use crate::Capture;
use crate::rigid_fit::rigid_from_to;

/// Neighbours that carry the marker: more than three, so that one that moves by itself is outvoted.
const NEIGHBOURS: usize = 5;

/// Positions inside the gap; `None` where fewer than three neighbours are there throughout it. The
/// frames before and after the gap must be present.
pub(crate) fn fill(capture: &Capture, gap: Gap) -> Option<Vec<[f64; 3]>> {
    let (before, after) = (gap.first - 1, gap.end);
    let start = capture.frame(before)[gap.marker];
    let finish = capture.frame(after)[gap.marker];
    let mut candidates: Vec<(f64, usize)> = (0..capture.labels.len())
        .filter(|&m| m != gap.marker)
        .filter(|&m| (before..=after).all(|f| !capture.frame(f)[m][0].is_nan()))
        .map(|m| (squared_distance(capture.frame(before)[m], start), m))
        .collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    candidates.truncate(NEIGHBOURS);
    if candidates.len() < 3 {
        return None;
    }
    let carriers =
        |frame: usize| candidates.iter().map(|(_, m)| capture.frame(frame)[*m]).collect::<Vec<_>>();
    let (carriers_before, carriers_after) = (carriers(before), carriers(after));
    let span = (after - before) as f64;
    (gap.first..gap.end)
        .map(|frame| {
            let now = carriers(frame);
            let a = rigid_from_to(&carriers_before, &now)?.apply(start);
            let b = rigid_from_to(&carriers_after, &now)?.apply(finish);
            let t = (frame - before) as f64 / span;
            Some([0, 1, 2].map(|k| a[k] + t * (b[k] - a[k])))
        })
        .collect()
}

fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
}
