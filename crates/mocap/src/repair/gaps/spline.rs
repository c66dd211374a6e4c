//! Short gaps: a cubic between the ends of the gap, its slopes those of the motion around it.

use mimique_geometry::Point;

use super::Gap;
use crate::Capture;

/// Frames on either side from which a slope is estimated: enough that noise of a tenth of a
/// millimetre does not bend the cubic.
const SUPPORT: usize = 8;

/// Positions inside the gap; the frames before and after it must be present.
pub(crate) fn fill(capture: &Capture, gap: Gap) -> Vec<Point> {
    let at = |frame: usize| capture.frame(frame)[gap.marker];
    let before: Vec<Point> =
        (0..gap.first).rev().take(SUPPORT).map(at).take_while(|p| p.is_seen()).collect();
    let after: Vec<Point> =
        (gap.end..capture.frames()).take(SUPPORT).map(at).take_while(|p| p.is_seen()).collect();
    let span = (gap.frames() + 1) as f64;
    let (from, to) = (at(gap.first - 1), at(gap.end));
    let mut filled = vec![Point::ORIGIN; gap.frames()];
    for axis in 0..3 {
        let values = |side: &[Point]| side.iter().map(|p| p[axis]).collect::<Vec<f64>>();
        let secant = (to[axis] - from[axis]) / span;
        // Time runs backwards in `before`.
        let slope_from = slope_at_start(&values(&before)).map_or(secant, |s| -s) * span;
        let slope_to = slope_at_start(&values(&after)).unwrap_or(secant) * span;
        for (step, p) in filled.iter_mut().enumerate() {
            let t = (step + 1) as f64 / span;
            let (t2, t3) = (t * t, t * t * t);
            p[axis] = (2.0 * t3 - 3.0 * t2 + 1.0) * from[axis]
                + (t3 - 2.0 * t2 + t) * slope_from
                + (3.0 * t2 - 2.0 * t3) * to[axis]
                + (t3 - t2) * slope_to;
        }
    }
    filled
}

/// Slope at the first of evenly spaced values by the least-squares parabola through them (the line
/// where there are fewer than four); `None` for one value.
fn slope_at_start(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    // With u centred, 1, u and u^2 - mean(u^2) are orthogonal on symmetric points.
    let centre = (n - 1.0) / 2.0;
    let mean_u2 = (n * n - 1.0) / 12.0;
    let (mut su, mut uu, mut sq, mut qq) = (0.0, 0.0, 0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let u = i as f64 - centre;
        let q = u * u - mean_u2;
        su += u * value;
        uu += u * u;
        sq += q * value;
        qq += q * q;
    }
    let curvature = if values.len() >= 4 { sq / qq } else { 0.0 };
    Some(su / uu - 2.0 * curvature * centre)
}

#[cfg(test)]
mod tests {
    use super::slope_at_start;

    #[test]
    fn slope_of_parabolas_and_lines_is_exact() {
        let parabola: Vec<f64> =
            (0..8).map(f64::from).map(|i| 2.0 - 3.0 * i + 0.5 * i * i).collect();
        assert!((slope_at_start(&parabola).unwrap() + 3.0).abs() < 1e-12);
        assert!((slope_at_start(&[1.0, 1.5, 2.0]).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(slope_at_start(&[1.0]), None);
    }
}
