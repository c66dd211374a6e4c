//! A capture of a study that is an exertion, as recorded weights.

use std::path::{Path, PathBuf};

use mimique_exertion::{
    Expression, ExpressionModel, Face, Heart, HeartModel, Person, PersonSpec, Plan,
};
use mimique_mocap::{CaptureFile, ReadOptions, WeightsTable, read_activity};
use mimique_study::{ExertionCapture, ExertionHeart, ExertionSource, WrittenPart};

use super::PrepareError;
use super::sources::unit_of;
use crate::{
    ExertionPart, ExertionPartError, ExertionTake, ExertionWarning, MotionOptions, built_in_motion,
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

impl<P: Fn(&str, &str) -> Result<PathBuf, PrepareError>> Exertion<'_, P> {
    /// Computes the face.
    pub fn weights(&self) -> Result<ExertionWeights, PrepareError> {
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
        let (mut parts, mut warnings) = (Vec::new(), Vec::new());
        for written in exertion.parts() {
            let part = self.part(&written, &person, &options)?;
            let at = self.pointer_of(&written);
            warnings.extend(part.notes.iter().map(|note| (at.clone(), note.to_string())));
            parts.push(part.part);
        }
        let plan = Plan::new(parts).map_err(|error| self.error("/for", error))?;
        let heart = heart(exertion.heart);
        let take = ExertionTake::of(&person, &plan, heart, None, &face).map_err(|error| {
            let place = if error.place() == "heart" { "/heart" } else { "" };
            self.error(place, error)
        })?;
        // Cut frames may be ones that no clip shows; and who names the law of the thesis knows it.
        let told = take.warnings().into_iter().filter(|warning| match warning {
            ExertionWarning::Cut { .. } => false,
            ExertionWarning::NearMaximum { .. } => exertion.heart.is_none(),
            ExertionWarning::OverLimit { .. } => true,
        });
        warnings.extend(told.map(|warning| (self.at.to_owned(), warning.to_string())));
        Ok(ExertionWeights { table: take.clip.table(), warnings })
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
                    .map(|part| ExertionPart { notes: vec![], ..part })
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
