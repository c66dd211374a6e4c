//! What is read: motions and activities, and the plan that they make.

use std::path::Path;

use anyhow::{anyhow, bail};
use mimique_exertion::{
    Accumulated, ActivityWork, BodyOptions, Convention, ExertionError, Finding, MotionWork, Part,
    Person, Plan, Scale, Up,
};
use mimique_mocap::{
    BodyJoints, Capture, CaptureFile, ReadError, ReadOptions, is_activity, read_activity,
};
use serde_json::{Value, json};

use super::args::{MotionOptions, Options};
use super::plan::{Written, parse};
use super::report::words;
use super::{blame, hash_of, text_of};
use crate::solve::length_unit;

/// The plan, and what is to be said of its parts.
pub(super) struct Inputs {
    pub(super) plan: Plan,
    /// The file, or the plan in the user's words.
    name: String,
    /// What each part is, for the report.
    pub(super) parts: Vec<Value>,
    /// What the readers and the motions have to say, with the file's name.
    pub(super) notes: Vec<String>,
    /// SHA-256 of every file.
    pub(super) hashes: Vec<String>,
}

/// One part, read.
pub(super) struct ReadPart {
    pub(super) part: Part,
    told: Value,
    notes: Vec<String>,
}

impl Inputs {
    /// Reads what the options name.
    pub(super) fn read(args: &Options, person: &Person) -> anyhow::Result<Self> {
        let (name, written) = match (&args.plan, &args.file) {
            (Some(plan), _) => (plan.clone(), parse(plan)?),
            (None, Some(file)) => {
                let seconds = args.duration.map(|duration| duration.0);
                (file.display().to_string(), vec![Written::File(file.clone(), seconds)])
            }
            (None, None) => bail!("no motion; name a file, or parts with --plan"),
        };
        let mut inputs = Self {
            plan: Plan::of(Part::rest(1.0))?,
            name,
            parts: vec![],
            notes: vec![],
            hashes: vec![],
        };
        let mut parts = Vec::new();
        for written in written {
            let part = match written {
                Written::Rest(seconds) => {
                    inputs.parts.push(json!({"kind": "rest", "seconds": seconds}));
                    Part::rest(seconds)
                }
                Written::Work(w, seconds) => {
                    inputs
                        .parts
                        .push(json!({"kind": "work", "seconds": seconds, "workPerSecond": w}));
                    let work = Accumulated::of_phases(&[(w, seconds)])?;
                    Part { work, seconds, rcn: None }
                }
                Written::File(file, seconds) => {
                    let read = part(&file, seconds, person, &args.motion)?;
                    inputs.notes.extend(read.notes);
                    inputs.parts.push(read.told);
                    inputs.hashes.push(hash_of(&file)?);
                    read.part
                }
            };
            parts.push(part);
        }
        inputs.plan = Plan::new(parts).map_err(|e| anyhow!("{}: {e}", args.planned_by()))?;
        Ok(inputs)
    }

    /// What it is, in the user's words.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Whose fault an error of the series is.
    pub(super) fn blame(&self, args: &Options, error: &ExertionError) -> anyhow::Error {
        match error {
            ExertionError::NoHeartRate { first, last, .. } => anyhow!(
                "--heart: recorded, and seconds {first} to {last} have no heart rate; give one, or take thesis or \
                 steady"
            ),
            ExertionError::Negative { .. } if args.motion.convention != "segments" => anyhow!(
                "--convention {}: {error}, which no heart can follow; take segments",
                args.motion.convention
            ),
            _ => anyhow!("{}: {error}", self.name),
        }
    }
}

impl Options {
    /// The option that says the parts.
    fn planned_by(&self) -> &'static str {
        if self.plan.is_some() { "--plan" } else { "--for" }
    }
}

/// A motion or an activity as a part.
pub(super) fn part(
    file: &Path,
    seconds: Option<f64>,
    person: &Person,
    options: &MotionOptions,
) -> anyhow::Result<ReadPart> {
    if is_activity(file).map_err(|e| blame(file, e))? {
        activity(file, seconds, person)
    } else {
        motion(file, seconds, person, options)
    }
}

/// An activity: cut at `seconds`, where they are given.
fn activity(file: &Path, seconds: Option<f64>, person: &Person) -> anyhow::Result<ReadPart> {
    let own = read_activity(file).map_err(|e| blame(file, e))?;
    let found = ActivityWork::of(person, &own).map_err(|e| blame(file, e))?;
    let work = Accumulated::of_seconds(&found.w).map_err(|e| blame(file, e))?;
    let span = work.span_s();
    let seconds = seconds.unwrap_or(span);
    if seconds > span + 1e-9 {
        bail!(
            "{}: {span} s were recorded, {seconds} are asked for; ask for less: what was recorded is not repeated",
            file.display()
        );
    }
    if seconds <= 0.0 {
        bail!("{}: less than a second was recorded; give a longer recording", file.display());
    }
    let told = json!({
        "kind": "activity", "file": file, "format": own.format.name, "seconds": seconds,
        "workFrom": found.from.name(), "heartRate": found.rcn.is_some(),
        "workPerSecond": work.at(seconds) / seconds,
    });
    let mut notes = vec![format!("{}: read as {}", file.display(), own.format.name)];
    notes.extend(own.notes.iter().map(|note| format!("{}: {note}", file.display())));
    Ok(ReadPart { part: Part { work, seconds, rcn: found.rcn }, told, notes })
}

