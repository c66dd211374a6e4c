//! What the page sets: read from its JSON, each number checked where it stands.

use mimique_exertion::{ExertionError, Heart, HeartModel, Person, PersonSpec};
use mimique_study::BuiltinMotion;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::problem::Problem;

/// Where the motion comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) enum SourceChoice {
    /// The built-in body walks.
    Walk,
    /// It runs.
    Run,
    /// It sprints.
    Sprint,
    /// The capture that lies on the workspace.
    Take,
    /// The file that was opened for it.
    File,
}

impl SourceChoice {
    /// The built-in motion.
    pub fn built_in(self) -> Option<BuiltinMotion> {
        match self {
            Self::Walk => Some(BuiltinMotion::Walk),
            Self::Run => Some(BuiltinMotion::Run),
            Self::Sprint => Some(BuiltinMotion::Sprint),
            Self::Take | Self::File => None,
        }
    }
}

/// Where the heart comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) enum HeartChoice {
    /// The law of the thesis, whatever was recorded.
    Thesis,
    /// The law that settles, whatever was recorded.
    Steady,
    /// What was recorded.
    Recorded,
}

impl HeartChoice {
    pub fn heart(self) -> Heart {
        match self {
            Self::Thesis => Heart::Law(HeartModel::Thesis),
            Self::Steady => Heart::Law(HeartModel::Steady),
            Self::Recorded => Heart::Recorded,
        }
    }
}

/// What makes the curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) enum ModelChoice {
    /// The rules.
    Rules,
    /// 100 times the heart's share.
    Linear,
    /// The model file that was opened.
    File,
}

/// Everything that the page sets.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(super) struct Settings {
    pub source: SourceChoice,
    /// How long, s; all of it where nothing is said.
    pub seconds: Option<f64>,
    /// A person as `mimique exertion --person` takes it.
    pub person: Value,
    pub heart: HeartChoice,
    pub model: ModelChoice,
    pub breath: bool,
    /// Whether the skin reddens and sweats.
    pub skin: bool,
    /// A seed where breaths are to be irregular.
    pub seed: Option<u64>,
    /// The part that the face shows, s.
    pub window: [f64; 2],
}

impl Settings {
    pub fn of(text: &str) -> Result<Self, Problem> {
        serde_json::from_str(text).map_err(|e| Problem::of("exertion", e))
    }

    pub fn person(&self) -> Result<Person, Refused> {
        let person = PersonSpec::of_json(&self.person).and_then(Person::new);
        person.map_err(|error| Refused::at(&format!("person/{}", error.place()), &error))
    }
}

/// Why nothing is computed: the place of the input that is to be mended, and what is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Refused {
    place: String,
    text: String,
}

impl Refused {
    pub fn at(place: &str, text: impl std::fmt::Display) -> Self {
        Self { place: place.to_owned(), text: text.to_string() }
    }

    /// Of the numbers of a motion or a recording.
    pub fn source(name: &str, error: impl std::fmt::Display) -> Self {
        Self::at("source", format!("{name}: {error}"))
    }

    /// Of a plan: its one part is the source, for as long as was asked for.
    pub fn plan(name: &str, error: &ExertionError) -> Self {
        match error {
            ExertionError::NoHeartRate { first, last, .. } => Self::at(
                "heart",
                format!(
                    "seconds {first:.0} to {last:.0} have no heart rate; take thesis or steady, or a recording that \
                     has it"
                ),
            ),
            ExertionError::Window { .. } => Self::at("window", error),
            _ if error.place().starts_with("parts") => Self::at("seconds", error),
            _ => Self::source(name, error),
        }
    }

    pub fn json(&self) -> Value {
        json!({"problem": {"place": self.place, "text": self.text}})
    }
}
