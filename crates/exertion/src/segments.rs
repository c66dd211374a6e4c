//! The segments of a body and what they weigh (Winter 2009, table 4.1).

use mimique_mocap::BodyJoint;

/// An end of a segment: a joint, or the middle of two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// One joint.
    At(BodyJoint),
    /// Half way between two.
    Between(BodyJoint, BodyJoint),
}

/// A segment: where it begins and ends, its share of the body's mass, where its centre of mass lies from
/// its beginning, and its radius of gyration about that centre, both in lengths of the segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Segment {
    pub name: &'static str,
    pub from: End,
    pub to: End,
    pub mass: f64,
    pub centre: f64,
    pub gyration: f64,
}

use BodyJoint as J;
use End::{At, Between};

const MID_HIP: End = Between(J::LeftHip, J::RightHip);
const MID_SHOULDER: End = Between(J::LeftShoulder, J::RightShoulder);

const fn segment(name: &'static str, [from, to]: [End; 2], numbers: [f64; 3]) -> Segment {
    Segment { name, from, to, mass: numbers[0], centre: numbers[1], gyration: numbers[2] }
}

/// The trunk, which carries what is on the back.
pub(crate) const TRUNK: &str = "trunk";

const TRUNK_AND_HEAD: [Segment; 2] = [
    segment(TRUNK, [MID_HIP, MID_SHOULDER], [0.497, 0.5, 0.371]),
    segment("head", [At(J::Neck), At(J::HeadTop)], [0.081, 0.5, 0.303]),
];

/// A side's names and joints.
struct Side {
    names: [&'static str; 6],
    joints: [BodyJoint; 8],
}

const SIDES: [Side; 2] = [
    Side {
        names: ["leftUpperArm", "leftForearm", "leftHand", "leftThigh", "leftShank", "leftFoot"],
        joints: [
            J::LeftShoulder,
            J::LeftElbow,
            J::LeftWrist,
            J::LeftHandEnd,
            J::LeftHip,
            J::LeftKnee,
            J::LeftAnkle,
            J::LeftToe,
        ],
    },
    Side {
        names: [
            "rightUpperArm",
            "rightForearm",
            "rightHand",
            "rightThigh",
            "rightShank",
            "rightFoot",
        ],
        joints: [
            J::RightShoulder,
            J::RightElbow,
            J::RightWrist,
            J::RightHandEnd,
            J::RightHip,
            J::RightKnee,
            J::RightAnkle,
            J::RightToe,
        ],
    },
];

/// Mass, centre and radius of gyration of a forearm, of one with its hand, of a shank, and of one with its
/// foot.
const FOREARM: [f64; 3] = [0.016, 0.43, 0.303];
const FOREARM_AND_HAND: [f64; 3] = [0.022, 0.682, 0.468];
const SHANK: [f64; 3] = [0.0465, 0.433, 0.302];
const SHANK_AND_FOOT: [f64; 3] = [0.061, 0.606, 0.416];

/// The segments of a body. Without the end of a hand its mass goes with the forearm, whose ends stay;
/// likewise foot and shank.
pub(crate) fn segments(has: impl Fn(BodyJoint) -> bool) -> Vec<Segment> {
    let mut all = TRUNK_AND_HEAD.to_vec();
    for Side { names, joints } in &SIDES {
        let [shoulder, elbow, wrist, hand_end, hip, knee, ankle, toe] = joints.map(At);
        let [upper_arm, forearm, hand, thigh, shank, foot] = *names;
        all.push(segment(upper_arm, [shoulder, elbow], [0.028, 0.436, 0.322]));
        if has(joints[3]) {
            all.push(segment(forearm, [elbow, wrist], FOREARM));
            all.push(segment(hand, [wrist, hand_end], [0.006, 0.506, 0.297]));
        } else {
            all.push(segment(forearm, [elbow, wrist], FOREARM_AND_HAND));
        }
        all.push(segment(thigh, [hip, knee], [0.1, 0.433, 0.323]));
        if has(joints[7]) {
            all.push(segment(shank, [knee, ankle], SHANK));
            all.push(segment(foot, [ankle, toe], [0.0145, 0.5, 0.475]));
        } else {
            all.push(segment(shank, [knee, ankle], SHANK_AND_FOOT));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_masses_make_one_body_with_and_without_hands_and_feet() {
        for has in [|_: BodyJoint| true, |joint: BodyJoint| !joint.may_be_missing()] {
            let sum: f64 = segments(has).iter().map(|segment| segment.mass).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        }
        assert_eq!(segments(|_| true).len(), 14);
        assert_eq!(segments(|joint| joint != J::LeftHandEnd).len(), 13);
        let merged = segments(|joint| joint != J::LeftHandEnd);
        let of = |name: &str| *merged.iter().find(|segment| segment.name == name).unwrap();
        assert_eq!((of("leftForearm").mass, of("rightForearm").mass), (0.022, 0.016));
    }
}
