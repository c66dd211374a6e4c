//! A capture of a study that is an exertion: as recorded weights, and as the preview draws it.

use std::ops::Range;
use std::path::{Path, PathBuf};

use mimique_exertion::{
    Expression, ExpressionModel, Face, Figure, Finding, Heart, HeartModel, MotionWork, Person,
    PersonSpec, Plan,
};
use mimique_mocap::{CaptureFile, ReadOptions, WeightsTable, read_activity};
use mimique_study::{ExertionCapture, ExertionHeart, ExertionSource, WrittenPart};

use super::PrepareError;
use super::sources::unit_of;
use crate::{
    Drawn, ExertionDrawing, ExertionPart, ExertionPartError, ExertionTake, MotionOptions,
    built_in_motion,
};

/// An exertion of a study.
pub(super) struct Exertion<'a, P> {
    /// As the study file has it.
    pub exertion: &'a ExertionCapture,
    /// Its pointer.
    pub at: &'a str,
    /// Finds the files that it names, each with its pointer.
    pub path: P,
}

/// Weights of an exertion, and what should be said of them, with the pointers.
pub(super) struct ExertionWeights {
    pub table: WeightsTable,
    pub warnings: Vec<(String, String)>,
}

/// An exertion as it is computed.
pub(super) struct ComputedExertion {
    person: Person,
    expression: Expression,
    take: ExertionTake,
    span_s: f64,
    parts: Vec<PartInTime>,
    warnings: Vec<(String, String)>,
}

/// When a part of an exertion is, and the body of its motion.
struct PartInTime {
    seconds: [f64; 2],
    motion: Option<MotionWork>,
}

impl ComputedExertion {
    /// The weights of all of it.
    pub fn weights(&self) -> ExertionWeights {
        ExertionWeights { table: self.take.clip.table(), warnings: self.warnings.clone() }
    }

    /// Some of its frames as pages draw them; none where there are no such frames.
    pub fn drawing(&self, frames: Range<usize>) -> Option<ExertionDrawing> {
        let ExertionTake { series, clip } = &self.take;
        let times = clip.times.get(frames.clone()).filter(|times| !times.is_empty())?;
        let window_s = [times[0], times[times.len() - 1]];
        // The body of the part in which the window begins.
        let part = self.parts.iter().find(|part| part.seconds[1] > window_s[0])?;
        let figure = part.motion.as_ref().map(|motion| {
            let [from, to] = part.seconds;
            Figure::of(&motion.body, window_s.map(|t| t - from), motion.is_repeated(to - from))
        });
        let (person, expression) = (&self.person, &self.expression);
        let span_s = self.span_s;
        let drawn = Drawn { person, expression, series, clip, frames, span_s, figure };
        Some(ExertionDrawing::of(drawn))
    }
}

