//! The head's motion in each frame, from its markers, and its low-pass (thesis 5.2.1).

use mimique_geometry::{DQuat, Point, Pose, RigidMotion, best_pose};

use crate::front_end::error::FrontEndError;
use crate::front_end::lowpass::Lowpass;
use crate::front_end::marker_frames::{MarkerColumns, MarkerFrames, point};

/// The head markers of the first frame, metres.
pub(crate) fn head_reference(take: MarkerFrames<'_>, columns: &MarkerColumns) -> Vec<Point> {
    let head = columns.head.as_deref().unwrap_or_default();
    if take.is_empty() {
        Vec::new()
    } else {
        head.iter().map(|&c| point(take.frame(0), c)).collect()
    }
}

/// For each frame the motion that takes the head markers back to the reference.
pub(crate) fn head_poses(
    take: MarkerFrames<'_>,
    columns: &MarkerColumns,
    reference: &[Point],
    lowpass: Option<&Lowpass>,
) -> Result<Vec<RigidMotion>, FrontEndError> {
    let Some(head) = &columns.head else {
        return Ok(vec![RigidMotion::IDENTITY; take.len()]);
    };
    let mut poses = Vec::with_capacity(take.len());
    for frame in 0..take.len() {
        let here = take.frame(frame);
        let pairs = head.iter().map(|&c| point(here, c)).zip(reference.iter().copied());
        poses.push(best_pose(pairs).map_err(|cause| FrontEndError::Head { frame, cause })?);
    }
    if let Some(lowpass) = lowpass {
        smooth(&mut poses, lowpass);
    }
    Ok(poses.iter().map(Pose::motion).collect())
}

/// Low-pass the motion of the head: its turn as a quaternion, and where it takes the reference's
/// centroid from.
fn smooth(poses: &mut [Pose], lowpass: &Lowpass) {
    // Markers that come and go move the centroid of a frame; the place of one and the same point
    // of the head does not jump.
    let Some(anchor) = poses.first().map(|pose| pose.to) else { return };
    let mut tracks: [Vec<f64>; 7] = Default::default();
    let mut last = DQuat::IDENTITY;
    for pose in poses.iter() {
        // Of the two quaternions of a turn the one nearer to that of the frame before.
        let turn = if pose.rotation.dot(last) < 0.0 { -pose.rotation } else { pose.rotation };
        last = turn;
        let at = pose.motion().inverse().apply(anchor);
        for (track, value) in
            tracks.iter_mut().zip([turn.x, turn.y, turn.z, turn.w, at.x, at.y, at.z])
        {
            track.push(value);
        }
    }
    for track in &mut tracks {
        lowpass.filter(track);
    }
    for (frame, pose) in poses.iter_mut().enumerate() {
        let [x, y, z, w, at_x, at_y, at_z] = tracks.each_ref().map(|track| track[frame]);
        let turn = DQuat::from_xyzw(x, y, z, w);
        *pose = Pose {
            rotation: turn * (1.0 / turn.length()),
            from: Point::new(at_x, at_y, at_z),
            to: anchor,
        };
    }
}
