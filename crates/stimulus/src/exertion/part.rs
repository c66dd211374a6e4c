//! A motion or a recorded activity as a part of a plan, and what is to be said of it.

use mimique_exertion::{
    Accumulated, ActivityWork, Body, BodyOptions, BodyWork, Convention, ExertionError, LOWPASS_HZ,
    Part, Person, Scale, Up,
};
use mimique_mocap::{Activity, BodyJoints, BodyJointsError, Capture, LengthUnit};
use serde::Serialize;

/// Work without the low-pass in works with it from which jitter is said.
const JITTER: f64 = 1.5;
/// How far the unit of a file may be from the one that fits the legs before it is said.
const UNIT: f64 = 0.2;
/// How much longer than a recording a part may be, s: rounding.
const ROUNDING_S: f64 = 1e-9;

/// What is known of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionOptions {
    /// How work follows from energies.
    pub convention: Convention,
    /// Cut-off of the low-pass on every coordinate, Hz; `None`: none.
    pub lowpass_hz: Option<f64>,
    /// Which way is up.
    pub up: Up,
    /// Whether the capture's unit is to be believed; otherwise the legs are made those of the person.
    pub unit_is_known: bool,
    /// Which marker is which joint, as JSON; `None`: by the names of the known skeletons.
    pub joints: Option<String>,
}

impl Default for MotionOptions {
    fn default() -> Self {
        Self {
            convention: Convention::default(),
            lowpass_hz: Some(LOWPASS_HZ),
            up: Up::Found,
            unit_is_known: false,
            joints: None,
        }
    }
}

/// A part of a plan, and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct ExertionPart {
    /// The part.
    pub part: Part,
    /// What it is.
    pub facts: PartFacts,
    /// What is to be said of it.
    pub notes: Vec<PartNote>,
    /// The body of a motion, once through.
    pub body: Option<Body>,
}

/// What a part is, as reports have it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub enum PartFacts {
    /// Rest.
    Rest {
        /// How long, s.
        seconds: f64,
    },
    /// Constant work.
    Work {
        /// How long, s.
        seconds: f64,
        /// J/kg in a second.
        work_per_second: f64,
    },
    /// The motion of a body.
    Motion {
        /// How long it goes on, s.
        seconds: f64,
        /// How long the motion itself is, s.
        span: f64,
        /// Whether its work is repeated.
        repeated: bool,
        /// Frames per second.
        rate_hz: f64,
        /// Frames.
        frames: usize,
        /// The skeleton by whose names the joints were found.
        naming: Option<&'static str>,
        /// Metres that one unit of the capture is.
        metres_per_unit: f64,
        /// The way up, a unit vector.
        up: [f64; 3],
        /// Parts of the body whose energy counts.
        segments: Vec<&'static str>,
        /// How work follows from energies.
        convention: &'static str,
        /// Cut-off of the low-pass, Hz.
        lowpass_hz: Option<f64>,
        /// Mean work, J/kg in a second.
        work_per_second: f64,
    },
    /// What a watch or an ergometer recorded.
    Activity {
        /// The file's format.
        format: &'static str,
        /// How long, s.
        seconds: f64,
        /// The column that the work follows from.
        work_from: &'static str,
        /// Whether the heart was recorded.
        heart_rate: bool,
        /// Mean work, J/kg in a second.
        work_per_second: f64,
    },
}

/// What is to be said of a part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PartNote {
    /// The motion is shorter than the part.
    #[error(
        "repeated {0:.1} times: the work is repeated, not the motion, whose jump back would be work"
    )]
    Repeated(f64),
    /// By the capture's unit the person would be of another stature.
    #[error(
        "the legs are made those of a person of {stature_m} m; by the file's unit ({}) the person would be \
         {by_unit_m:.2} m tall; name the unit where the file is right",
        unit.symbol()
    )]
    OtherStature {
        /// The person's stature, m.
        stature_m: f64,
        /// What it would be, m.
        by_unit_m: f64,
        /// The capture's unit.
        unit: LengthUnit,
    },
    /// Without the low-pass there would be so many times as much work.
    #[error("the motion jitters: without the low-pass its work would be {0:.1} times as much")]
    Jitter(f64),
    /// What the reader of an activity has to say.
    #[error("{0}")]
    Read(String),
}

/// A motion or an activity is no part of a plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExertionPartError {
    /// The motion has no body's joints.
    #[error(transparent)]
    Joints(#[from] BodyJointsError),
    /// The map of joints is none, or does not fit.
    #[error(transparent)]
    JointMap(BodyJointsError),
    /// A number of the motion is none that can be computed with.
    #[error(transparent)]
    Exertion(#[from] ExertionError),
    /// A recording is not repeated.
    #[error(
        "{span_s} s were recorded, {asked_s} are asked for; ask for less: what was recorded is not repeated"
    )]
    PastRecording {
        /// How long the recording is, s.
        span_s: f64,
        /// What is asked for, s.
        asked_s: f64,
    },
    /// A recording of less than a second.
    #[error("less than a second was recorded; give a longer recording")]
    NoSecond,
}

