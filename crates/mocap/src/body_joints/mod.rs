//! Which markers of a capture are the joints of a body: by the names that recording systems give
//! them, or by a map of the user's.

mod namings;

use std::collections::BTreeMap;

use namings::{NAMINGS, plain};

/// A place of the body whose motion is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyJoint {
    /// Centre of the hip joint.
    LeftHip,
    /// Centre of the knee.
    LeftKnee,
    /// Centre of the ankle.
    LeftAnkle,
    /// Ball or tip of the foot; may be missing.
    LeftToe,
    /// Centre of the hip joint.
    RightHip,
    /// Centre of the knee.
    RightKnee,
    /// Centre of the ankle.
    RightAnkle,
    /// Ball or tip of the foot; may be missing.
    RightToe,
    /// Base of the neck.
    Neck,
    /// Top of the head.
    HeadTop,
    /// Centre of the shoulder joint.
    LeftShoulder,
    /// Centre of the elbow.
    LeftElbow,
    /// Centre of the wrist.
    LeftWrist,
    /// Knuckles or tip of the hand; may be missing.
    LeftHandEnd,
    /// Centre of the shoulder joint.
    RightShoulder,
    /// Centre of the elbow.
    RightElbow,
    /// Centre of the wrist.
    RightWrist,
    /// Knuckles or tip of the hand; may be missing.
    RightHandEnd,
}

use BodyJoint::{
    HeadTop, LeftAnkle, LeftElbow, LeftHandEnd, LeftHip, LeftKnee, LeftShoulder, LeftToe,
    LeftWrist, Neck, RightAnkle, RightElbow, RightHandEnd, RightHip, RightKnee, RightShoulder,
    RightToe, RightWrist,
};

impl BodyJoint {
    /// How many there are.
    pub const COUNT: usize = 18;

    /// All of them, in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] = [
        LeftHip,
        LeftKnee,
        LeftAnkle,
        LeftToe,
        RightHip,
        RightKnee,
        RightAnkle,
        RightToe,
        Neck,
        HeadTop,
        LeftShoulder,
        LeftElbow,
        LeftWrist,
        LeftHandEnd,
        RightShoulder,
        RightElbow,
        RightWrist,
        RightHandEnd,
    ];

    /// The name in maps and messages: `leftHip`.
    pub fn name(self) -> &'static str {
        match self {
            LeftHip => "leftHip",
            LeftKnee => "leftKnee",
            LeftAnkle => "leftAnkle",
            LeftToe => "leftToe",
            RightHip => "rightHip",
            RightKnee => "rightKnee",
            RightAnkle => "rightAnkle",
            RightToe => "rightToe",
            Neck => "neck",
            HeadTop => "headTop",
            LeftShoulder => "leftShoulder",
            LeftElbow => "leftElbow",
            LeftWrist => "leftWrist",
            LeftHandEnd => "leftHandEnd",
            RightShoulder => "rightShoulder",
            RightElbow => "rightElbow",
            RightWrist => "rightWrist",
            RightHandEnd => "rightHandEnd",
        }
    }

    /// The joint of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|joint| joint.name() == name)
    }

    /// Whether a body without it can still be computed: ends of hands and feet.
    pub fn may_be_missing(self) -> bool {
        matches!(self, LeftToe | RightToe | LeftHandEnd | RightHandEnd)
    }
}

/// Why markers are not taken for the joints of a body.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BodyJointsError {
    /// No naming of skeletons that is known has all joints among the labels.
    #[error(
        "joints: {} not found by the names of {known} (the capture has {}); \
         say which marker is which joint with --joints MAP",
        missing.iter().map(|joint| joint.name()).collect::<Vec<_>>().join(", "),
        sample(labels)
    )]
    Unknown {
        /// What the naming that fits best lacks.
        missing: Vec<BodyJoint>,
        /// The naming that fits best.
        known: &'static str,
        /// The labels that there are.
        labels: Vec<String>,
    },
    /// A map is no JSON object of texts.
    #[error(
        "line {line}, column {column}: no map of joints; write {{\"leftHip\": \"LABEL\", ...}}"
    )]
    NoMap {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
    /// A map names a joint that there is not.
    #[error(
        "{joint}: no such joint; the joints are {}",
        BodyJoint::ALL.map(BodyJoint::name).join(", ")
    )]
    NoSuchJoint {
        /// The name.
        joint: String,
    },
    /// A map names a marker that the capture does not have.
    #[error("{}: no marker {label:?} in the capture (it has {}); correct the map", joint.name(), sample(labels))]
    NoSuchMarker {
        /// The joint.
        joint: BodyJoint,
        /// The label that the map gives it.
        label: String,
        /// The labels that there are.
        labels: Vec<String>,
    },
    /// A joint that every body needs is in no map.
    #[error("{}: not in the map; name its marker", joint.name())]
    NotMapped {
        /// The joint.
        joint: BodyJoint,
    },
}

