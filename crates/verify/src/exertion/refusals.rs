//! `errors/`: inputs that must be refused, and the place that the refusal must name.

use std::collections::BTreeMap;
use std::path::Path;

use mimique_exertion::{
    Body, BodyOptions, ExertionError, HeartModel, Person, PersonSpec, RecordedHeart, Scale,
    SupportVectors, Up,
};
use mimique_exertion_training::TrainingError;
use mimique_geometry::Point;
use mimique_mocap::{BodyJoint, BodyJoints, Capture, LengthUnit};
use serde_json::{Value, json};

use super::{Answers, Asked, FOLDERS, Stop};
use crate::case::Tolerance;
use crate::document::{Document, Part};
use crate::{Case, VerifyError};

/// The stages of refusals and what refuses: the place that it names, or nothing.
const STAGES: [(&str, Stage); 5] = [
    ("character", character),
    ("heart", heart),
    ("recorded", recorded),
    ("svr", support_vectors),
    ("work", work),
];

type Stage = fn(&Part<'_>) -> Result<Option<String>, VerifyError>;

/// Every entry of the list is a case. A stage that is no own one is computed as the folder of its name.
pub(super) fn refused(
    document: &Document,
    folder: &Path,
    file: &Path,
    name: &str,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    for (number, entry) in document.root().list()?.into_iter().enumerate() {
        let (stage, what) = (entry.get("stage")?, entry.get("what")?.text()?);
        let mut case = Case::new(format!("{name}/{number} {what}"));
        let name_of_stage = stage.text()?;
        let input = entry.get("input")?;
        let got = match STAGES.iter().find(|(own, _)| *own == name_of_stage) {
            Some((_, compute)) => compute(&input)?,
            None => {
                let compute = FOLDERS.iter().find(|(own, _)| *own == name_of_stage);
                let (_, compute) = compute.ok_or_else(|| stage.wrong("a stage that is known"))?;
                let expected = entry.clone();
                let by = Tolerance::Exact;
                let mut answers = Answers { case: Case::new(name), expected, by };
                match compute(&Asked { folder, file, input }, &mut answers) {
                    Err(Stop::Refused(TrainingError::Exertion(why))) => {
                        Some(why.place().to_owned())
                    }
                    Err(Stop::Unread(error)) => return Err(error),
                    Ok(()) | Err(Stop::Refused(_)) => None,
                }
            }
        };
        let got = got.map_or(json!("nothing is refused"), Value::String);
        case.compare("place", entry.get("place")?.value(), &got, Tolerance::Exact);
        each(case);
    }
    Ok(())
}

/// The place of a refusal.
fn place<T>(outcome: Result<T, ExertionError>) -> Option<String> {
    outcome.err().map(|error| error.place().to_owned())
}

fn character(input: &Part<'_>) -> Result<Option<String>, VerifyError> {
    Ok(place(PersonSpec::of_json(input.value()).and_then(Person::new)))
}

/// Numbers of a list, null not a number.
fn with_gaps(part: &Part<'_>) -> Result<Vec<f64>, VerifyError> {
    let of = |entry: &Part<'_>| match entry.value() {
        Value::Null => Ok(f64::NAN),
        _ => entry.number(),
    };
    part.list()?.iter().map(of).collect()
}

/// The person of a stage that has one.
fn person(input: &Part<'_>) -> Result<Result<Person, ExertionError>, VerifyError> {
    let none = json!({});
    let given = input.find("person").map_or(&none, |part| part.value());
    Ok(PersonSpec::of_json(given).and_then(Person::new))
}

fn heart(input: &Part<'_>) -> Result<Option<String>, VerifyError> {
    let w = with_gaps(&input.get("w")?)?;
    let rcn0 = input.find("rcn0").map_or(Ok(0.0), |part| match part.value() {
        Value::Null => Ok(f64::NAN),
        _ => part.number(),
    })?;
    let person = person(input)?;
    let refused =
        |law| person.clone().and_then(|person| mimique_exertion::heart(&person, law, &w, rcn0));
    // Both laws refuse the same.
    let [thesis, steady] = HeartModel::NAMES.map(|(law, _)| place(refused(law)));
    Ok(if thesis == steady { thesis } else { None })
}

fn recorded(input: &Part<'_>) -> Result<Option<String>, VerifyError> {
    let (time, rate) = (with_gaps(&input.get("time")?)?, with_gaps(&input.get("heartRate")?)?);
    Ok(place(person(input)?.and_then(|person| RecordedHeart::of(&person, &time, &rate))))
}

