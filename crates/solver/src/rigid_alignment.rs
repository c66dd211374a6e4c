//! Rigid motions, and the best one between two sets of points (thesis 5.2.1, \[SHR17\]).
//!
//! Least squares by Horn's quaternion form: the rotation is the eigenvector of the largest
//! eigenvalue of a symmetric 4 x 4 matrix, so that it is always proper, never a reflection.

/// x -> R x + t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    /// R, rows.
    pub rotation: [[f64; 3]; 3],
    /// t, in the unit of the points.
    pub translation: [f64; 3],
}

/// Why there is no best rigid motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RigidError {
    /// Three pairs of points are needed.
    #[error("{0} points in common, 3 are needed")]
    TooFew(usize),
    /// The points leave a rotation open.
    #[error("the points stand in one line")]
    Collinear,
}

/// Points whose second extent is below this part of their first stand in a line: 1 mm in 100 mm
/// would turn the head by half a degree with 1 mm of noise at any length.
const LINE: f64 = 0.01;

impl RigidMotion {
    /// x -> x.
    pub const IDENTITY: RigidMotion = RigidMotion {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0; 3],
    };

    /// R x + t.
    pub fn apply(&self, x: [f64; 3]) -> [f64; 3] {
        let r = self.rotate(x);
        std::array::from_fn(|a| r[a] + self.translation[a])
    }

    /// R x.
    pub fn rotate(&self, x: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
    }

    /// First `first`, then `self`.
    pub fn after(&self, first: &RigidMotion) -> RigidMotion {
        let columns: [[f64; 3]; 3] =
            std::array::from_fn(|c| self.rotate(std::array::from_fn(|r| first.rotation[r][c])));
        RigidMotion {
            rotation: std::array::from_fn(|r| std::array::from_fn(|c| columns[c][r])),
            translation: self.apply(first.translation),
        }
    }

    /// The motion back.
    pub fn inverse(&self) -> RigidMotion {
        let r = self.rotation;
        let back = RigidMotion {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| r[j][i])),
            translation: [0.0; 3],
        };
        let t = back.rotate(self.translation);
        RigidMotion { translation: t.map(|x| -x), ..back }
    }

    /// The rotation of a unit quaternion (w, x, y, z), no translation.
    pub fn from_quaternion([w, x, y, z]: [f64; 4]) -> RigidMotion {
        let rotation = [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ];
        RigidMotion { rotation, translation: [0.0; 3] }
    }
}

/// The rotation and the two centroids of a best rigid motion: what the low-pass of a head's pose
/// works on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pose {
    /// Unit quaternion (w, x, y, z), w >= 0.
    pub(crate) quaternion: [f64; 4],
    pub(crate) from_centroid: [f64; 3],
    pub(crate) to_centroid: [f64; 3],
}

impl Pose {
    pub(crate) fn motion(&self) -> RigidMotion {
        let turn = RigidMotion::from_quaternion(self.quaternion);
        let turned = turn.rotate(self.from_centroid);
        let translation = std::array::from_fn(|a| self.to_centroid[a] - turned[a]);
        RigidMotion { translation, ..turn }
    }
}

/// The proper rigid motion that takes `from` nearest to `to` in least squares, no scale.
///
/// Pairs with a NaN are left out.
///
/// # Errors
/// [`RigidError`] for fewer than three pairs, or points in a line.
pub fn align_rigidly(from: &[[f64; 3]], to: &[[f64; 3]]) -> Result<RigidMotion, RigidError> {
    align(from.iter().copied().zip(to.iter().copied())).map(|pose| pose.motion())
}

