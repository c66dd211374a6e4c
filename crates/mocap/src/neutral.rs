//! The neutral face found by itself: the stillest second of a take.

use crate::Capture;
use std::ops::Range;

/// The stillest stretch of a take.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stillest {
    /// Frames of the stretch, 0 = the first of the capture.
    pub frames: Range<usize>,
    /// Root mean square distance of the markers from their mean in the stretch, in the capture's
    /// unit.
    pub deviation: f64,
}

/// The window of `seconds` (at most the whole take) in which markers stray least from their mean.
///
/// Give it a capture whose head is stabilised, or a still head wins over a still face. A marker
/// counts where it is present in at least half of the window; windows in which fewer than nine
/// tenths of the markers count are taken only where there is no other. Among equals the earliest
/// is taken. `None` for a capture without a position.
pub fn stillest(capture: &Capture, seconds: f64) -> Option<Stillest> {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    if frames == 0 {
        return None;
    }
    // `as` saturates; the clamp keeps the window inside the take.
    let window = ((seconds * capture.rate_hz).round() as usize).clamp(1, frames);
    let windows = frames - window + 1;
    let mut variance = vec![0.0; windows];
    let mut counted = vec![0_usize; windows];
    for marker in 0..markers {
        let track = || (0..frames).map(|f| capture.frame(f)[marker]);
        // Centred on one of its own positions, so that sums of squares keep their digits.
        let Some(origin) = track().find(|p| !p[0].is_nan()) else { continue };
        let mut sums = vec![(0_usize, [0.0; 3], 0.0)];
        for p in track() {
            let (mut n, mut sum, mut squares) = sums[sums.len() - 1];
            if !p[0].is_nan() {
                n += 1;
                for k in 0..3 {
                    let d = p[k] - origin[k];
                    sum[k] += d;
                    squares += d * d;
                }
            }
            sums.push((n, sum, squares));
        }
        for start in 0..windows {
            let (a, b) = (&sums[start], &sums[start + window]);
            let n = b.0 - a.0;
            if n == 0 || 2 * n < window {
                continue;
            }
            let mean_square = (b.2 - a.2) / n as f64;
            let square_mean: f64 = (0..3).map(|k| ((b.1[k] - a.1[k]) / n as f64).powi(2)).sum();
            variance[start] += (mean_square - square_mean).max(0.0);
            counted[start] += 1;
        }
    }
    let enough = |start: usize| 10 * counted[start] >= 9 * markers;
    let any_enough = (0..windows).any(enough);
    let mean = |start: usize| variance[start] / counted[start] as f64;
    (0..windows)
        .filter(|&start| counted[start] > 0 && (!any_enough || enough(start)))
        .min_by(|&a, &b| mean(a).total_cmp(&mean(b)))
        .map(|start| Stillest { frames: start..start + window, deviation: mean(start).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LengthUnit;

    #[test]
    fn a_planted_still_second_is_found_with_its_deviation() {
        let positions = (0..1000)
            .flat_map(|f: u32| {
                let t = f64::from(f) / 100.0;
                let still = (400..500).contains(&f);
                let x = if still { 0.0 } else { (9.0 * t).sin() };
                // One millimetre up and down in the still second: a deviation of one.
                let y = if still { f64::from(f % 2) * 2.0 } else { (5.0 * t).cos() * 8.0 };
                [[1000.0 + 20.0 * x, y, 0.0], [1100.0, y, 20.0 * x]]
            })
            .collect();
        let mut capture = Capture {
            labels: vec!["a".to_owned(), "b".to_owned()],
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions,
            notes: Vec::new(),
        };
        let found = stillest(&capture, 1.0).unwrap();
        assert_eq!(found.frames, 400..500);
        assert!((found.deviation - 1.0).abs() < 1e-9);
        for frame in 700..900 {
            capture.positions[2 * frame] = [f64::NAN; 3];
            capture.positions[2 * frame + 1] = [5.0; 3];
        }
        assert_eq!(stillest(&capture, 1.0).unwrap().frames, 400..500, "half the markers missing");
        assert_eq!(stillest(&capture, 1e9).unwrap().frames, 0..1000);
    }
}