fn support_vectors(input: &Part<'_>) -> Result<Option<String>, VerifyError> {
    let model = match SupportVectors::of_json("", input.get("model")?.value(), None) {
        Ok(model) => model,
        Err(error) => return Ok(Some(error.place().to_owned())),
    };
    for row in input.get("x")?.list()? {
        let refused = place(model.predict(&with_gaps(&row)?));
        if refused.is_some() {
            return Ok(refused);
        }
    }
    Ok(None)
}

/// A person who stands, arms down: label and place of every joint, m.
const STANDING: [(&str, BodyJoint, [f64; 3]); BodyJoint::COUNT] = [
    ("LeftUpLeg", BodyJoint::LeftHip, [0.09, 0.93, 0.0]),
    ("LeftLeg", BodyJoint::LeftKnee, [0.09, 0.5, 0.0]),
    ("LeftFoot", BodyJoint::LeftAnkle, [0.09, 0.07, 0.0]),
    ("LeftFoot_end", BodyJoint::LeftToe, [0.09, 0.02, 0.2]),
    ("RightUpLeg", BodyJoint::RightHip, [-0.09, 0.93, 0.0]),
    ("RightLeg", BodyJoint::RightKnee, [-0.09, 0.5, 0.0]),
    ("RightFoot", BodyJoint::RightAnkle, [-0.09, 0.07, 0.0]),
    ("RightFoot_end", BodyJoint::RightToe, [-0.09, 0.02, 0.2]),
    ("Neck", BodyJoint::Neck, [0.0, 1.47, 0.0]),
    ("Neck_end", BodyJoint::HeadTop, [0.0, 1.75, 0.0]),
    ("LeftArm", BodyJoint::LeftShoulder, [0.2, 1.43, 0.0]),
    ("LeftForeArm", BodyJoint::LeftElbow, [0.2, 1.1, 0.0]),
    ("LeftHand", BodyJoint::LeftWrist, [0.2, 0.85, 0.0]),
    ("LeftHand_end", BodyJoint::LeftHandEnd, [0.2, 0.67, 0.0]),
    ("RightArm", BodyJoint::RightShoulder, [-0.2, 1.43, 0.0]),
    ("RightForeArm", BodyJoint::RightElbow, [-0.2, 1.1, 0.0]),
    ("RightHand", BodyJoint::RightWrist, [-0.2, 0.85, 0.0]),
    ("RightHand_end", BodyJoint::RightHandEnd, [-0.2, 0.67, 0.0]),
];

/// The standing person for some frames, without some labels, or one of them not seen in a frame.
fn work(input: &Part<'_>) -> Result<Option<String>, VerifyError> {
    let frames = input.get("frames")?.index()?;
    let rate_hz = input.get("rateHz")?.number()?;
    let without = input.find("without").map_or(Ok(Vec::new()), |part| part.texts())?;
    let there: Vec<_> = STANDING.iter().filter(|(label, ..)| !without.contains(label)).collect();
    let labels: Vec<String> = there.iter().map(|(label, ..)| (*label).to_owned()).collect();
    let one = there.iter().map(|(.., place)| Point::from(*place));
    let positions = (0..frames).flat_map(|_| one.clone());
    let mut capture = Capture::new(labels, rate_hz, LengthUnit::Metre, positions);
    if let Some(gap) = input.find("gap") {
        let entries = gap.list()?;
        let [label, frame] = &entries[..] else { return Err(gap.wrong("a label and a frame")) };
        let (label, frame) = (label.text()?, frame.index()?);
        let marker = capture.labels.iter().position(|own| own == label);
        let width = capture.labels.len();
        let point = marker.and_then(|marker| capture.positions.get_mut(frame * width + marker));
        *point.ok_or_else(|| gap.wrong("a label and a frame of the motion"))? = Point::UNSEEN;
    }
    let map: BTreeMap<String, String> = there
        .iter()
        .map(|(label, joint, _)| (joint.name().to_owned(), (*label).to_owned()))
        .collect();
    let Ok(joints) = BodyJoints::of_map(&map, &capture.labels) else {
        // What a map lacks, or what no naming finds, is said of the joints.
        return Ok(Some("joints".to_owned()));
    };
    let optional = |key: &str| -> Result<Option<f64>, VerifyError> {
        let given = input.find(key).filter(|part| !part.value().is_null());
        given.map(|part| part.number()).transpose()
    };
    let options = BodyOptions {
        scale: Scale::MetresPerUnit(optional("metresPerUnit")?.unwrap_or(1.0)),
        lowpass_hz: optional("lowpassHz")?,
        up: Up::Y,
    };
    Ok(place(person(input)?.and_then(|person| Body::new(&capture, &joints, &person, &options))))
}