/// A motion, repeated where `seconds` are longer.
fn motion(
    file: &Path,
    seconds: Option<f64>,
    person: &Person,
    options: &MotionOptions,
) -> anyhow::Result<ReadPart> {
    let read = Motion::read(file, person, options)?;
    let own = read.work()?;
    let span = own.once.span_s();
    let seconds = seconds.unwrap_or(span);
    let mut findings: Vec<Finding> = own.repetition(seconds).into_iter().collect();
    if options.unit.is_none() {
        findings.extend(Finding::of_unit(&read.capture, &own.body, person));
    }
    findings.extend(read.jitter(&own)?);
    let mut notes = read.notes.clone();
    notes.extend(findings.into_iter().map(words));
    let told = json!({
        "kind": "motion", "file": file, "seconds": seconds, "span": span,
        "repeated": own.is_repeated(seconds),
        "rateHz": read.capture.rate_hz, "frames": read.capture.frames(), "naming": read.joints.naming,
        "metresPerUnit": own.body.metres_per_unit(), "up": own.body.up().to_array(),
        "segments": own.body.segment_names(), "convention": read.convention.name(),
        "lowpassHz": options.lowpass.0, "workPerSecond": own.once.total() / span,
    });
    let notes = notes.iter().map(|note| format!("{}: {note}", file.display())).collect();
    Ok(ReadPart { part: own.part(seconds), told, notes })
}

/// A motion whose joints are known, and what the options make of it.
struct Motion<'a> {
    file: &'a Path,
    person: &'a Person,
    capture: Capture,
    joints: BodyJoints,
    convention: Convention,
    options: BodyOptions,
    notes: Vec<String>,
}

impl<'a> Motion<'a> {
    fn read(file: &'a Path, person: &'a Person, options: &MotionOptions) -> anyhow::Result<Self> {
        let (capture, taken_for) = capture(file, options)?;
        let joints = match &options.joints {
            None => BodyJoints::find(&capture.labels).map_err(|e| blame(file, e))?,
            Some(map) => {
                BodyJoints::of_json(&text_of(map)?, &capture.labels).map_err(|e| blame(map, e))?
            }
        };
        let convention = Convention::by_name(&options.convention)
            .map_err(|e| anyhow!("--{}", e.to_string().replacen('/', " ", 1)))?;
        let scale = match &options.unit {
            None => Scale::ByStature,
            Some(_) => Scale::MetresPerUnit(capture.unit.metres()),
        };
        let mut notes = vec![taken_for];
        notes.extend(capture.notes.iter().cloned());
        let options = BodyOptions { scale, lowpass_hz: options.lowpass.0, up: up(options)? };
        Ok(Self { file, person, capture, joints, convention, options, notes })
    }

    fn work(&self) -> anyhow::Result<MotionWork> {
        let Self { capture, joints, person, options, convention, .. } = self;
        MotionWork::of(capture, joints, person, options, *convention).map_err(|e| self.blame(e))
    }

    fn jitter(&self, own: &MotionWork) -> anyhow::Result<Option<Finding>> {
        let Self { capture, joints, person, options, convention, .. } = self;
        own.jitter(capture, joints, person, options, *convention).map_err(|e| self.blame(e))
    }

    fn blame(&self, error: ExertionError) -> anyhow::Error {
        match error.place() {
            "lowpassHz" => anyhow!("--lowpass: {error}"),
            _ => blame(self.file, error),
        }
    }
}

/// The capture of a file, and what it was taken for.
fn capture(file: &Path, options: &MotionOptions) -> anyhow::Result<(Capture, String)> {
    let unit = options
        .unit
        .as_deref()
        .map(|word| length_unit(word).map_err(|_| anyhow!("--unit: {word:?}; use m, cm or mm")));
    let read = ReadOptions { unit: unit.transpose()?, rate_hz: options.rate };
    let recording = CaptureFile::open(file).and_then(|mut file| file.recording(&read));
    let recording = recording.map_err(|error| match error {
        ReadError::Unrecognised { found, .. } => blame(
            file,
            format!(
                "byte 0: neither a motion nor an activity, {found}; give BVH, a capture, FIT, TCX, GPX, or CSV \
                 with time and power_w, work, speed or heart_rate"
            ),
        ),
        error => blame(file, error),
    })?;
    Ok((recording.capture, recording.format.taken_for()))
}

fn up(options: &MotionOptions) -> anyhow::Result<Up> {
    match options.up.as_deref() {
        None => Ok(Up::Found),
        Some("x") => Ok(Up::X),
        Some("y") => Ok(Up::Y),
        Some("z") => Ok(Up::Z),
        Some(other) => bail!("--up: {other:?}; use x, y or z"),
    }
}

/// Whether a file is named that is none.
pub(super) fn is_none(file: &Path) -> bool {
    file.as_os_str() == "none"
}
