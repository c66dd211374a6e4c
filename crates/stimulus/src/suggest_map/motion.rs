//! How much each marker moves on the face, the head's own motion taken out.

use mimique_geometry::{Point, RigidMotion, align_rigidly};
use mimique_mocap::Capture;

/// Frames looked at: enough to see every part of the face move.
const LOOKED_AT: usize = 240;

/// Root mean square way of each marker from its neutral place, metres, every frame laid on the
/// neutral as a whole.
pub(super) fn marker_motion(capture: &Capture, seen: &[usize], points: &[Point]) -> Vec<f64> {
    let all: Vec<usize> = (0..seen.len()).collect();
    let moved = rigid_to(capture, seen, points, &all, &all);
    moved.into_iter().map(Option::unwrap_or_default).collect()
}

/// Root mean square way of the markers `of` against the markers `head` (places in `seen`), metres;
/// none for a marker that is never seen together with three of the head's.
pub(super) fn rigid_to(
    capture: &Capture,
    seen: &[usize],
    points: &[Point],
    head: &[usize],
    of: &[usize],
) -> Vec<Option<f64>> {
    let metres = capture.unit.metres();
    let frames = capture.frames();
    let step = frames.div_ceil(LOOKED_AT).max(1);
    let mut sums = vec![(0.0, 0.0); of.len()];
    for frame in (0..frames).step_by(step) {
        let now = |i: usize| {
            let p = capture.frame(frame)[seen[i]].map(|x| x * metres);
            p.is_finite().then_some(p)
        };
        let (from, to): (Vec<Point>, Vec<Point>) =
            head.iter().filter_map(|&i| Some((now(i)?, points[i]))).unzip();
        let Some(pose) = pose(&from, &to) else { continue };
        for (sum, &i) in sums.iter_mut().zip(of) {
            if let Some(p) = now(i) {
                sum.0 += (pose.apply(p) - points[i]).length_squared();
                sum.1 += 1.0;
            }
        }
    }
    sums.into_iter().map(|(sum, count)| (count > 0.0).then(|| f64::sqrt(sum / count))).collect()
}

fn pose(from: &[Point], to: &[Point]) -> Option<RigidMotion> {
    if from.len() < 3 { None } else { align_rigidly(from, to).ok() }
}

/// Rank correlation of two lists of one length; 0 where one of them is constant.
pub(super) fn ranks_agree(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (ranks(a), ranks(b));
    let mean = (a.len() as f64 - 1.0) / 2.0;
    let product = |x: &[f64], y: &[f64]| -> f64 {
        x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum()
    };
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    if scale > 0.0 { product(&a, &b) / scale } else { 0.0 }
}

/// Ranks from 0, ties at their mean.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    for same in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let place = order.iter().position(|i| *i == same[0]).unwrap_or(0) as f64;
        let mean = place + (same.len() as f64 - 1.0) / 2.0;
        same.iter().for_each(|&i| ranks[i] = mean);
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_agree_whatever_the_scale() {
        assert!((ranks_agree(&[1.0, 2.0, 30.0], &[0.1, 0.2, 0.3]) - 1.0).abs() < 1e-12);
        assert!((ranks_agree(&[1.0, 2.0, 30.0], &[3.0, 2.0, 1.0]) + 1.0).abs() < 1e-12);
        assert_eq!(ranks_agree(&[1.0, 1.0], &[1.0, 2.0]), 0.0);
        assert_eq!(ranks(&[2.0, 1.0, 2.0]), [1.5, 0.0, 1.5]);
    }
}
