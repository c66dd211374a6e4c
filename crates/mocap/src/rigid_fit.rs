//! The rotation and translation that best carry one set of points to another (least squares).
//!
//! Horn (1987), closed-form solution with unit quaternions: the rotation is the eigenvector of the
//! largest eigenvalue of a symmetric 4 x 4 matrix made of the points' cross-covariance.

/// A proper rigid motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rigid {
    rotation: [[f64; 3]; 3],
    from: [f64; 3],
    to: [f64; 3],
}

impl Rigid {
    /// Carry a point.
    pub(crate) fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        let d = [0, 1, 2].map(|k| p[k] - self.from[k]);
        [0, 1, 2].map(|k| self.to[k] + (0..3).map(|j| self.rotation[k][j] * d[j]).sum::<f64>())
    }
}

/// The motion of `from` to `to`; `None` for fewer than three points or points not finite. Points
/// on one line leave the turn around it open: any is given.
pub(crate) fn rigid_from_to(from: &[[f64; 3]], to: &[[f64; 3]]) -> Option<Rigid> {
    if from.len() < 3 || from.len() != to.len() {
        return None;
    }
    let (from_centre, to_centre) = (centroid(from), centroid(to));
    let mut s = [[0.0; 3]; 3];
    for (p, q) in from.iter().zip(to) {
        for i in 0..3 {
            for j in 0..3 {
                s[i][j] += (p[i] - from_centre[i]) * (q[j] - to_centre[j]);
            }
        }
    }
    if !s.iter().flatten().all(|v| v.is_finite()) {
        return None;
    }
    let n = [
        [s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]],
        [s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]],
        [s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]],
        [s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]],
    ];
    let [w, x, y, z] = largest_eigenvector(n);
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    Some(Rigid { rotation, from: from_centre, to: to_centre })
}

fn centroid(points: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64)
}

/// Unit eigenvector of the largest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations.
fn largest_eigenvector(mut a: [[f64; 4]; 4]) -> [f64; 4] {
    let mut v = [[0.0; 4]; 4];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    // Quadratic convergence: a handful of sweeps reaches rounding.
    for _ in 0..30 {
        let off: f64 =
            (0..4).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j].powi(2)).sum();
        let scale: f64 = (0..4).map(|i| a[i][i].powi(2)).sum();
        if off <= scale * 1e-32 {
            break;
        }
        for p in 0..3 {
            for q in p + 1..4 {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
                let (x, y) = (a[p], a[q]);
                a[p] = [0, 1, 2, 3].map(|k| c * x[k] - s * y[k]);
                a[q] = [0, 1, 2, 3].map(|k| s * x[k] + c * y[k]);
                for row in &mut v {
                    let (x, y) = (row[p], row[q]);
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
            }
        }
    }
    let best = (1..4).fold(0, |best, i| if a[i][i] > a[best][best] { i } else { best });
    [0, 1, 2, 3].map(|k| v[k][best])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_motion_is_recovered() {
        let from = [[1.0, 2.0, 3.0], [-4.0, 0.5, 1.0], [0.0, 7.0, -2.0], [3.0, 3.0, 0.0]];
        let (s, c) = 2.3_f64.sin_cos();
        let to = from.map(|[x, y, z]| [c * x - s * z + 10.0, y - 4.0, s * x + c * z]);
        let rigid = rigid_from_to(&from, &to).unwrap();
        for (p, q) in from.iter().zip(&to) {
            for (got, want) in rigid.apply(*p).iter().zip(q) {
                assert!((got - want).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_mirror_image_is_met_by_a_rotation() {
        let from = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.5]];
        let to = from.map(|[x, y, z]| [-x, y, z]);
        let r = rigid_from_to(&from, &to).unwrap().rotation;
        let determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1])
            - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
            + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
        assert!((determinant - 1.0).abs() < 1e-12);
    }
}
