//! A capture that is computed: the face of a body that walks, runs or does what was recorded of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A face that shows what its body does, computed from the body's motion: exactly one of `builtin` and
/// `motion`. It has 60 frames per second from the beginning of the motion on, one more than fit between;
/// its clips are made with the method `recorded`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ExertionCapture {
    /// A motion of the built-in body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub builtin: Option<BuiltinMotion>,
    /// A BVH file, or a capture with the joints of a body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// How long the body goes on, seconds, up to a day: the work of a shorter motion is repeated.
    #[serde(rename = "for")]
    pub seconds: f64,
    /// Whose body and face it is.
    #[serde(default, skip_serializing_if = "ExertionPerson::is_nobody_in_particular")]
    pub person: ExertionPerson,
    /// How the heart follows work.
    #[serde(default)]
    pub heart: ExertionHeart,
    /// What makes the face of heart and work: `rules`, `linear` (all curves 100 times the share of the
    /// heart's reserve, as games do it), or the file of a model that `mimique exertion train` wrote.
    #[serde(default = "rules")]
    pub model: String,
    /// Whether the mouth moves with the breath.
    #[serde(default = "yes")]
    pub breath: bool,
    /// A seed where breaths are to be irregular.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// Where the motion of a body comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionSource<'a> {
    /// The built-in body.
    Builtin(BuiltinMotion),
    /// A file: relative to the study file, or behind [`super::DATA_PREFIX`].
    File(&'a str),
}

impl ExertionCapture {
    /// Where its motion comes from; `None` unless exactly one source is given.
    pub fn source(&self) -> Option<MotionSource<'_>> {
        match (self.builtin, &self.motion) {
            (Some(motion), None) => Some(MotionSource::Builtin(motion)),
            (None, Some(file)) => Some(MotionSource::File(file)),
            _ => None,
        }
    }

    /// The model's file; `None` for `rules` and `linear`.
    pub fn model_file(&self) -> Option<&str> {
        Some(&self.model[..]).filter(|model| !["rules", "linear"].contains(model))
    }
}

/// A motion of the built-in body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum BuiltinMotion {
    /// A brisk walk.
    Walk,
    /// A run.
    Run,
    /// A sprint.
    Sprint,
}

impl BuiltinMotion {
    /// The word of the study file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Sprint => "sprint",
        }
    }
}

/// How the heart follows work.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum ExertionHeart {
    /// By the law of Boukhalfi 2012, which has no steady state: for minutes.
    #[default]
    Thesis,
    /// Towards a steady state.
    Steady,
}

impl ExertionHeart {
    /// The word of the study file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Steady => "steady",
        }
    }
}

/// A person; what is not given is that of a person of 30 years, 1.75 m, 70 kg and level 5, or follows from
/// the rest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ExertionPerson {
    /// Years.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age: Option<f64>,
    /// Stature, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Mass, kg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Sex, where a formula asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sex: Option<ExertionSex>,
    /// Level of training, 0 (none) to 10 (competition).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// Heart rate at rest, beats per minute.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hr_rest: Option<f64>,
    /// Highest heart rate, beats per minute.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hr_max: Option<f64>,
    /// Highest uptake of oxygen, ml/kg/min.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vo2_max: Option<f64>,
    /// Energy at rest, kcal per day.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resting_kcal_day: Option<f64>,
    /// How strongly each expression shows: factors, 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expressivity: Option<ExertionExpressivity>,
    /// What is carried, kg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<ExertionLoads>,
}

impl ExertionPerson {
    fn is_nobody_in_particular(&self) -> bool {
        *self == Self::default()
    }
}

/// Sex, where a formula asks for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum ExertionSex {
    /// Female.
    Female,
    /// Male.
    Male,
}

/// Factors of the five expressions.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ExertionExpressivity {
    /// The opening of the mouth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mouth_open: Option<f64>,
    /// The mouth of a strong exhalation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mouth_exhale: Option<f64>,
    /// The stretching of the mouth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mouth_stretch: Option<f64>,
    /// The narrowing of the eyes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eyes: Option<f64>,
    /// The brows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub brows: Option<f64>,
}

/// What is carried, kg.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ExertionLoads {
    /// In the left hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_hand: Option<f64>,
    /// In the right hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right_hand: Option<f64>,
    /// On the back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back: Option<f64>,
}

fn rules() -> String {
    "rules".to_owned()
}

fn yes() -> bool {
    true
}
