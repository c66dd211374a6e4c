//! Curves that come back on themselves, through a few points.

/// The value at a share of a turn: cubic between neighbours, with the slope of the line through both
/// neighbours at each, so that neither value nor slope jumps.
pub(super) fn periodic(points: &[[f64; 2]], at: f64) -> f64 {
    let at = at - at.floor();
    let count = points.len() as isize;
    let next = points.iter().position(|point| point[0] > at).unwrap_or(points.len()) as isize;
    // A point of the turn, or of the one before or after.
    let point = |i: isize| {
        let [x, y] = points[i.rem_euclid(count) as usize];
        [x + i.div_euclid(count) as f64, y]
    };
    let [before, low, high, after] = [-2, -1, 0, 1].map(|k| point(next + k));
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let width = high[0] - low[0];
    hermite(
        (at - low[0]) / width,
        [low[1], slope(before, high) * width],
        [high[1], slope(low, after) * width],
    )
}

/// The cubic of u from 0 to 1 that has value and slope at both ends.
pub(super) fn hermite(u: f64, [from, slope_from]: [f64; 2], [to, slope_to]: [f64; 2]) -> f64 {
    let v = 1.0 - u;
    let step = u * u * (3.0 - 2.0 * u);
    from + (to - from) * step + slope_from * u * v * v - slope_to * u * u * v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_and_does_not_jump() {
        let points = [[0.0, 1.0], [0.3, -2.0], [0.7, 4.0]];
        for [x, y] in points {
            assert!((periodic(&points, x) - y).abs() < 1e-12);
            assert!((periodic(&points, x + 3.0) - y).abs() < 1e-12);
            assert!((periodic(&points, x - 1e-9) - y).abs() < 1e-6);
            let slopes = [-1e-6, 1e-6].map(|h| (periodic(&points, x + h) - y) / h);
            assert!((slopes[0] - slopes[1]).abs() < 1e-3, "{slopes:?}");
        }
    }
}
