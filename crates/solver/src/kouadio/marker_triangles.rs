//! The mask: the markers' neutral connected to triangles, by which it deforms the face (Kouadio
//! 4.3.1, "association point a polygone", figure 4.15).
//!
//! In 1997 an artist connected the markers. Here they are unrolled from a line behind the face
//! (x over the distance from that line, y as it is), which keeps the sides of a face from folding
//! over its front, and joined by Delaunay's triangulation.

use mimique_geometry::Point;

/// Triangles over points in space, as indices; empty for fewer than three points or a line.
///
/// `points` in the avatar's axes: +Y up, +Z out of the face; any unit.
pub(crate) fn triangulate_markers(points: &[Point]) -> Vec<[usize; 3]> {
    delaunay(&unroll(points))
}

/// Seen from a vertical line half a face's width behind the hindmost marker.
fn unroll(points: &[Point]) -> Vec<[f64; 2]> {
    let range = |a: usize| {
        let column = points.iter().map(|p| p[a]);
        let low = column.clone().fold(f64::INFINITY, f64::min);
        (low, column.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (_, _), (back, front)) = (range(0), range(1), range(2));
    let width = right - left;
    let middle = 0.5 * (left + right);
    let line = back - 0.5 * width;
    let depth = front - line;
    points
        .iter()
        .map(|p| {
            let scale = if p[2] > line { depth / (p[2] - line) } else { 1.0 };
            [(p[0] - middle) * scale, p[1]]
        })
        .collect()
}

/// Bowyer 1981, Watson 1981: every point in turn removes the triangles whose circle holds it and is
/// joined to the edge of the hole. Quadratic in the number of points, of which there are dozens.
fn delaunay(points: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let n = points.len();
    if n < 3 {
        return Vec::new();
    }
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in points {
        for a in 0..2 {
            low[a] = low[a].min(p[a]);
            high[a] = high[a].max(p[a]);
        }
    }
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    if !(size > 0.0) {
        return Vec::new();
    }
    // In units of the face, so that the outer triangle is far away at any unit.
    let mut all: Vec<[f64; 2]> =
        points.iter().map(|p| [(p[0] - low[0]) / size, (p[1] - low[1]) / size]).collect();
    // Far enough that it cuts no hull edge of a face's markers, near enough for the determinants.
    all.extend([[-300.0, -200.0], [300.0, -200.0], [0.5, 400.0]]);
    let mut triangles: Vec<[usize; 3]> = vec![[n, n + 1, n + 2]];
    for i in 0..n {
        let (bad, good): (Vec<_>, Vec<_>) =
            triangles.into_iter().partition(|t| in_circle(t.map(|k| all[k]), all[i]));
        triangles = good;
        let edges: Vec<[usize; 2]> =
            bad.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        for &[a, b] in &edges {
            if !edges.contains(&[b, a]) {
                triangles.push([a, b, i]);
            }
        }
    }
    triangles.retain(|t| t.iter().all(|&k| k < n) && area(t.map(|k| all[k])) > 1e-9);
    triangles.sort_unstable();
    triangles
}

fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// Whether p is inside the circle through a counter-clockwise triangle.
fn in_circle([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    let row = |q: [f64; 2]| {
        let (x, y) = (q[0] - p[0], q[1] - p[1]);
        [x, y, x * x + y * y]
    };
    let (a, b, c) = (row(a), row(b), row(c));
    let determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0]);
    determinant > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_cover_the_hull_once_and_their_circles_are_empty() {
        let numbers = crate::linear_algebra::dense::numbers(80, 3.1);
        let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
        let triangles = delaunay(&points);
        let covered: f64 = triangles.iter().map(|t| area(t.map(|k| points[k]))).sum();
        assert!((covered - hull_area(&points)).abs() < 1e-3 * covered, "{covered}");
        for t in &triangles {
            for (k, &p) in points.iter().enumerate() {
                assert!(t.contains(&k) || !in_circle(t.map(|k| points[k]), p));
            }
        }
        assert!(points.iter().enumerate().all(|(k, _)| triangles.iter().any(|t| t.contains(&k))));
    }

    #[test]
    fn sides_of_a_face_do_not_fold_over_its_front() {
        // Markers on half a cylinder, 10 columns by 4 rows, and a bit beyond its front half.
        let at = |i: usize, j: usize| {
            let angle = (i as f64 / 9.0 - 0.5) * 3.0;
            Point::new(0.08 * angle.sin(), 0.03 * j as f64, 0.08 * angle.cos())
        };
        let points: Vec<Point> = (0..40).map(|k| at(k % 10, k / 10)).collect();
        let triangles = triangulate_markers(&points);
        assert_eq!(triangles.len(), 2 * 9 * 3);
        for [a, b, c] in triangles {
            let columns = [a % 10, b % 10, c % 10];
            assert!(columns.iter().max().unwrap() - columns.iter().min().unwrap() == 1);
        }
        assert!(triangulate_markers(&points[..2]).is_empty());
        let line = [0.0, 0.1, 0.2].map(|x| Point::new(x, x, 0.0));
        assert!(triangulate_markers(&line).is_empty());
    }

    fn hull_area(points: &[[f64; 2]]) -> f64 {
        let mut sorted = points.to_vec();
        sorted.sort_by(|a, b| a.partial_cmp(b).unwrap());
        let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
            let mut chain: Vec<[f64; 2]> = Vec::new();
            for p in points {
                while chain.len() > 1
                    && area([chain[chain.len() - 2], chain[chain.len() - 1], p]) <= 0.0
                {
                    chain.pop();
                }
                chain.push(p);
            }
            chain
        };
        let mut hull = half(&mut sorted.iter().copied());
        hull.pop();
        hull.extend(half(&mut sorted.iter().rev().copied()));
        hull.windows(2).map(|w| 0.5 * (w[0][0] * w[1][1] - w[0][1] * w[1][0])).sum::<f64>()
    }
}
