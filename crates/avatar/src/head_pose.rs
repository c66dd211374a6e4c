//! Where the head is turned to, as weights of three shapes that move no vertex: the stage turns head and neck by them.

use crate::Avatar;
use crate::avatar::{Mesh, SparseShape};

/// The shapes that turn the head: nod, turn, tilt.
pub const HEAD_POSE_SHAPES: [&str; 3] = ["headNod", "headTurn", "headTilt"];

/// By how much each of them turns the head at weight 1, degrees.
pub const HEAD_POSE_DEGREES: f64 = 10.0;

/// How the head is turned against its place at rest, degrees. The tilt comes first, about the line from back to
/// front; then the turn about the vertical; then the nod about the line from ear to ear.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct HeadAngles {
    /// Downwards above 0.
    pub nod: f64,
    /// To the person's left above 0.
    pub turn: f64,
    /// To the person's left shoulder above 0.
    pub tilt: f64,
}

impl HeadAngles {
    /// Of the weights of [`HEAD_POSE_SHAPES`].
    pub fn of_weights([nod, turn, tilt]: [f64; 3]) -> Self {
        let degrees = |weight: f64| HEAD_POSE_DEGREES * weight;
        Self { nod: degrees(nod), turn: degrees(turn), tilt: degrees(tilt) }
    }

    /// Weights of [`HEAD_POSE_SHAPES`]; below 0 for a head that is lifted, turned or tilted to the right.
    pub fn weights(&self) -> [f64; 3] {
        [self.nod, self.turn, self.tilt].map(|degrees| degrees / HEAD_POSE_DEGREES)
    }

    /// Of the axes of a turned head in those of the head at rest (x to the person's left, y up, z to the front):
    /// the columns of its rotation.
    pub fn of_axes(columns: [[f64; 3]; 3]) -> Self {
        let [x, y, z] = columns;
        Self {
            nod: libm::atan2(y[2], z[2]).to_degrees(),
            turn: libm::atan2(-x[2], libm::hypot(x[0], x[1])).to_degrees(),
            tilt: -libm::atan2(x[1], x[0]).to_degrees(),
        }
    }

    /// The angle of a head between two poses, degrees, each axis by itself added up as if it were small.
    pub fn apart(&self, other: &Self) -> f64 {
        let [nod, turn, tilt] =
            [self.nod - other.nod, self.turn - other.turn, self.tilt - other.tilt];
        libm::hypot(libm::hypot(nod, turn), tilt)
    }
}

impl Avatar {
    /// The same with the shapes that turn its head, right behind those of the face. An avatar that has them stays as
    /// it is.
    #[must_use]
    pub fn with_head_pose_shapes(mut self) -> Self {
        if HEAD_POSE_SHAPES.iter().all(|name| self.shape_index(name).is_some()) {
            return self;
        }
        let place = self.face_shapes().len();
        for (k, name) in HEAD_POSE_SHAPES.iter().enumerate() {
            self.shape_names.insert(place + k, (*name).to_owned());
            for Mesh { shapes, .. } in &mut self.meshes {
                shapes.insert(place + k, SparseShape::default());
            }
        }
        for look in self.eyeballs.iter_mut().flat_map(|eye| &mut eye.looks) {
            look.shape += if look.shape >= place { HEAD_POSE_SHAPES.len() } else { 0 };
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of Rz(-tilt) Ry(turn) Rx(nod).
    fn axes(pose: &HeadAngles) -> [[f64; 3]; 3] {
        let about = |axis: usize, degrees: f64| {
            let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            move |p: [f64; 3]| {
                let mut out = p;
                out[b] = cos * p[b] - sin * p[c];
                out[c] = sin * p[b] + cos * p[c];
                out
            }
        };
        let [nod, turn, tilt] = [about(0, pose.nod), about(1, pose.turn), about(2, -pose.tilt)];
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| tilt(turn(nod(axis))))
    }

    #[test]
    fn a_pose_is_told_from_its_axes_and_its_weights() {
        for pose in [
            HeadAngles { nod: 12.0, turn: 0.0, tilt: 0.0 },
            HeadAngles { nod: 0.0, turn: -25.0, tilt: 0.0 },
            HeadAngles { nod: 8.0, turn: 20.0, tilt: -9.0 },
        ] {
            let found = HeadAngles::of_axes(axes(&pose));
            assert!(found.apart(&pose) < 1e-9, "{found:?} {pose:?}");
            assert!(HeadAngles::of_weights(pose.weights()).apart(&pose) < 1e-12);
        }
        // A nod lowers what is in front; a turn to the left takes it to the left; a tilt to the left shoulder takes the
        // crown there.
        let forward = |pose| axes(&pose)[2];
        assert!(forward(HeadAngles { nod: 10.0, ..HeadAngles::default() })[1] < 0.0);
        assert!(forward(HeadAngles { turn: 10.0, ..HeadAngles::default() })[0] > 0.0);
        assert!(axes(&HeadAngles { tilt: 10.0, ..HeadAngles::default() })[1][0] > 0.0);
    }

    #[test]
    fn shapes_that_turn_the_head_stand_behind_those_of_the_face() {
        let names = ["jawOpen", "eyeLookUpLeft", "breath"].map(str::to_owned).to_vec();
        let mesh = Mesh { shapes: vec![SparseShape::default(); 3], ..Mesh::default() };
        let avatar = Avatar { shape_names: names, meshes: vec![mesh], ..Avatar::default() };
        let turned = avatar.with_head_pose_shapes();
        assert_eq!(turned.shape_names[2..5], HEAD_POSE_SHAPES);
        assert_eq!((turned.shape_names.len(), turned.meshes[0].shapes.len()), (6, 6));
        assert_eq!(turned.face_shapes(), ["jawOpen", "eyeLookUpLeft"]);
        assert_eq!(turned.clone().with_head_pose_shapes(), turned);
    }
}
