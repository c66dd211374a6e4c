//! How recording systems and animation tools name the joints of a body.

use super::BodyJoint::{
    self, HeadTop, LeftAnkle, LeftElbow, LeftHandEnd, LeftHip, LeftKnee, LeftShoulder, LeftToe,
    LeftWrist, Neck, RightAnkle, RightElbow, RightHandEnd, RightHip, RightKnee, RightShoulder,
    RightToe, RightWrist,
};

/// How a recording system or an animation tool names the joints of a body.
pub(super) struct Naming {
    pub(super) name: &'static str,
    /// Names of the joints of the left side (right: with the other word), then of the middle, plain
    /// ([`plain`]), the preferred one first; `*` stands for the side.
    joints: [(SidedJoint, &'static [&'static str]); 8],
    neck: &'static [&'static str],
    head_top: &'static [&'static str],
    /// The words for left and right.
    sides: [&'static str; 2],
}

/// A joint that both sides have: the left one and the right one.
type SidedJoint = (BodyJoint, BodyJoint);

impl Naming {
    pub(super) fn names_of(&self, joint: BodyJoint) -> Vec<String> {
        let middle = match joint {
            Neck => Some(self.neck),
            HeadTop => Some(self.head_top),
            _ => None,
        };
        if let Some(names) = middle {
            return names.iter().map(ToString::to_string).collect();
        }
        let sided = |((left, right), names): &(SidedJoint, &'static [&'static str])| {
            let side = match joint {
                _ if joint == *left => self.sides[0],
                _ if joint == *right => self.sides[1],
                _ => return None,
            };
            Some(names.iter().map(|name| name.replace('*', side)).collect())
        };
        self.joints.iter().find_map(sided).unwrap_or_default()
    }
}

const HIP: SidedJoint = (LeftHip, RightHip);
const KNEE: SidedJoint = (LeftKnee, RightKnee);
const ANKLE: SidedJoint = (LeftAnkle, RightAnkle);
const TOE: SidedJoint = (LeftToe, RightToe);
const SHOULDER: SidedJoint = (LeftShoulder, RightShoulder);
const ELBOW: SidedJoint = (LeftElbow, RightElbow);
const WRIST: SidedJoint = (LeftWrist, RightWrist);
const HAND_END: SidedJoint = (LeftHandEnd, RightHandEnd);

/// The namings that are known. One that calls the collar bone a shoulder stands before one that calls
/// the shoulder so, and asks for an arm that the other does not have.
pub(super) static NAMINGS: [Naming; 3] = [
    Naming {
        name: "Mixamo, CMU (BVH) or Xsens (segments)",
        joints: [
            (HIP, &["*upleg", "*upperleg", "*thigh"]),
            (KNEE, &["*leg", "*lowerleg", "*shin", "*calf"]),
            (ANKLE, &["*foot"]),
            (TOE, &["*toebase", "*toe", "*footend"]),
            (SHOULDER, &["*arm", "*upperarm"]),
            (ELBOW, &["*forearm", "*lowerarm"]),
            (WRIST, &["*hand"]),
            (HAND_END, &["*handmiddle1", "*handindex1", "*handend", "*fingerbase"]),
        ],
        neck: &["neck", "neck1"],
        head_top: &["headtopend", "headend", "neckend", "head"],
        sides: ["left", "right"],
    },
    Naming {
        name: "Xsens (BVH)",
        joints: [
            (HIP, &["*hip"]),
            (KNEE, &["*knee"]),
            (ANKLE, &["*ankle"]),
            (TOE, &["*toe", "*ankleend"]),
            (SHOULDER, &["*shoulder"]),
            (ELBOW, &["*elbow"]),
            (WRIST, &["*wrist"]),
            (HAND_END, &["*wristend", "*hand"]),
        ],
        neck: &["neck"],
        head_top: &["headend", "headtop", "head"],
        sides: ["left", "right"],
    },
    Naming {
        name: "CMU (ASF)",
        joints: [
            (HIP, &["*femur"]),
            (KNEE, &["*tibia"]),
            (ANKLE, &["*foot"]),
            (TOE, &["*toes", "*footend"]),
            (SHOULDER, &["*humerus"]),
            (ELBOW, &["*radius"]),
            (WRIST, &["*wrist", "*hand"]),
            (HAND_END, &["*fingers", "*handend", "*hand"]),
        ],
        neck: &["lowerneck", "neck"],
        head_top: &["headend", "head"],
        sides: ["l", "r"],
    },
];

/// A label in small letters without the subject's name, `mixamorig`, blanks and signs.
pub(super) fn plain(label: &str) -> String {
    let own = label.rsplit_once(':').map_or(label, |(_, own)| own);
    let letters: String = own
        .chars()
        .filter(char::is_ascii_alphanumeric)
        .map(|letter| letter.to_ascii_lowercase())
        .collect();
    match letters.strip_prefix("mixamorig") {
        Some(rest) => rest.to_owned(),
        None => letters,
    }
}
