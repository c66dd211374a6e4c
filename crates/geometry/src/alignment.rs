//! The best rigid motion between two sets of points (thesis 5.2.1, \[SHR17\]).
//!
//! Least squares by Horn's quaternion form (Horn 1987): the rotation is the eigenvector of the largest
//! eigenvalue of a symmetric 4 x 4 matrix, so that it is always proper, never a reflection.

use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix4, SymmetricEigen};

use crate::point::{Point, centroid};
use crate::rigid_motion::{Pose, RigidMotion};

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

/// The proper rigid motion that takes `from` nearest to `to` in least squares, no scale.
///
/// Pairs with a NaN are left out.
///
/// # Errors
/// [`RigidError`] for fewer than three pairs, or points in a line.
pub fn align_rigidly(from: &[Point], to: &[Point]) -> Result<RigidMotion, RigidError> {
    best_pose(from.iter().copied().zip(to.iter().copied())).map(|pose| pose.motion())
}

/// The same as rotation and centroids: what a low-pass of a head's pose works on.
///
/// # Errors
/// As [`align_rigidly`].
pub fn best_pose(pairs: impl Iterator<Item = (Point, Point)> + Clone) -> Result<Pose, RigidError> {
    let scatter = Scatter::of(pairs)?;
    if is_a_line(&scatter.from_spread) || is_a_line(&scatter.to_spread) {
        return Err(RigidError::Collinear);
    }
    Ok(scatter.pose())
}

/// The same for points that may stand in a line, which leaves the turn about it open: any is given.
///
/// # Errors
/// [`RigidError::TooFew`] for fewer than three pairs.
pub fn pose_between(
    pairs: impl Iterator<Item = (Point, Point)> + Clone,
) -> Result<Pose, RigidError> {
    Scatter::of(pairs).map(|scatter| scatter.pose())
}

/// Second moments of pairs of points about their centroids.
struct Scatter {
    from: Point,
    to: Point,
    /// Sum of p q^T: column j is the sum of p q_j.
    cross: DMat3,
    from_spread: DMat3,
    to_spread: DMat3,
}

impl Scatter {
    fn of(pairs: impl Iterator<Item = (Point, Point)> + Clone) -> Result<Scatter, RigidError> {
        let seen = pairs.filter(|(a, b)| a.is_seen() && b.is_seen());
        let count = seen.clone().count();
        if count < 3 {
            return Err(RigidError::TooFew(count));
        }
        let from = centroid(seen.clone().map(|(a, _)| a));
        let to = centroid(seen.clone().map(|(_, b)| b));
        let outer = |p: DVec3, q: DVec3| DMat3::from_cols(p * q.x, p * q.y, p * q.z);
        let mut scatter = Scatter {
            from,
            to,
            cross: DMat3::ZERO,
            from_spread: DMat3::ZERO,
            to_spread: DMat3::ZERO,
        };
        for (a, b) in seen {
            let (p, q) = ((a - from).0, (b - to).0);
            scatter.cross += outer(p, q);
            scatter.from_spread += outer(p, p);
            scatter.to_spread += outer(q, q);
        }
        Ok(scatter)
    }

    fn pose(&self) -> Pose {
        Pose { rotation: best_rotation(&self.cross), from: self.from, to: self.to }
    }
}

/// Whether the second extent of a 3 x 3 scatter matrix is far below its first.
///
/// With eigenvalues a >= b >= c: trace = a + b + c and the sum of the principal minors
/// = ab + bc + ca >= ab, at most 2ab + ...; a line has minors / trace^2 near (b + c) / a.
fn is_a_line(m: &DMat3) -> bool {
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = m.to_cols_array_2d();
    let trace = xx + yy + zz;
    let minors = (xx * yy - xy * xy) + (yy * zz - yz * yz) + (zz * xx - xz * xz);
    // Points that coincide (0 <= 0) count as a line, too.
    minors.is_nan() || minors <= LINE * LINE * trace * trace
}

/// The unit quaternion that maximises the trace of R M for the cross-covariance M = sum of p q^T; its
/// real part is not negative.
fn best_rotation(m: &DMat3) -> DQuat {
    let [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]] = m.to_cols_array_2d();
    #[rustfmt::skip]
    let horn = Matrix4::new(
        xx + yy + zz, yz - zy, zx - xz, xy - yx,
        yz - zy, xx - yy - zz, xy + yx, zx + xz,
        zx - xz, xy + yx, yy - xx - zz, yz + zy,
        xy - yx, zx + xz, yz + zy, zz - xx - yy,
    );
    let eigen = SymmetricEigen::new(horn);
    let q = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let q = DQuat::from_xyzw(q[1], q[2], q[3], q[0]);
    let q = if q.w < 0.0 { -q } else { q };
    q * (1.0 / q.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::Displacement;

    fn cloud() -> Vec<Point> {
        [[1.0, 2.0, 3.0], [-4.0, 0.5, 1.0], [0.0, 7.0, -2.0], [3.0, 3.0, 0.0]]
            .map(Point::from)
            .to_vec()
    }

    #[test]
    fn a_planted_motion_is_recovered() {
        let from = cloud();
        for angle in [0.0, 1e-9, 0.3, 2.3, std::f64::consts::PI, -3.0] {
            let (s, c) = (libm::sin(angle / 2.0), libm::cos(angle / 2.0));
            let planted = RigidMotion::turn(DQuat::from_xyzw(0.6 * s, 0.0, 0.8 * s, c))
                .then_by(Displacement::new(10.0, -4.0, 0.25));
            let to: Vec<Point> = from.iter().map(|p| planted.apply(*p)).collect();
            let found = align_rigidly(&from, &to).unwrap();
            for (p, q) in from.iter().zip(&to) {
                assert!((found.apply(*p) - *q).length() < 1e-12, "{angle}");
            }
        }
    }

    #[test]
    fn a_mirror_image_is_met_by_a_rotation() {
        let from = cloud();
        let to: Vec<Point> = from.iter().map(|p| Point::new(-p.x, p.y, p.z)).collect();
        let found = align_rigidly(&from, &to).unwrap();
        assert!((found.rotation.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn unseen_points_are_left_out_and_too_few_or_a_line_are_refused() {
        let mut from = cloud();
        let to = from.clone();
        from[1] = Point::UNSEEN;
        let still = align_rigidly(&from, &to).unwrap();
        assert!((still.apply(to[0]) - to[0]).length() < 1e-14);
        from[0] = Point::UNSEEN;
        assert_eq!(align_rigidly(&from, &to), Err(RigidError::TooFew(2)));
        let line: Vec<Point> = (0..4).map(|i| Point::new(f64::from(i), 0.0, 1.0)).collect();
        assert_eq!(align_rigidly(&line, &line), Err(RigidError::Collinear));
        let any = pose_between(line.iter().copied().zip(line.iter().copied())).unwrap().motion();
        assert!(line.iter().all(|p| (any.apply(*p) - *p).length() < 1e-12));
    }
}