/// The first labels, to recognise a capture by.
fn sample(labels: &[String]) -> String {
    let first: Vec<&str> = labels.iter().take(8).map(String::as_str).collect();
    let more = if labels.len() > first.len() { ", ..." } else { "" };
    format!("{}{more}", first.join(", "))
}

/// The markers that are the joints of a body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BodyJoints {
    markers: [Option<usize>; BodyJoint::COUNT],
    /// The naming that they were found by; `None` for a map.
    pub naming: Option<&'static str>,
}

impl BodyJoints {
    /// The joints among the labels of a capture, by the first naming that has all of them.
    ///
    /// # Errors
    /// [`BodyJointsError::Unknown`] where none has.
    pub fn find(labels: &[String]) -> Result<Self, BodyJointsError> {
        let plain: Vec<String> = labels.iter().map(|label| plain(label)).collect();
        let mut nearest: Option<(Vec<BodyJoint>, &'static str)> = None;
        for naming in &NAMINGS {
            let find = |joint| {
                let names = naming.names_of(joint);
                names.iter().find_map(|name| plain.iter().position(|label| label == name))
            };
            let markers = BodyJoint::ALL.map(find);
            let is_missing =
                |joint: &BodyJoint| !joint.may_be_missing() && markers[*joint as usize].is_none();
            let missing: Vec<BodyJoint> = BodyJoint::ALL.into_iter().filter(is_missing).collect();
            if missing.is_empty() {
                return Ok(Self { markers, naming: Some(naming.name) });
            }
            if nearest.as_ref().is_none_or(|(least, _)| missing.len() < least.len()) {
                nearest = Some((missing, naming.name));
            }
        }
        let (missing, known) = nearest.unwrap_or_default();
        Err(BodyJointsError::Unknown { missing, known, labels: labels.to_vec() })
    }

    /// The joints that a map names, of the markers of a capture. A label may lack the subject's name
    /// before a colon, as in a marker map.
    ///
    /// # Errors
    /// [`BodyJointsError`]: an unknown joint or marker, or a joint that is not in the map.
    pub fn of_map(
        map: &BTreeMap<String, String>,
        labels: &[String],
    ) -> Result<Self, BodyJointsError> {
        let mut markers = [None; BodyJoint::COUNT];
        for (name, label) in map {
            let joint = BodyJoint::by_name(name)
                .ok_or_else(|| BodyJointsError::NoSuchJoint { joint: name.clone() })?;
            let marker = crate::capture::marker_index(labels, label).ok_or_else(|| {
                BodyJointsError::NoSuchMarker {
                    joint,
                    label: label.clone(),
                    labels: labels.to_vec(),
                }
            })?;
            markers[joint as usize] = Some(marker);
        }
        let lacks =
            |joint: &BodyJoint| !joint.may_be_missing() && markers[*joint as usize].is_none();
        match BodyJoint::ALL.into_iter().find(lacks) {
            Some(joint) => Err(BodyJointsError::NotMapped { joint }),
            None => Ok(Self { markers, naming: None }),
        }
    }

    /// The same of a map as JSON text: `{"leftHip": "LABEL", ...}`.
    ///
    /// # Errors
    /// [`BodyJointsError`]; [`BodyJointsError::NoMap`] with the place in the text.
    pub fn of_json(text: &str, labels: &[String]) -> Result<Self, BodyJointsError> {
        let map = serde_json::from_str(text).map_err(|error| BodyJointsError::NoMap {
            line: error.line(),
            column: error.column(),
        })?;
        Self::of_map(&map, labels)
    }

    /// The marker of a joint: its place among the capture's labels.
    pub fn marker(&self, joint: BodyJoint) -> Option<usize> {
        self.markers[joint as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(names: &str) -> Vec<String> {
        names.split_whitespace().map(str::to_owned).collect()
    }

    fn found(names: &str) -> (BodyJoints, Vec<String>) {
        let labels = labels(names);
        (BodyJoints::find(&labels).unwrap(), labels)
    }

    fn label_of(found: &(BodyJoints, Vec<String>), joint: BodyJoint) -> Option<&str> {
        found.0.marker(joint).map(|marker| found.1[marker].as_str())
    }

    #[test]
    fn mixamo_with_its_prefix() {
        let found = found(
            "mixamorig:Hips mixamorig:LeftUpLeg mixamorig:LeftLeg mixamorig:LeftFoot \
             mixamorig:LeftToeBase mixamorig:LeftToe_End mixamorig:RightUpLeg mixamorig:RightLeg \
             mixamorig:RightFoot mixamorig:RightToeBase mixamorig:Spine mixamorig:Neck mixamorig:Head \
             mixamorig:HeadTop_End mixamorig:LeftShoulder mixamorig:LeftArm mixamorig:LeftForeArm \
             mixamorig:LeftHand mixamorig:LeftHandMiddle1 mixamorig:RightShoulder mixamorig:RightArm \
             mixamorig:RightForeArm mixamorig:RightHand",
        );
        assert_eq!(label_of(&found, LeftHip), Some("mixamorig:LeftUpLeg"));
        assert_eq!(
            label_of(&found, LeftShoulder),
            Some("mixamorig:LeftArm"),
            "not the collar bone"
        );
        assert_eq!(label_of(&found, HeadTop), Some("mixamorig:HeadTop_End"));
        assert_eq!(label_of(&found, LeftHandEnd), Some("mixamorig:LeftHandMiddle1"));
        assert_eq!(label_of(&found, RightHandEnd), None);
    }

    #[test]
    fn xsens_calls_the_shoulder_a_shoulder() {
        let found = found(
            "Hips Chest Neck Head Head_end RightCollar RightShoulder RightElbow RightWrist \
             RightWrist_end LeftCollar LeftShoulder LeftElbow LeftWrist RightHip RightKnee RightAnkle \
             RightToe LeftHip LeftKnee LeftAnkle LeftToe",
        );
        assert_eq!(label_of(&found, RightShoulder), Some("RightShoulder"));
        assert_eq!(label_of(&found, RightHandEnd), Some("RightWrist_end"));
        assert_eq!(found.0.naming, Some("Xsens (BVH)"));
    }

    #[test]
    fn segments_of_xsens() {
        let found = found(
            "Pelvis L5 L3 T12 T8 Neck Head Right_Shoulder Right_Upper_Arm Right_Forearm Right_Hand \
             Left_Shoulder Left_Upper_Arm Left_Forearm Left_Hand Right_Upper_Leg Right_Lower_Leg \
             Right_Foot Right_Toe Left_Upper_Leg Left_Lower_Leg Left_Foot Left_Toe",
        );
        assert_eq!(label_of(&found, RightShoulder), Some("Right_Upper_Arm"));
        assert_eq!(label_of(&found, LeftKnee), Some("Left_Lower_Leg"));
        assert_eq!(label_of(&found, LeftToe), Some("Left_Toe"));
    }

    #[test]
    fn bones_of_cmu() {
        let found = found(
            "root lhipjoint lfemur ltibia lfoot ltoes rhipjoint rfemur rtibia rfoot rtoes lowerneck \
             upperneck head head_end lclavicle lhumerus lradius lwrist lhand lfingers rclavicle \
             rhumerus rradius rwrist rhand rfingers",
        );
        assert_eq!(label_of(&found, LeftKnee), Some("ltibia"));
        assert_eq!(label_of(&found, RightHandEnd), Some("rfingers"));
        assert_eq!(label_of(&found, RightToe), Some("rtoes"));
    }

    #[test]
    fn what_is_missing_is_named_with_the_naming_that_fits_best() {
        let labels = labels(
            "Hips LeftUpLeg LeftFoot RightUpLeg RightLeg RightFoot Neck Neck_end LeftArm LeftForeArm \
             LeftHand RightArm RightForeArm RightHand",
        );
        let said = BodyJoints::find(&labels).unwrap_err().to_string();
        assert!(said.starts_with("joints: leftKnee not found by the names of Mixamo"), "{said}");
        assert!(said.ends_with("with --joints MAP"), "{said}");
    }

    #[test]
    fn a_map_names_markers_and_what_is_wrong_with_it_is_said() {
        let labels = labels("s:a s:b c");
        let all = |label: &str| -> BTreeMap<String, String> {
            BodyJoint::ALL.iter().map(|j| (j.name().to_owned(), label.to_owned())).collect()
        };
        assert_eq!(BodyJoints::of_map(&all("b"), &labels).unwrap().marker(Neck), Some(1));
        let mut map = all("c");
        map.remove("leftToe");
        assert_eq!(BodyJoints::of_map(&map, &labels).unwrap().marker(LeftToe), None);
        map.remove("neck");
        let said = |map: &BTreeMap<String, String>| {
            BodyJoints::of_map(map, &labels).unwrap_err().to_string()
        };
        assert_eq!(said(&map), "neck: not in the map; name its marker");
        map.insert("nose".to_owned(), "c".to_owned());
        assert!(said(&map).starts_with("nose: no such joint; the joints are leftHip, "));
        let wrong = said(&all("d"));
        assert!(wrong.contains("no marker \"d\" in the capture (it has s:a, s:b, c)"), "{wrong}");
        let text = BodyJoints::of_json("{\n \"neck\": 3}", &labels).unwrap_err().to_string();
        assert!(text.starts_with("line 2, column 10: no map of joints"), "{text}");
    }
}
