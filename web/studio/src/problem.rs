//! Why a call of the studio fails: what the page has words of its own for, as values; what files and methods say, as
//! they say it.

use std::fmt;

use serde::Serialize;
use serde_json::{Value, json};

/// Why a call fails: the part, what is wrong and the remedy.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The file, the field or the part that it is about.
    place: Option<String>,
    trouble: Trouble,
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
pub(crate) enum Trouble {
    /// There is no avatar.
    NoAvatar,
    /// There is no capture.
    NoCapture,
    /// What is open holds weights, and markers are needed.
    HoldsWeights,
    /// What is open holds markers, and weights are needed.
    NeedsWeights,
    /// The marker map has no marker.
    EmptyMap,
    /// Nothing is solved in this panel.
    NothingSolved,
    /// No panel has a solved face.
    NoFaceSolved,
    /// There is no training take and there are no weights of one.
    NoTraining,
    /// There are weights of a training take, and no take.
    NoTrainingTake,
    /// There is a training take, and no weights of it.
    NoTrainingWeights,
    /// Take and weights have not as many frames.
    TrainingRows {
        /// The take's file.
        take: String,
        /// Its frames.
        frames: usize,
        /// The weights' file.
        weights: String,
        /// Its rows.
        rows: usize,
    },
    /// What a reader, a map or a method says, in English.
    Said {
        /// The words.
        text: String,
    },
}

impl Problem {
    /// What another part of Mimique says of a file, a field or a part.
    pub(crate) fn of(place: &str, error: impl fmt::Display) -> Self {
        Self::at(place, Trouble::Said { text: error.to_string() })
    }

    /// What is wrong with a file, a field or a part.
    pub(crate) fn at(place: &str, trouble: Trouble) -> Self {
        Self { place: Some(place.to_owned()), trouble }
    }

    /// The problem for the page: `{"place", "text", "is"}`, the text in English.
    pub fn json(&self) -> Value {
        json!({ "place": self.place, "text": self.trouble.to_string(), "is": self.trouble })
    }
}

impl From<Trouble> for Problem {
    fn from(trouble: Trouble) -> Self {
        Self { place: None, trouble }
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoAvatar => "no avatar yet; open one first",
            Self::NoCapture => "no capture yet; open one first",
            Self::HoldsWeights => {
                "holds weights, no markers; open a capture, or take the method recorded"
            }
            Self::NeedsWeights => {
                "recorded needs weights; open a Live Link Face file, or a CSV of weights"
            }
            Self::EmptyMap => "empty; suggest one, or open one",
            Self::NothingSolved => "nothing is solved here yet",
            Self::NoFaceSolved => "no face is solved yet; solve one first",
            Self::NoTraining => "open a range of motion and its weights",
            Self::NoTrainingTake => "open the capture that these weights belong to",
            Self::NoTrainingWeights => "open the weights that were played in it",
            Self::TrainingRows { take, frames, weights, rows } => {
                return write!(
                    f,
                    "{take} has {frames} frames, {weights} {rows}; give a row of weights per frame"
                );
            }
            Self::Said { text } => text,
        })
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        self.trouble.fmt(f)
    }
}

impl std::error::Error for Problem {}
