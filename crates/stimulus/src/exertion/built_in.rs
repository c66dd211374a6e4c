//! The motions of the built-in body.

use mimique_actor::{Gait, gait_bvh};
use mimique_mocap::{Capture, read_bytes};
use mimique_study::BuiltinMotion;

/// The stature of the built-in body, m.
const STATURE_M: f64 = 1.75;
/// Strides of a built-in motion, and its frames per second.
const STRIDES: f64 = 8.0;
const MOTION_HZ: f64 = 60.0;

/// A built-in motion as BVH: some strides of a person of 1.75 m, ending as they began.
pub fn built_in_bvh(gait: &Gait) -> String {
    gait_bvh(gait, STATURE_M, STRIDES / gait.stride_hz, MOTION_HZ)
}

/// The joints of a built-in motion.
pub fn built_in_motion(motion: BuiltinMotion) -> Capture {
    let gait = match motion {
        BuiltinMotion::Walk => &Gait::WALK,
        BuiltinMotion::Run => &Gait::RUN,
        BuiltinMotion::Sprint => &Gait::SPRINT,
    };
    read_bytes(built_in_bvh(gait).as_bytes()).expect("our own BVH is read")
}
