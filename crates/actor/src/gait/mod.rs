//! The built-in actor's body: a walk, a run and a sprint, made by code, as BVH.
//!
//! Feet stand still on the ground while they bear the body, legs follow by inverse kinematics, arms and
//! trunk swing against them. Speeds, step rates and times on the ground are those of people (Winter 2009;
//! Cavagna 1988); nobody was recorded.

mod bvh;
mod curve;
mod leg;

pub use bvh::gait_bvh;

/// How somebody walks or runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gait {
    /// What it is called.
    pub name: &'static str,
    /// m/s.
    pub speed: f64,
    /// Strides (two steps) per second.
    pub stride_hz: f64,
    /// Share of a stride in which a foot is on the ground.
    pub duty: f64,
    /// Share of a foot's way on the ground that lies before the hips.
    pub reach: f64,
    /// How high the hips go up and down, twice a stride, m; below 0 they are lowest when a foot is under them.
    pub bounce: f64,
    /// How much slower than the mean the hips are when a foot is under them, and faster between, m/s.
    pub surge: f64,
    /// How much the ankle rises in the swing beyond what the foot's rolling lifts it, m.
    pub lift: f64,
    /// How fast a foot goes back under the body when it lands, in speeds of the body: 1 lands without a blow.
    pub retraction: f64,
    /// Pitch of the foot over a stride from its landing on: share of the stride and degrees, toes up above 0.
    pub foot_pitch: &'static [[f64; 2]],
    /// Turning of the hips about the vertical, degrees to each side; the shoulders turn against them.
    pub hip_turn: f64,
    /// The same of the shoulders.
    pub shoulder_turn: f64,
    /// Lean of the trunk, degrees forwards.
    pub lean: f64,
    /// Swing of the upper arms, degrees to each side.
    pub arm_swing: f64,
    /// Bend of the elbows, degrees, and how much more at the end of the forward swing.
    pub elbow: [f64; 2],
}

impl Gait {
    /// A brisk walk, 1.5 m/s.
    pub const WALK: Self = Self {
        name: "walk",
        speed: 1.5,
        stride_hz: 0.95,
        duty: 0.62,
        reach: 0.38,
        bounce: 0.018,
        surge: 0.1,
        lift: 0.035,
        retraction: 0.8,
        foot_pitch: &[
            [0.0, 18.0],
            [0.08, 0.0],
            [0.38, 0.0],
            [0.62, -58.0],
            [0.78, -12.0],
            [0.92, 14.0],
        ],
        hip_turn: 5.0,
        shoulder_turn: 6.0,
        lean: 3.0,
        arm_swing: 18.0,
        elbow: [18.0, 14.0],
    };

    /// An easy run, 2.8 m/s.
    pub const RUN: Self = Self {
        name: "run",
        speed: 2.8,
        stride_hz: 1.38,
        duty: 0.38,
        reach: 0.38,
        bounce: -0.036,
        surge: 0.05,
        lift: 0.17,
        retraction: 0.7,
        foot_pitch: &[
            [0.0, 10.0],
            [0.06, 0.0],
            [0.2, 0.0],
            [0.38, -62.0],
            [0.6, -85.0],
            [0.85, 6.0],
        ],
        hip_turn: 7.0,
        shoulder_turn: 9.0,
        lean: 6.0,
        arm_swing: 26.0,
        elbow: [80.0, 18.0],
    };

    /// A sprint, 6 m/s.
    pub const SPRINT: Self = Self {
        name: "sprint",
        speed: 6.0,
        stride_hz: 1.85,
        duty: 0.23,
        reach: 0.43,
        bounce: -0.024,
        surge: 0.1,
        lift: 0.24,
        retraction: 0.5,
        foot_pitch: &[
            [0.0, -4.0],
            [0.08, -6.0],
            [0.23, -66.0],
            [0.5, -95.0],
            [0.75, -10.0],
            [0.9, 4.0],
        ],
        hip_turn: 10.0,
        shoulder_turn: 14.0,
        lean: 10.0,
        arm_swing: 40.0,
        elbow: [88.0, 26.0],
    };

    /// All of them.
    pub const ALL: [Self; 3] = [Self::WALK, Self::RUN, Self::SPRINT];
}
