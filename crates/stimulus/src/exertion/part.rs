//! A motion or a recorded activity as a part of a plan, and what is to be said of it.

use mimique_exertion::{
    Accumulated, ActivityWork, BodyOptions, Convention, ExertionError, Finding, LOWPASS_HZ,
    MotionWork, Part, Person, Scale, Up,
};
use mimique_mocap::{Activity, BodyJoints, BodyJointsError, Capture};
use serde::Serialize;

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
    /// What is worth saying of it.
    pub findings: Vec<Finding>,
    /// What the reader of an activity has to say.
    pub notes: Vec<String>,
    /// The body of a motion and its work, once through.
    pub motion: Option<MotionWork>,
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
        Self { part, facts, findings: vec![], notes: vec![], motion: None }
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
        let body = BodyOptions { scale, lowpass_hz: options.lowpass_hz, up: options.up };
        let convention = options.convention;
        let motion = MotionWork::of(capture, &joints, person, &body, convention)?;
        let span = motion.once.span_s();
        let seconds = seconds.unwrap_or(span);
        let mut findings: Vec<Finding> = motion.repetition(seconds).into_iter().collect();
        if !options.unit_is_known {
            findings.extend(Finding::of_unit(capture, &motion.body, person));
        }
        findings.extend(motion.jitter(capture, &joints, person, &body, convention)?);
        let facts = PartFacts::Motion {
            seconds,
            span,
            repeated: motion.is_repeated(seconds),
            rate_hz: capture.rate_hz,
            frames: capture.frames(),
            naming: joints.naming,
            metres_per_unit: motion.body.metres_per_unit(),
            up: motion.body.up().to_array(),
            segments: motion.body.segment_names(),
            convention: convention.name(),
            lowpass_hz: options.lowpass_hz,
            work_per_second: motion.once.total() / span,
        };
        let part = motion.part(seconds);
        Ok(Self { part, facts, findings, notes: vec![], motion: Some(motion) })
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
        let notes = activity.notes.clone();
        let part = Part { work, seconds, rcn: found.rcn };
        Ok(Self { part, facts, findings: vec![], notes, motion: None })
    }
}