impl ExertionPart {
    /// Rest.
    pub fn rest(seconds: f64) -> Self {
        Self::plain(Part::rest(seconds), PartFacts::Rest { seconds })
    }

    /// Constant work, J/kg in a second.
    ///
    /// # Errors
    /// [`ExertionError`] for work or a length that is none.
    pub fn work(work_per_second: f64, seconds: f64) -> Result<Self, ExertionError> {
        let work = Accumulated::of_phases(&[(work_per_second, seconds)])?;
        let facts = PartFacts::Work { seconds, work_per_second };
        Ok(Self::plain(Part { work, seconds, rcn: None }, facts))
    }

    fn plain(part: Part, facts: PartFacts) -> Self {
        Self { part, facts, notes: vec![], body: None }
    }

    /// A motion that goes on for `seconds`, or once. A shorter motion repeats its work, not its positions,
    /// whose jump back would be work that nobody did.
    ///
    /// # Errors
    /// [`ExertionPartError`]: joints that are missing or unseen, a motion that is too short or too slow.
    pub fn motion(
        capture: &Capture,
        seconds: Option<f64>,
        person: &Person,
        options: &MotionOptions,
    ) -> Result<Self, ExertionPartError> {
        let joints = match &options.joints {
            None => BodyJoints::find(&capture.labels)?,
            Some(map) => {
                BodyJoints::of_json(map, &capture.labels).map_err(ExertionPartError::JointMap)?
            }
        };
        let scale = match options.unit_is_known {
            false => Scale::ByStature,
            true => Scale::MetresPerUnit(capture.unit.metres()),
        };
        let body_of = |lowpass_hz| {
            Body::new(capture, &joints, person, &BodyOptions { scale, lowpass_hz, up: options.up })
        };
        let work_of = |body: &Body| {
            BodyWork::of(body, person, options.convention, false).map(|work| work.accumulated)
        };
        let body = body_of(options.lowpass_hz)?;
        let once = work_of(&body)?;
        let span = once.span_s();
        let seconds = seconds.unwrap_or(span);
        let repeated = seconds > span;
        let mut notes = Vec::new();
        if repeated {
            notes.push(PartNote::Repeated(seconds / span));
        }
        notes.extend(other_stature(capture, &body, options, person));
        if options.lowpass_hz.is_some() {
            let ratio = work_of(&body_of(None)?)?.total() / once.total();
            if ratio > JITTER {
                notes.push(PartNote::Jitter(ratio));
            }
        }
        let facts = PartFacts::Motion {
            seconds,
            span,
            repeated,
            rate_hz: capture.rate_hz,
            frames: capture.frames(),
            naming: joints.naming,
            metres_per_unit: body.metres_per_unit(),
            up: body.up().to_array(),
            segments: body.segment_names(),
            convention: options.convention.name(),
            lowpass_hz: options.lowpass_hz,
            work_per_second: once.total() / span,
        };
        let part = Part { work: once.repeated(repeated), seconds, rcn: None };
        Ok(Self { part, facts, notes, body: Some(body) })
    }

    /// A recorded activity: its first `seconds`, or all of it.
    ///
    /// # Errors
    /// [`ExertionPartError`]: columns that no person has, gaps, less than is asked for.
    pub fn activity(
        activity: &Activity,
        seconds: Option<f64>,
        person: &Person,
    ) -> Result<Self, ExertionPartError> {
        let found = ActivityWork::of(person, activity)?;
        let work = Accumulated::of_seconds(&found.w)?;
        let span_s = work.span_s();
        let seconds = seconds.unwrap_or(span_s);
        if seconds > span_s + ROUNDING_S {
            return Err(ExertionPartError::PastRecording { span_s, asked_s: seconds });
        }
        if seconds <= 0.0 {
            return Err(ExertionPartError::NoSecond);
        }
        let facts = PartFacts::Activity {
            format: activity.format.name,
            seconds,
            work_from: found.from.name(),
            heart_rate: found.rcn.is_some(),
            work_per_second: work.at(seconds) / seconds,
        };
        let notes = activity.notes.iter().map(|note| PartNote::Read(note.to_string())).collect();
        let part = Part { work, seconds, rcn: found.rcn };
        Ok(Self { part, facts, notes, body: None })
    }
}

/// That the capture's unit would make somebody of another stature.
fn other_stature(
    capture: &Capture,
    body: &Body,
    options: &MotionOptions,
    person: &Person,
) -> Option<PartNote> {
    let own = capture.unit.metres() / body.metres_per_unit();
    let stature_m = person.spec().height_m;
    (!options.unit_is_known && (own - 1.0).abs() > UNIT).then(|| PartNote::OtherStature {
        stature_m,
        by_unit_m: stature_m * own,
        unit: capture.unit,
    })
}
