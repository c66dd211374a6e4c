//! Where the work comes from: a motion, with its body, or a recorded activity.

use mimique_exertion::{BodyOptions, Convention, Finding, MotionWork, Part, Person};
use mimique_mocap::{
    Activity, ActivityColumn, BodyJoints, BodyJointsError, Capture, read_activity_bytes,
    recognise_activity,
};
use mimique_stimulus::{ExertionPart, ExertionPartError, built_in_motion};

use super::settings::{Refused, SourceChoice};
use crate::problem::Problem;
use crate::workspace::{Workspace, read_capture};

/// A file that was opened for its body.
#[derive(Debug)]
pub(super) struct OpenedFile {
    pub name: String,
    pub content: FileContent,
}

/// What it holds.
#[derive(Debug)]
pub(super) enum FileContent {
    Motion(Capture),
    Activity(Activity),
}

impl OpenedFile {
    /// By its content: FIT, TCX, GPX and CSV of activities, else a capture.
    pub fn read(
        name: &str,
        bytes: &[u8],
        unit: Option<&str>,
        rate_hz: Option<f64>,
    ) -> Result<Self, Problem> {
        let content = if recognise_activity(bytes).is_some() {
            let activity = read_activity_bytes(bytes).map_err(|e| Problem::of(name, e))?;
            FileContent::Activity(activity)
        } else {
            FileContent::Motion(read_capture(name, bytes, unit, rate_hz)?.capture)
        };
        Ok(Self { name: name.to_owned(), content })
    }

    /// What a watch recorded.
    pub fn activity(&self) -> Option<&Activity> {
        match &self.content {
            FileContent::Motion(_) => None,
            FileContent::Activity(activity) => Some(activity),
        }
    }

    /// Whether the heart was recorded.
    pub fn has_heart(&self) -> bool {
        self.activity().is_some_and(|own| own.column(ActivityColumn::HeartRate).is_some())
    }
}

/// What the work of a motion depends on.
#[derive(Debug, Clone, PartialEq)]
struct MovedBy {
    choice: SourceChoice,
    /// Stature, mass and loads.
    person: [f64; 5],
}

/// The work of the motion that was asked for last: level, expressivity and heart change nothing of it.
#[derive(Debug, Default)]
pub(super) struct Moved(Option<(MovedBy, MotionWork, Vec<Finding>)>);

impl Moved {
    /// Another capture or file.
    pub fn forget(&mut self) {
        self.0 = None;
    }
}

/// A plan's part, and what is known of it.
#[derive(Debug)]
pub(super) struct Worked {
    pub name: String,
    pub part: Part,
    pub findings: Vec<Finding>,
    /// What the reader says.
    pub notes: Vec<String>,
    /// Length of the motion or the recording, s.
    pub span_s: f64,
    pub is_repeated: bool,
}

impl Workspace {
    /// The work of the source, for `seconds` or all of it.
    pub(super) fn worked(
        &mut self,
        choice: SourceChoice,
        person: &Person,
        seconds: Option<f64>,
    ) -> Result<Worked, Refused> {
        if let Some(seconds) = seconds.filter(|seconds| !(seconds.is_finite() && *seconds > 0.0)) {
            return Err(Refused::at("seconds", format!("{seconds}; give a duration above 0 s")));
        }
        if choice == SourceChoice::File {
            let none = || Refused::at("source", "no file yet; open a motion or a recording");
            let file = self.exertion.file.as_ref().ok_or_else(none)?;
            if let Some(activity) = file.activity() {
                return recorded(&file.name, activity, person, seconds);
            }
        }
        let (name, notes) = self.moved(choice, person)?;
        let Some((_, motion, findings)) = &self.exertion.moved.0 else {
            return Err(Refused::source(&name, "no motion; open one"));
        };
        let span_s = motion.once.span_s();
        let seconds = seconds.unwrap_or(span_s);
        Ok(Worked {
            name,
            part: motion.part(seconds),
            findings: motion.repetition(seconds).into_iter().chain(findings.clone()).collect(),
            notes,
            span_s,
            is_repeated: motion.is_repeated(seconds),
        })
    }

