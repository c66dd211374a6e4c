//! A capture of a study that is an exertion, as recorded weights.

use std::path::PathBuf;

use mimique_exertion::{Expression, ExpressionModel, Face, HeartModel, Person, PersonSpec};
use mimique_mocap::{CaptureFile, ReadOptions, WeightsTable};
use mimique_study::{ExertionCapture, MotionSource};

use super::PrepareError;
use crate::{ExertionTake, ExertionTakeError, built_in_motion};

/// The weights of an exertion. `path` finds the files that the study names, `at` is the pointer of the
/// exertion.
pub(super) fn weights(
    exertion: &ExertionCapture,
    at: &str,
    path: impl Fn(&str, &str) -> Result<PathBuf, PrepareError>,
) -> Result<WeightsTable, PrepareError> {
    let person = person(exertion, at)?;
    let law = HeartModel::by_name(exertion.heart.word()).unwrap_or_default();
    let expression = match (exertion.model_file(), &exertion.model[..]) {
        (Some(file), _) => {
            let pointer = format!("{at}/model");
            let path = path(file, &pointer)?;
            let blame =
                |said: String| PrepareError::new(&pointer, format!("{}: {said}", path.display()));
            let text = std::fs::read_to_string(&path)
                .map_err(|e| blame(format!("{e}; check the path")))?;
            let model = ExpressionModel::of_text(&text).map_err(|e| blame(e.to_string()))?;
            Expression::Model(Box::new(model))
        }
        (None, "linear") => Expression::Linear,
        (None, _) => Expression::Rules,
    };
    let face =
        Face { expression, breathing: exertion.breath, seed: exertion.seed, ..Face::default() };
    let (motion, motion_pointer, file) = match exertion.source() {
        Some(MotionSource::Builtin(motion)) => {
            (built_in_motion(motion), format!("{at}/builtin"), String::new())
        }
        Some(MotionSource::File(file)) => {
            let pointer = format!("{at}/motion");
            let path = path(file, &pointer)?;
            let read = CaptureFile::open(&path)
                .and_then(|mut file| file.recording(&ReadOptions::default()))
                .map_err(|e| PrepareError::new(&pointer, format!("{}: {e}", path.display())))?;
            (read.capture, pointer, format!("{}: ", path.display()))
        }
        None => return Err(PrepareError::new(at, "give exactly one of builtin and motion")),
    };
    let take = ExertionTake::of(&motion, exertion.seconds, &person, law, &face);
    take.map(|take| take.table).map_err(|error| match &error {
        // A plan of one part: what is wrong with it is how long it is.
        ExertionTakeError::Exertion(own) if own.place().starts_with("parts") => {
            PrepareError::new(format!("{at}/for"), &error)
        }
        _ => PrepareError::new(motion_pointer, format!("{file}{error}")),
    })
}

/// Whose body and face it is: the study file's words are those of a person's JSON.
fn person(exertion: &ExertionCapture, at: &str) -> Result<Person, PrepareError> {
    let at = format!("{at}/person");
    let value = serde_json::to_value(&exertion.person).map_err(|e| PrepareError::new(&at, e))?;
    PersonSpec::of_json(&value)
        .and_then(Person::new)
        .map_err(|e| PrepareError::new(format!("{at}/{}", e.place()), &e))
}
