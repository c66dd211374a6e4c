//! What `regression` learns from: a range of motion, and the weights that were played in it.

use std::ops::Range;

use mimique_actor::NOISE_MM;
use mimique_mocap::{Capture, WeightOptions, WeightsTable, read_weights};
use mimique_stimulus::{Training, built_in_training};
use serde_json::{Value, json};

use crate::problem::{Problem, Trouble};
use crate::workspace::{Origin, Workspace, read_capture};

/// Neutral frames of a training take where nobody names others, as in `mimique solve`.
const NEUTRAL: Range<usize> = 0..60;

/// The two files, each with its name.
#[derive(Debug, Default)]
pub(crate) struct TrainingFiles {
    take: Option<(String, Origin, Capture)>,
    weights: Option<(String, WeightsTable)>,
    neutral: Option<Range<usize>>,
    /// Labels of the head markers, of the built-in actor; else those of the take to be solved.
    head: Option<Vec<String>>,
}

impl TrainingFiles {
    /// The weights with their name.
    pub fn weights(&self) -> Option<(&String, &WeightsTable)> {
        self.weights.as_ref().map(|(name, table)| (name, table))
    }

    /// Where the capture comes from, and the names of capture and weights; none where they are not both there.
    pub fn files(&self) -> Option<(&Origin, [&str; 2])> {
        let ((take, origin, _), (weights, _)) = (self.take.as_ref()?, self.weights.as_ref()?);
        Some((origin, [take, weights]))
    }
}

impl Workspace {
    /// Takes the capture that `regression` learns from.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn training_take(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<&str>,
        rate_hz: Option<f64>,
    ) -> Result<Value, Problem> {
        let capture = read_capture(file, bytes, unit, rate_hz)?.capture;
        let origin = Origin::File { unit: unit.map(str::to_owned), rate_hz };
        self.training.take = Some((file.to_owned(), origin, capture));
        self.training.neutral = None;
        self.training.head = None;
        Ok(self.training_state())
    }

    /// Takes the weights that were played in it: CSV or Live Link Face, a row per frame.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn training_weights(&mut self, file: &str, bytes: &[u8]) -> Result<Value, Problem> {
        let table =
            read_weights(bytes, &WeightOptions::default()).map_err(|e| Problem::of(file, e))?;
        self.training.weights = Some((file.to_owned(), table));
        self.layout.motion_changed();
        Ok(self.training_state())
    }

    /// Takes the built-in actor's range of motion, two minutes with every shape in it.
    pub fn built_in_training(&mut self, actor: u64) -> Value {
        let learnt_from = built_in_training(actor, NOISE_MM);
        let name = || "built-in actor".to_owned();
        self.training = TrainingFiles {
            take: Some((name(), Origin::BuiltIn, learnt_from.capture)),
            weights: Some((name(), learnt_from.weights)),
            neutral: learnt_from.neutral,
            head: learnt_from.head,
        };
        self.layout.motion_changed();
        self.training_state()
    }

    /// Names the neutral frames of the training take, counted from 0, `end` not included.
    ///
    /// # Errors
    /// [`Problem`]: no training take yet, or not frames of it.
    pub fn set_training_neutral(&mut self, first: usize, end: usize) -> Result<Value, Problem> {
        let Some((name, _, capture)) = &self.training.take else {
            return Err(Problem::at("training", Trouble::NoTraining));
        };
        let frames = capture.frames();
        if first >= end || end > frames {
            let what =
                format!("neutral frames {first}:{end} of {frames}; give a range inside the take");
            return Err(Problem::of(name, what));
        }
        self.training.neutral = Some(first..end);
        Ok(self.training_state())
    }

    /// What is there to learn from; `missing` says what is not, null once a regression can learn.
    pub fn training_state(&self) -> Value {
        let TrainingFiles { take, weights, .. } = &self.training;
        let neutral = take.as_ref().map(|(.., capture)| self.training_neutral(capture));
        json!({
            "take": take.as_ref().map(|(name, origin, capture)| json!({
                "file": name,
                "builtIn": origin.is_built_in(),
                "markers": capture.labels.len(),
                "frames": capture.frames(),
                "rate_hz": capture.rate_hz,
            })),
            "weights": weights.as_ref().map(|(name, table)| json!({
                "file": name,
                "frames": table.frames.len(),
                "columns": table.shape_names.len(),
            })),
            "neutral": neutral.map(|n| [n.start, n.end]),
            "missing": self.missing_training().map(|trouble| Problem::from(trouble).json()),
        })
    }

    fn missing_training(&self) -> Option<Trouble> {
        match (&self.training.take, &self.training.weights) {
            (None, None) => Some(Trouble::NoTraining),
            (None, Some(_)) => Some(Trouble::NoTrainingTake),
            (Some(_), None) => Some(Trouble::NoTrainingWeights),
            (Some((take, _, capture)), Some((name, table))) => {
                let (frames, rows) = (capture.frames(), table.frames.len());
                (frames != rows).then(|| Trouble::TrainingRows {
                    take: take.clone(),
                    frames,
                    weights: name.clone(),
                    rows,
                })
            }
        }
    }

    fn training_neutral(&self, capture: &Capture) -> Range<usize> {
        self.training.neutral.clone().unwrap_or(NEUTRAL.start..NEUTRAL.end.min(capture.frames()))
    }

    /// What a regression learns from.
    pub(crate) fn training(&self) -> Result<Training, Problem> {
        if let Some(missing) = self.missing_training() {
            return Err(Problem::at("training", missing));
        }
        let TrainingFiles { take: Some((.., capture)), weights: Some((_, weights)), .. } =
            &self.training
        else {
            return Err(Problem::at("training", Trouble::NoTraining));
        };
        Ok(Training {
            capture: capture.clone(),
            weights: weights.clone(),
            neutral: self.training.neutral.clone(),
            head: self.training.head.clone(),
        })
    }
}
