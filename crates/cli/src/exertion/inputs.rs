//! What is read: motions and activities, and the plan that they make.

use std::path::Path;

use anyhow::{anyhow, bail};
use mimique_exertion::{Convention, ExertionError, Part, Person, Plan, Up};
use mimique_mocap::{Capture, CaptureFile, ReadError, ReadOptions, is_activity, read_activity};
use mimique_stimulus::{ExertionPart, ExertionPartError};
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
                Written::Rest(seconds) => inputs.made(ExertionPart::rest(seconds))?,
                Written::Work(w, seconds) => inputs.made(ExertionPart::work(w, seconds)?)?,
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

    /// Notes a part that no file has.
    fn made(&mut self, own: ExertionPart) -> anyhow::Result<Part> {
        self.parts.push(serde_json::to_value(&own.facts)?);
        Ok(own.part)
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
    let part = ExertionPart::activity(&own, seconds, person).map_err(|e| blame(file, e))?;
    ReadPart::of(file, part, &[format!("read as {}", own.format.name)])
}

/// A motion, repeated where `seconds` are longer.
fn motion(
    file: &Path,
    seconds: Option<f64>,
    person: &Person,
    options: &MotionOptions,
) -> anyhow::Result<ReadPart> {
    let (capture, taken_for) = capture(file, options)?;
    let convention = Convention::by_name(&options.convention)
        .map_err(|e| anyhow!("--{}", e.to_string().replacen('/', " ", 1)))?;
    let known = mimique_stimulus::MotionOptions {
        convention,
        lowpass_hz: options.lowpass.0,
        up: up(options)?,
        unit_is_known: options.unit.is_some(),
        joints: options.joints.as_deref().map(text_of).transpose()?,
    };
    let part = ExertionPart::motion(&capture, seconds, person, &known).map_err(|error| {
        match (&error, &options.joints) {
            (ExertionPartError::JointMap(_), Some(map)) => blame(map, error),
            (ExertionPartError::Exertion(own), _) if own.place() == "lowpassHz" => {
                anyhow!("--lowpass: {error}")
            }
            _ => blame(file, error),
        }
    })?;
    let said: Vec<String> =
        std::iter::once(taken_for).chain(capture.notes.iter().cloned()).collect();
    ReadPart::of(file, part, &said)
}

impl ReadPart {
    /// A part of a file, of which the reader said something already.
    fn of(file: &Path, own: ExertionPart, said: &[String]) -> anyhow::Result<Self> {
        let mut told = serde_json::to_value(&own.facts)?;
        if let Value::Object(members) = &mut told {
            members.insert("file".to_owned(), json!(file));
        }
        let notes =
            said.iter().cloned().chain(own.findings.into_iter().map(words)).chain(own.notes);
        let notes = notes.map(|note| format!("{}: {note}", file.display())).collect();
        Ok(Self { part: own.part, told, notes })
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
