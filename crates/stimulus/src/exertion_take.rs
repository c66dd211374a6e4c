//! The face of a body that exerts itself: a motion, a person and a duration in, weights out.

use mimique_actor::{Gait, gait_bvh};
use mimique_exertion::{
    BodyOptions, Clip, Convention, ExertionError, FRAMES_PER_SECOND, Face, Heart, HeartModel,
    MotionWork, Person, Plan, Series, Start, Window,
};
use mimique_mocap::{BodyJoints, BodyJointsError, Capture, read_bytes};
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

/// What a body does for a while, and its face.
#[derive(Debug, Clone, PartialEq)]
pub struct ExertionTake {
    /// The body and its work.
    pub motion: MotionWork,
    /// How long it goes on, s.
    pub span_s: f64,
    /// What the body does, second after second.
    pub series: Series,
    /// The face from the beginning on, 60 frames per second.
    pub clip: Clip,
}

/// The face of an exertion cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExertionTakeError {
    /// The motion has no body's joints.
    #[error(transparent)]
    Joints(#[from] BodyJointsError),
    /// A number of motion or duration is none that can be computed with.
    #[error(transparent)]
    Exertion(#[from] ExertionError),
}

impl ExertionTake {
    /// Of a motion that goes on for `seconds`. A shorter motion repeats its work, not its positions, whose
    /// jump back would be work that nobody did; coordinates are low-passed and made to fit the stature.
    ///
    /// # Errors
    /// [`ExertionTakeError`]: joints that are missing or unseen, a motion that is too short or too slow, a
    /// duration that is none.
    pub fn of(
        motion: &Capture,
        seconds: f64,
        person: &Person,
        law: HeartModel,
        face: &Face,
    ) -> Result<Self, ExertionTakeError> {
        let joints = BodyJoints::find(&motion.labels)?;
        let options = BodyOptions::default();
        let motion = MotionWork::of(motion, &joints, person, &options, Convention::Segments)?;
        let plan = Plan::of(motion.part(seconds))?;
        let series = Series::of(person, &plan, Heart::Law(law), Start::default())?;
        let span_s = plan.span_s();
        let window = Window { seconds: [0.0, span_s], rate_hz: FRAMES_PER_SECOND };
        let clip = Clip::of(person, &plan, &series, &window, face)?;
        Ok(Self { motion, span_s, series, clip })
    }
}
