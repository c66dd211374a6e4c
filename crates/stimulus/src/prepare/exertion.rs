//! A capture of a study that is an exertion: as recorded weights, and as the preview draws it.

use std::ops::Range;
use std::path::PathBuf;

use mimique_exertion::{Expression, ExpressionModel, Face, Figure, HeartModel, Person, PersonSpec};
use mimique_mocap::{CaptureFile, ReadOptions, WeightsTable};
use mimique_study::{ExertionCapture, MotionSource};

use super::PrepareError;
use crate::{Drawn, ExertionDrawing, ExertionTake, ExertionTakeError, built_in_motion};

/// An exertion as it is computed.
pub(super) struct Computed {
    person: Person,
    expression: Expression,
    take: ExertionTake,
}

impl Computed {
    /// The weights of all of it.
    pub fn weights(&self) -> WeightsTable {
        self.take.clip.table()
    }

    /// Some of its frames as pages draw them; none where there are no such frames.
    pub fn drawing(&self, frames: Range<usize>) -> Option<ExertionDrawing> {
        let ExertionTake { motion, span_s, series, clip } = &self.take;
        let times = clip.times.get(frames.clone()).filter(|times| !times.is_empty())?;
        let window_s = [times[0], times[times.len() - 1]];
        let figure = Figure::of(&motion.body, window_s, motion.is_repeated(*span_s));
        let (person, expression) = (&self.person, &self.expression);
        let (span_s, figure) = (*span_s, Some(figure));
        Some(ExertionDrawing::of(Drawn {
            person,
            expression,
            series,
            clip,
            frames,
            span_s,
            figure,
        }))
    }
}

/// Computes an exertion. `path` finds the files that the study names, `at` is the pointer of the exertion.
pub(super) fn computed(
    exertion: &ExertionCapture,
    at: &str,
    path: impl Fn(&str, &str) -> Result<PathBuf, PrepareError>,
) -> Result<Computed, PrepareError> {
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
    let take = take.map_err(|error| match &error {
        // A plan of one part: what is wrong with it is how long it is.
        ExertionTakeError::Exertion(own) if own.place().starts_with("parts") => {
            PrepareError::new(format!("{at}/for"), &error)
        }
        _ => PrepareError::new(motion_pointer, format!("{file}{error}")),
    })?;
    Ok(Computed { person, expression: face.expression, take })
}

/// Whose body and face it is: the study file's words are those of a person's JSON.
fn person(exertion: &ExertionCapture, at: &str) -> Result<Person, PrepareError> {
    let at = format!("{at}/person");
    let value = serde_json::to_value(&exertion.person).map_err(|e| PrepareError::new(&at, e))?;
    PersonSpec::of_json(&value)
        .and_then(Person::new)
        .map_err(|e| PrepareError::new(format!("{at}/{}", e.place()), &e))
}