impl<P: Fn(&str, &str) -> Result<PathBuf, PrepareError>> Exertion<'_, P> {
    /// Computes body and face.
    pub fn computed(&self) -> Result<ComputedExertion, PrepareError> {
        let exertion = self.exertion;
        let person = self.person()?;
        let face = Face {
            expression: self.expression()?,
            breathing: exertion.breath,
            skin: exertion.skin,
            seed: exertion.seed,
            ..Face::default()
        };
        let options = MotionOptions {
            unit_is_known: exertion.motion_unit.is_some(),
            joints: exertion.joints.as_deref().map(|file| self.text(file, "joints")).transpose()?,
            ..MotionOptions::default()
        };
        let (mut parts, mut in_time, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
        let mut from = 0.0;
        for written in exertion.parts() {
            let part = self.part(&written, &person, &options)?;
            let at = self.pointer_of(&written);
            let said = part.findings.iter().map(ToString::to_string).chain(part.notes);
            warnings.extend(said.map(|text| (at.clone(), text)));
            let to = from + part.part.seconds;
            in_time.push(PartInTime { seconds: [from, to], motion: part.motion });
            from = to;
            parts.push(part.part);
        }
        let plan = Plan::new(parts).map_err(|error| self.error("/for", error))?;
        let heart = heart(exertion.heart);
        let take = ExertionTake::of(&person, &plan, heart, None, &face).map_err(|error| {
            let place = if error.place() == "heart" { "/heart" } else { "" };
            self.error(place, error)
        })?;
        // Cut frames may be ones that no clip shows; and who names the law of the thesis knows it.
        let found = Finding::of_clip(&take.series, &take.clip).into_iter();
        let told = found.filter(|finding| match finding {
            Finding::CutFrames { .. } => false,
            Finding::NearMaximum { .. } => exertion.heart.is_none(),
            _ => true,
        });
        warnings.extend(told.map(|finding| (self.at.to_owned(), finding.to_string())));
        let (expression, span_s) = (face.expression, plan.span_s());
        Ok(ComputedExertion { person, expression, take, span_s, parts: in_time, warnings })
    }

    fn error(&self, place: &str, error: impl std::fmt::Display) -> PrepareError {
        PrepareError::new(format!("{}{place}", self.at), error)
    }

    fn blame(&self, key: &str, file: &Path, error: impl std::fmt::Display) -> PrepareError {
        self.error(&format!("/{key}"), format!("{}: {error}", file.display()))
    }

    /// The pointer of a part's source.
    fn pointer_of(&self, written: &WrittenPart<'_>) -> String {
        let key = written.source.map_or("", ExertionSource::key);
        format!("{}{}/{key}", self.at, written.place)
    }

    /// The text of a file that a key of the exertion names.
    fn text(&self, file: &str, key: &str) -> Result<String, PrepareError> {
        let path = (self.path)(file, &format!("{}/{key}", self.at))?;
        std::fs::read_to_string(&path)
            .map_err(|e| self.blame(key, &path, format!("{e}; check the path")))
    }

    fn expression(&self) -> Result<Expression, PrepareError> {
        Ok(match (self.exertion.model_file(), &self.exertion.model[..]) {
            (Some(file), _) => {
                let model = ExpressionModel::of_text(&self.text(file, "model")?)
                    .map_err(|e| self.blame("model", Path::new(file), e))?;
                Expression::Model(Box::new(model))
            }
            (None, "linear") => Expression::Linear,
            (None, _) => Expression::Rules,
        })
    }

    fn part(
        &self,
        written: &WrittenPart<'_>,
        person: &Person,
        options: &MotionOptions,
    ) -> Result<ExertionPart, PrepareError> {
        let at = self.pointer_of(written);
        let seconds = written.seconds;
        let needed = || {
            let place = format!("{}/for", written.place);
            seconds.ok_or_else(|| self.error(&place, "rest and work need a length; add \"for\""))
        };
        let refused = |file: &str, error: ExertionPartError| match error {
            ExertionPartError::JointMap(error) => {
                let map = self.exertion.joints.as_deref().unwrap_or_default();
                self.blame("joints", Path::new(map), error)
            }
            error => PrepareError::new(&at, format!("{file}{error}")),
        };
        match written.source {
            None => Err(self.error(&written.place, "give exactly one source of the motion")),
            Some(ExertionSource::Rest) => Ok(ExertionPart::rest(needed()?)),
            Some(ExertionSource::Work(work)) => {
                ExertionPart::work(work, needed()?).map_err(|e| PrepareError::new(&at, e))
            }
            Some(ExertionSource::Builtin(motion)) => {
                // Rate, unit and joints of the built-in body are its own.
                let own = MotionOptions::default();
                ExertionPart::motion(&built_in_motion(motion), seconds, person, &own)
                    .map(|part| ExertionPart { findings: vec![], ..part })
                    .map_err(|error| refused("", error))
            }
            Some(ExertionSource::Motion(file)) => {
                let path = (self.path)(file, &at)?;
                let unit_at = format!("{}/motionUnit", self.at);
                let unit = unit_of(self.exertion.motion_unit.as_deref(), &unit_at)?;
                let read = ReadOptions { unit, rate_hz: self.exertion.motion_rate_hz };
                let blame = |e: &dyn std::fmt::Display| {
                    PrepareError::new(&at, format!("{}: {e}", path.display()))
                };
                let recording = CaptureFile::open(&path)
                    .and_then(|mut file| file.recording(&read))
                    .map_err(|e| blame(&e))?;
                let name = format!("{}: ", path.display());
                ExertionPart::motion(&recording.capture, seconds, person, options)
                    .map_err(|error| refused(&name, error))
            }
            Some(ExertionSource::Activity(file)) => {
                let path = (self.path)(file, &at)?;
                let blame = |e: &dyn std::fmt::Display| {
                    PrepareError::new(&at, format!("{}: {e}", path.display()))
                };
                let activity = read_activity(&path).map_err(|e| blame(&e))?;
                ExertionPart::activity(&activity, seconds, person).map_err(|e| blame(&e))
            }
        }
    }

    /// Whose body and face it is: the study file's words are those of a person's JSON.
    fn person(&self) -> Result<Person, PrepareError> {
        let value =
            serde_json::to_value(&self.exertion.person).map_err(|e| self.error("/person", e))?;
        PersonSpec::of_json(&value)
            .and_then(Person::new)
            .map_err(|e| self.error(&format!("/person/{}", e.place()), &e))
    }
}

/// The heart of a word.
fn heart(word: Option<ExertionHeart>) -> Heart {
    match word {
        None => Heart::default(),
        Some(ExertionHeart::Thesis) => Heart::Law(HeartModel::Thesis),
        Some(ExertionHeart::Steady) => Heart::Law(HeartModel::Steady),
        Some(ExertionHeart::Recorded) => Heart::Recorded,
    }
}
