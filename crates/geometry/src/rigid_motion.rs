//! Rigid motions: a turn and a shift.

use glam::{DMat3, DQuat};

use crate::point::{Displacement, Point};

/// x -> R x + t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    /// R.
    pub rotation: DMat3,
    /// t, in the unit of the points.
    pub translation: Displacement,
}

impl RigidMotion {
    /// x -> x.
    pub const IDENTITY: RigidMotion =
        RigidMotion { rotation: DMat3::IDENTITY, translation: Displacement::ZERO };

    /// The turn of a unit quaternion about the origin.
    pub fn turn(rotation: DQuat) -> RigidMotion {
        RigidMotion { rotation: DMat3::from_quat(rotation), translation: Displacement::ZERO }
    }

    /// The same, then a shift.
    pub fn then_by(self, shift: Displacement) -> RigidMotion {
        RigidMotion { translation: self.translation + shift, ..self }
    }

    /// R x + t: where a point goes.
    pub fn apply(&self, point: Point) -> Point {
        Point(self.rotation * point.0) + self.translation
    }

    /// R d: how a displacement turns.
    pub fn rotate(&self, displacement: Displacement) -> Displacement {
        Displacement(self.rotation * displacement.0)
    }

    /// First `first`, then `self`.
    pub fn after(&self, first: &RigidMotion) -> RigidMotion {
        RigidMotion {
            rotation: self.rotation * first.rotation,
            translation: self.rotate(first.translation) + self.translation,
        }
    }

    /// The motion back.
    pub fn inverse(&self) -> RigidMotion {
        let back = RigidMotion { rotation: self.rotation.transpose(), ..RigidMotion::IDENTITY };
        RigidMotion { translation: -back.rotate(self.translation), ..back }
    }
}

/// A turn, and the two points that it takes to one another: the centroids of a best rigid motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Unit quaternion, its real part not negative where it was fitted.
    pub rotation: DQuat,
    /// A point before the motion.
    pub from: Point,
    /// The same after it.
    pub to: Point,
}

impl Pose {
    /// The motion that turns about `from` and takes it to `to`.
    pub fn motion(&self) -> RigidMotion {
        let turn = RigidMotion::turn(self.rotation);
        RigidMotion { translation: self.to - turn.apply(self.from), ..turn }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_follow_one_another_and_go_back() {
        let first = RigidMotion::turn(DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8))
            .then_by(Displacement::new(1.0, -2.0, 0.5));
        let second = RigidMotion::turn(DQuat::from_xyzw(0.48, 0.36, 0.0, 0.8))
            .then_by(Displacement::new(0.0, 0.1, 3.0));
        let p = Point::new(0.3, 0.7, -1.1);
        let both = second.after(&first);
        assert!((both.apply(p) - second.apply(first.apply(p))).length() < 1e-14);
        assert!((both.inverse().apply(both.apply(p)) - p).length() < 1e-14);
        let d = Displacement::new(1.0, 2.0, 3.0);
        assert!((first.rotate(d).length() - d.length()).abs() < 1e-14);
        let pose =
            Pose { rotation: DQuat::from_xyzw(0.0, 0.6, 0.0, 0.8), from: p, to: Point::ORIGIN };
        assert!((pose.motion().apply(p) - Point::ORIGIN).length() < 1e-15);
    }
}
