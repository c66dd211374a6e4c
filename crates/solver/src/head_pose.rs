//! The head's motion in each frame, from its markers, and its low-pass (thesis 5.2.1).

use crate::front_end_error::FrontEndError;
use crate::lowpass::Lowpass;
use crate::marker_frames::{MarkerColumns, MarkerFrames, point};
use crate::rigid_alignment::{Pose, RigidMotion, align};

/// The head markers of the first frame, metres.
pub(crate) fn head_reference(take: MarkerFrames<'_>, columns: &MarkerColumns) -> Vec<[f64; 3]> {
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
    reference: &[[f64; 3]],
    lowpass: Option<&Lowpass>,
) -> Result<Vec<RigidMotion>, FrontEndError> {
    let Some(head) = &columns.head else {
        return Ok(vec![RigidMotion::IDENTITY; take.len()]);
    };
    let mut poses = Vec::with_capacity(take.len());
    for frame in 0..take.len() {
        let here = take.frame(frame);
        let pairs = head.iter().map(|&c| point(here, c)).zip(reference.iter().copied());
        poses.push(align(pairs).map_err(|cause| FrontEndError::Head { frame, cause })?);
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
    let Some(anchor) = poses.first().map(|p| p.to_centroid) else { return };
    let mut tracks: [Vec<f64>; 7] = Default::default();
    let mut last = [1.0, 0.0, 0.0, 0.0];
    for pose in poses.iter() {
        let mut q = pose.quaternion;
        if (0..4).fold(0.0, |s, k| s + q[k] * last[k]) < 0.0 {
            q = q.map(|x| -x);
        }
        last = q;
        let at = pose.motion().inverse().apply(anchor);
        for k in 0..4 {
            tracks[k].push(q[k]);
        }
        for k in 0..3 {
            tracks[4 + k].push(at[k]);
        }
    }
    for track in &mut tracks {
        lowpass.filter(track);
    }
    for (i, pose) in poses.iter_mut().enumerate() {
        let q: [f64; 4] = std::array::from_fn(|k| tracks[k][i]);
        let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        *pose = Pose {
            quaternion: q.map(|x| x / length),
            from_centroid: std::array::from_fn(|k| tracks[4 + k][i]),
            to_centroid: anchor,
        };
    }
}
