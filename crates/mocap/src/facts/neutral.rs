//! The neutral face found by itself: the stillest second of a take.

use crate::Capture;
use mimique_geometry::Point;
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

/// How much less still than the stillest a window may be and still be a candidate: what the noise
/// of a sensor makes of windows that are equally still.
const AS_STILL: f64 = 1.25;
/// Frames that the usual face is taken from.
const SAMPLES: usize = 500;

/// The window of `seconds` (at most the whole take) in which markers stray least from their mean.
///
/// Give it a capture whose head is stabilised, or a still head wins over a still face. A marker
/// counts where it is present in at least half of the window; windows in which fewer than nine
/// tenths of the markers count are taken only where there is no other. Where several are as still
/// (an expression can be held), the one nearest to the take's usual face is taken: the median
/// place of every marker. `None` for a capture without a position.
pub fn stillest(capture: &Capture, seconds: f64) -> Option<Stillest> {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    if frames == 0 {
        return None;
    }
    // `as` saturates; the clamp keeps the window inside the take.
    let window = ((seconds * capture.rate_hz).round() as usize).clamp(1, frames);
    let windows = frames - window + 1;
    let Windows { variance, strangeness, counted } = Windows::of(capture, window);
    let enough = |start: usize| 10 * counted[start] >= 9 * markers;
    let any_enough = (0..windows).any(enough);
    let eligible = |start: usize| counted[start] > 0 && (!any_enough || enough(start));
    let deviation = |start: usize| (variance[start] / counted[start] as f64).sqrt();
    let least = (0..windows).filter(|&s| eligible(s)).map(deviation).min_by(f64::total_cmp)?;
    // The stillest place of each still stretch, not its edges.
    let is_candidate = |start: usize| {
        eligible(start)
            && deviation(start) <= AS_STILL * least
            && (start == 0 || !eligible(start - 1) || deviation(start - 1) > deviation(start))
            && (start + 1 == windows
                || !eligible(start + 1)
                || deviation(start + 1) >= deviation(start))
    };
    (0..windows)
        .filter(|&start| is_candidate(start))
        .min_by(|&a, &b| {
            let mean = |start: usize| strangeness[start] / counted[start] as f64;
            mean(a).total_cmp(&mean(b))
        })
        .map(|start| Stillest { frames: start..start + window, deviation: deviation(start) })
}

/// How the markers stand in every window of a take, by its first frame.
struct Windows {
    /// Sum over the markers: variance about their own mean in the window.
    variance: Vec<f64>,
    /// Sum over the markers: squared distance of that mean from their usual place.
    strangeness: Vec<f64>,
    /// Markers that are present in half of the window at least.
    counted: Vec<usize>,
}

impl Windows {
    /// The windows of `window` frames.
    fn of(capture: &Capture, window: usize) -> Self {
        let frames = capture.frames();
        let windows = frames - window + 1;
        let usual = usual_face(capture);
        let mut variance = vec![0.0; windows];
        let mut strangeness = vec![0.0; windows];
        let mut counted = vec![0_usize; windows];
        let mut sums = Vec::with_capacity(frames + 1);
        for (marker, origin) in usual.iter().enumerate() {
            // Centred on its usual place, so that sums of squares keep their digits.
            let Some(origin) = origin else { continue };
            sums.clear();
            sums.push((0_usize, [0.0; 3], 0.0));
            for frame in 0..frames {
                let p = capture.frame(frame)[marker];
                let (mut n, mut sum, mut squares) = sums[frame];
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
                strangeness[start] += square_mean;
                counted[start] += 1;
            }
        }
        Self { variance, strangeness, counted }
    }
}

/// The median place of every marker; `None` for one that is never seen.
fn usual_face(capture: &Capture) -> Vec<Option<Point>> {
    let mut values = Vec::new();
    (0..capture.labels.len())
        .map(|marker| {
            let seen = || {
                let places = (0..capture.frames()).map(|f| capture.frame(f)[marker]);
                places.filter(|p| !p[0].is_nan())
            };
            let step = (seen().count() / SAMPLES).max(1);
            let mut median = Point::ORIGIN;
            for axis in 0..3 {
                values.clear();
                values.extend(seen().step_by(step).map(|p| p[axis]));
                let middle = values.len() / 2;
                if values.is_empty() {
                    return None;
                }
                median[axis] = *values.select_nth_unstable_by(middle, f64::total_cmp).1;
            }
            Some(median)
        })
        .collect()
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
                [[1000.0 + 20.0 * x, y, 0.0], [1100.0, y, 20.0 * x]].map(Point::from)
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
            capture.positions[2 * frame] = Point::UNSEEN;
            capture.positions[2 * frame + 1] = Point::new(5.0, 5.0, 5.0);
        }
        assert_eq!(stillest(&capture, 1.0).unwrap().frames, 400..500, "half the markers missing");
        assert_eq!(stillest(&capture, 1e9).unwrap().frames, 0..1000);
    }

    #[test]
    fn of_two_still_seconds_the_one_with_the_usual_face_is_the_neutral() {
        // Mostly at rest with small movements; from 2 s to 4 s the mouth is held wide open, and
        // stiller than the face ever is at rest.
        let mut state = 9_u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / 1e7 - 0.8
        };
        let positions = (0..1200_u32)
            .flat_map(|f| {
                let t = f64::from(f) / 100.0;
                let held = (200..400).contains(&f);
                let rest = f < 180 || (600..900).contains(&f);
                let open = if held { 20.0 } else { 0.0 };
                let sway = if held || rest { 0.0 } else { 4.0 * (7.0 * t).sin() };
                let gain = if held { 0.09 } else { 0.1 };
                [[0.0, -open + sway, 0.0], [50.0, sway, 5.0]]
                    .map(|p| Point::from(p.map(|v| v + gain * noise())))
            })
            .collect();
        let capture = Capture {
            labels: vec!["chin".to_owned(), "brow".to_owned()],
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions,
            notes: Vec::new(),
        };
        let found = stillest(&capture, 1.0).unwrap().frames;
        assert!(found.end <= 200 || (found.start >= 595 && found.end <= 905), "{found:?}");
    }
}