    /// The body in motion, where the source has one.
    pub(super) fn body_motion(&self, choice: SourceChoice) -> Option<&MotionWork> {
        let (by, motion, _) = self.exertion.moved.0.as_ref()?;
        (by.choice == choice).then_some(motion)
    }

    /// Computes the work of a motion, unless it is known; its name, and what the reader says.
    fn moved(
        &mut self,
        choice: SourceChoice,
        person: &Person,
    ) -> Result<(String, Vec<String>), Refused> {
        let spec = person.spec();
        let loads = spec.loads;
        let by = MovedBy {
            choice,
            person: [spec.height_m, spec.mass_kg, loads.left_hand, loads.right_hand, loads.back],
        };
        let built_in = choice.built_in().map(built_in_motion);
        let (name, capture) = match (&built_in, choice) {
            (Some(own), _) => {
                let word = choice.built_in().map_or("", |motion| motion.word());
                (format!("built-in {word}"), own)
            }
            (None, SourceChoice::File) => match &self.exertion.file {
                Some(OpenedFile { name, content: FileContent::Motion(capture) }) => {
                    (name.clone(), capture)
                }
                _ => return Err(Refused::at("source", "no motion yet; open one")),
            },
            (None, _) => {
                let capture = self.capture().map_err(|problem| Refused::at("source", problem))?;
                (self.take_name().to_owned(), capture)
            }
        };
        // How our own motion was read is nobody's question.
        let notes = if built_in.is_none() { capture.notes.clone() } else { Vec::new() };
        if self.exertion.moved.0.as_ref().is_none_or(|(known, ..)| *known != by) {
            let refused = |error| Refused::source(&name, error);
            let joints =
                BodyJoints::find(&capture.labels).map_err(|error| refused(joints_words(&error)))?;
            let (options, convention) = (BodyOptions::default(), Convention::Segments);
            let number = |error: mimique_exertion::ExertionError| refused(error.to_string());
            let motion =
                MotionWork::of(capture, &joints, person, &options, convention).map_err(number)?;
            let mut findings = Vec::new();
            // Our own bodies neither jitter nor are of another unit.
            if built_in.is_none() {
                findings.extend(Finding::of_unit(capture, &motion.body, person));
                let jitter = motion.jitter(capture, &joints, person, &options, convention);
                findings.extend(jitter.map_err(number)?);
            }
            self.exertion.moved.0 = Some((by, motion, findings));
        }
        Ok((name, notes))
    }
}

/// The error with the page's own remedy, where the command's names an option.
fn joints_words(error: &BodyJointsError) -> String {
    match error {
        BodyJointsError::Unknown { missing, known, .. } => {
            let missing: Vec<&str> = missing.iter().map(|joint| joint.name()).collect();
            format!(
                "no joints of a body: {} not found by the names of {known}; open a motion with the joints of CMU, \
                 Mixamo or Xsens, or say which marker is which joint with `mimique exertion --joints`",
                missing.join(", ")
            )
        }
        other => other.to_string(),
    }
}

/// A recorded activity; what was recorded is not repeated.
fn recorded(
    name: &str,
    activity: &Activity,
    person: &Person,
    seconds: Option<f64>,
) -> Result<Worked, Refused> {
    let own = ExertionPart::activity(activity, seconds, person).map_err(|error| match error {
        ExertionPartError::PastRecording { .. } => Refused::at("seconds", error),
        error => Refused::source(name, error),
    })?;
    let mut notes = vec![format!("read as {}", activity.format.name)];
    notes.extend(own.notes);
    Ok(Worked {
        name: name.to_owned(),
        part: own.part,
        findings: own.findings,
        notes,
        span_s: activity.time_s.last().map_or(0.0, |last| last.floor()),
        is_repeated: false,
    })
}
