//! `work/`: bodies in motion, their energies and work.

use std::collections::BTreeMap;

use mimique_exertion::{Body, BodyOptions, BodyWork, Convention, Scale, Up};
use mimique_mocap::{BodyJoint, BodyJoints, Capture, CaptureFile, ReadOptions};
use serde_json::{Value, json};

use super::{Answers, Asked, Stop};
use crate::VerifyError;
use crate::case::numbers;
use crate::document::Part;

/// A document of `work/`.
pub(super) fn work(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let input = &asked.input;
    let capture = motion(asked)?;
    let joints = joints(&input.get("joints")?, &capture)?;
    let person = asked.person()?;
    let scale = input.get("metresPerUnit")?;
    let lowpass = input.get("lowpassHz")?;
    let options = BodyOptions {
        scale: match scale.value() {
            Value::Null => Scale::ByStature,
            _ => Scale::MetresPerUnit(scale.number()?),
        },
        lowpass_hz: match lowpass.value() {
            Value::Null => None,
            _ => Some(lowpass.number()?),
        },
        up: Up::Y,
    };
    let convention = Convention::by_name(input.get("convention")?.text()?)?;
    let repeated = input.get("loop")?.value() == &Value::Bool(true);

    let body = Body::new(&capture, &joints, &person, &options)?;
    let mut names = body.segment_names();
    names.sort_unstable();
    answers.number("metresPerUnit", body.metres_per_unit());
    answers.member("segments", &json!(names));
    let parts = body.energies(&person)?;
    let sum = |kind: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..body.frames()).map(|f| (0..parts.len()).map(|part| kind(part, f)).sum()).collect()
    };
    answers.numbers("potential", &sum(&|part, frame| parts[part].potential[frame]));
    answers.numbers("translational", &sum(&|part, frame| parts[part].translational[frame]));
    answers.numbers("rotational", &sum(&|part, frame| parts[part].rotational[frame]));

    let work = BodyWork::of(&body, &person, convention, repeated)?;
    answers.numbers("steps", &work.steps);
    answers.number("total", work.accumulated.total());
    let times = asked.numbers("times")?;
    let at = |of: &dyn Fn(f64) -> f64| -> Vec<f64> { times.iter().map(|t| of(*t)).collect() };
    answers.numbers("w", &at(&|t| work.accumulated.w(t)));
    answers.numbers("p", &at(&|t| work.accumulated.p(t)));
    positions(answers, &capture)
}

/// The motion that a case names, as it stands in its file.
fn motion(asked: &Asked<'_>) -> Result<Capture, VerifyError> {
    let name = asked.input.get("motion")?.text()?;
    let file = asked.file.with_file_name(name);
    let rate_hz = Some(asked.input.get("rateHz")?.number()?);
    let options = ReadOptions { rate_hz, ..ReadOptions::default() };
    let recording = CaptureFile::open(&file).and_then(|mut file| file.recording(&options));
    recording.map(|read| read.capture).map_err(|error| VerifyError::file(&file, &error))
}

/// The markers that a case names as joints. Ends of hands and feet that the motion does not have are left
/// out.
fn joints(part: &Part<'_>, capture: &Capture) -> Result<BodyJoints, VerifyError> {
    let mut map = BTreeMap::new();
    for (name, label) in part.members()? {
        let may_be_missing = BodyJoint::by_name(name).is_some_and(BodyJoint::may_be_missing);
        let there = |label: &str| capture.labels.iter().any(|own| own == label);
        match label.value() {
            Value::Null if may_be_missing => {}
            Value::String(text) if may_be_missing && !there(text) => {}
            _ => {
                map.insert(name.to_owned(), label.text()?.to_owned());
            }
        }
    }
    BodyJoints::of_map(&map, &capture.labels).map_err(|_| part.wrong("markers of the motion"))
}

/// Where joints are in some frames, in the file's unit.
fn positions(answers: &mut Answers<'_>, capture: &Capture) -> Result<(), Stop> {
    let (Some(frames), Some(expected)) =
        (answers.expected.find("frames"), answers.expected.find("positions"))
    else {
        return Ok(());
    };
    let frames = frames.indices_below(capture.frames(), "a frame of the motion")?;
    let mut got = serde_json::Map::new();
    for (label, _) in expected.members()? {
        let Some(marker) = capture.labels.iter().position(|own| own == label) else { continue };
        let at = |frame: &usize| numbers(&capture.frame(*frame)[marker].to_array());
        got.insert(label.to_owned(), frames.iter().map(at).collect());
    }
    answers.member("positions", &Value::Object(got));
    answers.member("frames", &json!(frames));
    Ok(())
}