pub(crate) fn align(
    pairs: impl Iterator<Item = ([f64; 3], [f64; 3])> + Clone,
) -> Result<Pose, RigidError> {
    let seen = pairs.filter(|(a, b)| a.iter().chain(b).all(|x| !x.is_nan()));
    let mut count = 0_usize;
    let (mut from_centroid, mut to_centroid) = ([0.0; 3], [0.0; 3]);
    for (a, b) in seen.clone() {
        count += 1;
        for k in 0..3 {
            from_centroid[k] += a[k];
            to_centroid[k] += b[k];
        }
    }
    if count < 3 {
        return Err(RigidError::TooFew(count));
    }
    for k in 0..3 {
        from_centroid[k] /= count as f64;
        to_centroid[k] /= count as f64;
    }
    let mut cross = [[0.0; 3]; 3];
    let (mut from_spread, mut to_spread) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    for (a, b) in seen {
        let p: [f64; 3] = std::array::from_fn(|k| a[k] - from_centroid[k]);
        let q: [f64; 3] = std::array::from_fn(|k| b[k] - to_centroid[k]);
        for i in 0..3 {
            for j in 0..3 {
                cross[i][j] += p[i] * q[j];
                from_spread[i][j] += p[i] * p[j];
                to_spread[i][j] += q[i] * q[j];
            }
        }
    }
    if is_a_line(&from_spread) || is_a_line(&to_spread) {
        return Err(RigidError::Collinear);
    }
    Ok(Pose { quaternion: best_quaternion(&cross), from_centroid, to_centroid })
}

/// Whether the second extent of a 3 x 3 scatter matrix is far below its first.
///
/// With eigenvalues a >= b >= c: trace = a + b + c and the sum of the principal minors
/// = ab + bc + ca >= ab, at most 2ab + ...; a line has minors / trace^2 near (b + c) / a.
fn is_a_line(m: &[[f64; 3]; 3]) -> bool {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let minors = m[0][0] * m[1][1] - m[0][1] * m[1][0] + m[1][1] * m[2][2] - m[1][2] * m[2][1]
        + m[2][2] * m[0][0]
        - m[2][0] * m[0][2];
    // `!(x > y)` so that points that coincide (0 > 0) count as a line too.
    !(minors > LINE * LINE * trace * trace)
}

/// Horn 1987: the quaternion that maximises the trace of R M for the cross-covariance M = sum of
/// p q^T.
fn best_quaternion(m: &[[f64; 3]; 3]) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *m;
    let mut a = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let v = jacobi_eigenvectors(&mut a);
    let mut best = 0;
    for k in 1..4 {
        if a[k][k] > a[best][best] {
            best = k;
        }
    }
    let q: [f64; 4] = std::array::from_fn(|k| v[k][best]);
    let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    let sign = if q[0] < 0.0 { -length } else { length };
    q.map(|x| x / sign)
}

/// Unit eigenvectors of a symmetric 3 x 3 matrix, that of the smallest eigenvalue first.
pub(crate) fn eigenvectors(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut a = [[0.0; 4]; 4];
    for i in 0..3 {
        a[i][..3].copy_from_slice(&m[i]);
    }
    // The fourth coordinate turns with no other: its column is 0 but for the diagonal.
    let v = jacobi_eigenvectors(&mut a);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    order.map(|k| std::array::from_fn(|i| v[i][k]))
}

/// Cyclic Jacobi: diagonalises `a` in place, eigenvectors in the columns of the result.
fn jacobi_eigenvectors(a: &mut [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    let mut v = [[0.0; 4]; 4];
    for (k, row) in v.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    // Jacobi converges quadratically: 4 x 4 needs some 5 sweeps; 30 is a guard against NaN.
    for _ in 0..30 {
        let mut rotated = false;
        for p in 0..3 {
            for q in p + 1..4 {
                let off = a[p][q];
                // Below this an off-diagonal entry changes no bit of the two eigenvalues.
                if off.abs() <= 1e-17 * (a[p][p].abs() + a[q][q].abs()) {
                    continue;
                }
                rotated = true;
                let theta = (a[q][q] - a[p][p]) / (2.0 * off);
                let sign = if theta < 0.0 { -1.0 } else { 1.0 };
                let t = sign / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..4 {
                    let (x, y) = (a[k][p], a[k][q]);
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for k in 0..4 {
                    let (x, y) = (a[p][k], a[q][k]);
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                }
                for row in &mut v {
                    let (x, y) = (row[p], row[q]);
                    row[p] = c * x - s * y;
                    row[q] = s * x + c * y;
                }
            }
        }
        if !rotated {
            break;
        }
    }
    v
}
