//! The head's own motion, as weights of the shapes that turn it: what the head markers tell and the front end takes out
//! of the face.

use std::ops::Range;

use mimique_avatar::{HEAD_POSE_SHAPES, HeadAngles};
use mimique_geometry::RigidMotion;
use mimique_solver::FrontEnd;

use super::JoinedTake;

impl JoinedTake<'_> {
    /// Names of the shapes that turn the head and their weights in some frames, a row each; nothing where the head is
    /// shown still. `poses` hold the head still in all frames.
    pub(crate) fn head_tracks(
        &self,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
        frames: Range<usize>,
    ) -> (Vec<String>, Vec<f64>) {
        if self.head_motion == 0.0 || self.columns.head.is_none() {
            return (Vec::new(), Vec::new());
        }
        // At rest is the head that the neutral face has.
        let rest = poses[(self.neutral.start + self.neutral.end) / 2].rotation;
        let to_avatar = front_end.avatar_from_actor().rotation;
        let weights = poses[frames].iter().flat_map(|pose| {
            let turned = to_avatar * rest * pose.rotation.transpose() * to_avatar.transpose();
            let angles = HeadAngles::of_axes(turned.to_cols_array_2d());
            angles.weights().map(|weight| self.head_motion * weight)
        });
        (HEAD_POSE_SHAPES.map(str::to_owned).to_vec(), weights.collect())
    }
}
