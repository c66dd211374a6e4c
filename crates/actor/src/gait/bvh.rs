//! A gait as a BVH file: a skeleton in centimetres, and the angles of its joints in every frame.

use std::f64::consts::PI;
use std::fmt::Write as _;

use super::Gait;
use super::leg::{LegAngles, Lengths};

/// A joint: its name, its offset from its parent in statures, and how many joints hang on it.
struct Joint {
    name: &'static str,
    offset: [f64; 3],
    children: &'static [Joint],
    /// The end of the chain, in statures, where nothing hangs on it.
    end: [f64; 3],
}

const fn joint(name: &'static str, offset: [f64; 3], children: &'static [Joint]) -> Joint {
    Joint { name, offset, children, end: [0.0; 3] }
}

const fn last(name: &'static str, offset: [f64; 3], end: [f64; 3]) -> Joint {
    Joint { name, offset, children: &[], end }
}

/// The skeleton, arms down, +Y up, +Z forwards, +X to the left (Winter 2009, figure 4.1).
static HIPS: Joint = joint(
    "Hips",
    [0.0; 3],
    &[
        joint(
            "LeftUpLeg",
            [0.052, 0.0, 0.0],
            &[joint(
                "LeftLeg",
                [0.0, -0.245, 0.0],
                &[joint(
                    "LeftFoot",
                    [0.0, -0.246, 0.0],
                    &[last("LeftToeBase", [0.0, -0.039, 0.09], [0.0, 0.0, 0.03])],
                )],
            )],
        ),
        joint(
            "RightUpLeg",
            [-0.052, 0.0, 0.0],
            &[joint(
                "RightLeg",
                [0.0, -0.245, 0.0],
                &[joint(
                    "RightFoot",
                    [0.0, -0.246, 0.0],
                    &[last("RightToeBase", [0.0, -0.039, 0.09], [0.0, 0.0, 0.03])],
                )],
            )],
        ),
        joint(
            "Spine",
            [0.0, 0.1, 0.0],
            &[
                joint("Neck", [0.0, 0.22, 0.0], &[last("Head", [0.0, 0.05, 0.0], [0.0, 0.1, 0.0])]),
                joint(
                    "LeftShoulder",
                    [0.02, 0.19, 0.0],
                    &[joint(
                        "LeftArm",
                        [0.09, 0.0, 0.0],
                        &[joint(
                            "LeftForeArm",
                            [0.0, -0.186, 0.0],
                            &[last("LeftHand", [0.0, -0.146, 0.0], [0.0, -0.055, 0.0])],
                        )],
                    )],
                ),
                joint(
                    "RightShoulder",
                    [-0.02, 0.19, 0.0],
                    &[joint(
                        "RightArm",
                        [-0.09, 0.0, 0.0],
                        &[joint(
                            "RightForeArm",
                            [0.0, -0.186, 0.0],
                            &[last("RightHand", [0.0, -0.146, 0.0], [0.0, -0.055, 0.0])],
                        )],
                    )],
                ),
            ],
        ),
    ],
);

/// A gait of a person of a stature in m, for so many seconds. Turned about Y, then X: a joint's channels in
/// the file.
pub fn gait_bvh(gait: &Gait, stature: f64, seconds: f64, rate_hz: f64) -> String {
    let frames = (seconds * rate_hz).round().max(1.0) as usize;
    let mut text = String::from("HIERARCHY\n");
    write_joint(&mut text, &HIPS, stature, 0);
    let _ = writeln!(text, "MOTION\nFrames: {frames}\nFrame Time: {:.8}", 1.0 / rate_hz);
    let lengths = Lengths::of_stature(stature);
    let height = gait.hip_height(&lengths);
    for frame in 0..frames {
        let t = frame as f64 / rate_hz;
        write_frame(&mut text, gait, &lengths, height, t);
    }
    text
}

fn write_joint(text: &mut String, joint: &Joint, stature: f64, depth: usize) {
    let tab = "\t".repeat(depth);
    let offset = |[x, y, z]: [f64; 3]| {
        let [x, y, z] = [x, y, z].map(|share| 100.0 * stature * share);
        format!("OFFSET {x:.4} {y:.4} {z:.4}")
    };
    let (kind, channels) = match depth {
        0 => ("ROOT", "6 Xposition Yposition Zposition Yrotation Xrotation Zrotation"),
        _ => ("JOINT", "3 Yrotation Xrotation Zrotation"),
    };
    let _ = writeln!(text, "{tab}{kind} {}\n{tab}{{", joint.name);
    let _ = writeln!(text, "{tab}\t{}\n{tab}\tCHANNELS {channels}", offset(joint.offset));
    for child in joint.children {
        write_joint(text, child, stature, depth + 1);
    }
    if joint.children.is_empty() {
        let _ =
            writeln!(text, "{tab}\tEnd Site\n{tab}\t{{\n{tab}\t\t{}\n{tab}\t}}", offset(joint.end));
    }
    let _ = writeln!(text, "{tab}}}");
}

/// The angles of a joint about Y and X, degrees.
type Turn = [f64; 2];

fn write_frame(text: &mut String, gait: &Gait, lengths: &Lengths, height: f64, t: f64) {
    let share = t * gait.stride_hz;
    let hips = height + gait.bounce_at(share);
    let swing = libm::cos(2.0 * PI * (share - gait.reach * gait.duty / 2.0));
    // The left leg is before the hips when it lands: the hips turn with it, the shoulders against it.
    let hip_turn = -gait.hip_turn * swing;
    let shoulder_turn = gait.shoulder_turn * swing;
    let forwards = gait.speed * t + gait.surge_at(share);
    let _ = write!(text, "0 {:.4} {:.4}", 100.0 * hips, 100.0 * forwards);
    let mut write = |[y, x]: Turn| {
        let _ = write!(text, " {y:.4} {x:.4} 0");
    };
    write([hip_turn, 0.0]);
    for side in [0.0, 0.5] {
        let LegAngles { hip, knee, foot } = gait.leg(lengths, share + side, hips);
        let [hip, knee, foot] = [hip, knee, foot].map(f64::to_degrees);
        write([-hip_turn, -hip]);
        write([0.0, knee]);
        write([0.0, hip - knee - foot]);
        // The toes stay on the ground while the foot rolls over its ball.
        write([0.0, foot.clamp(-30.0, 0.0)]);
    }
    write([shoulder_turn - hip_turn, gait.lean]);
    write([-shoulder_turn, -gait.lean / 2.0]);
    write([0.0, -gait.lean / 2.0]);
    for side in [-1.0, 1.0] {
        // An arm goes forwards with the leg of the other side.
        let forwards = side * swing;
        write([0.0, 0.0]);
        write([0.0, -gait.lean - gait.arm_swing * forwards]);
        write([0.0, -gait.elbow[0] - gait.elbow[1] * forwards]);
        write([0.0, 0.0]);
    }
    text.push('\n');
}
