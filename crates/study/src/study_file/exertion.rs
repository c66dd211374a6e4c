//! A capture that is computed: the face of a body that walks, runs or does what was recorded of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A face that shows what its body does, computed from what the body did: exactly one of `builtin`, `motion`,
/// `activity` and `plan`. It has 60 frames per second from the beginning on, one more than fit between;
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
    /// What a watch or an ergometer recorded: FIT, TCX, GPX, or CSV with time and power, work, speed or heart
    /// rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub activity: Option<String>,
    /// Parts one after the other, such as rest, a run and rest again.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plan: Vec<ExertionPlanPart>,
    /// How long the body goes on, seconds, up to a day: the work of a shorter motion is repeated, a recording
    /// is cut. Without it, a motion is done once and a recording taken whole; a plan says it in its parts.
    #[serde(rename = "for", default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Which marker is which joint of the motions: a JSON file {"leftHip": "LABEL", ...}; without it by the
    /// names of CMU, Mixamo and Xsens.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joints: Option<String>,
    /// Frames per second of the motions, where their files are wrong or do not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_rate_hz: Option<f64>,
    /// Unit of the motions: `m`, `cm`, `mm`; without it the legs are made those of the person.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_unit: Option<String>,
    /// Whose body and face it is.
    #[serde(default, skip_serializing_if = "ExertionPerson::is_nobody_in_particular")]
    pub person: ExertionPerson,
    /// Where the heart comes from; without it what was recorded, else `thesis`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heart: Option<ExertionHeart>,
    /// What makes the face of heart and work: `rules`, `linear` (all curves 100 times the share of the
    /// heart's reserve, as games do it), or the file of a model that `mimique exertion train` wrote.
    #[serde(default = "rules")]
    pub model: String,
    /// Whether mouth and chest move with the breath.
    #[serde(default = "yes")]
    pub breath: bool,
    /// Whether the skin reddens and sweats, on avatars with shapes `flush` and `sweat` as the built-in head.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub skin: bool,
    /// A seed where breaths are to be irregular.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// A part of a plan: at most one of `builtin`, `motion`, `activity` and `work`; rest where none is given.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ExertionPlanPart {
    /// A motion of the built-in body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub builtin: Option<BuiltinMotion>,
    /// A BVH file, or a capture with the joints of a body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// What a watch or an ergometer recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub activity: Option<String>,
    /// Constant work, joules per kilogram in a second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<f64>,
    /// How long the part is, seconds; not needed for motions (once) and activities (all of them).
    #[serde(rename = "for", default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

/// What a body does in a part of an exertion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExertionSource<'a> {
    /// A motion of the built-in body.
    Builtin(BuiltinMotion),
    /// A motion in a file: relative to the study file, or behind [`super::DATA_PREFIX`].
    Motion(&'a str),
    /// A recording in a file.
    Activity(&'a str),
    /// Constant work, J/kg in a second.
    Work(f64),
    /// Nothing.
    Rest,
}

/// A part of an exertion as it is written, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenPart<'a> {
    /// Where it stands below the exertion: nothing, or `/plan/3`.
    pub place: String,
    /// What the body does; `None` where more than one source is given, or none that could be.
    pub source: Option<ExertionSource<'a>>,
    /// For how long, s.
    pub seconds: Option<f64>,
}

impl ExertionSource<'_> {
    /// The key of the study file that says it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Builtin(_) => "builtin",
            Self::Motion(_) => "motion",
            Self::Activity(_) => "activity",
            Self::Work(_) => "work",
            Self::Rest => "for",
        }
    }
}

impl ExertionPlanPart {
    fn source(&self) -> Option<ExertionSource<'_>> {
        let all = [
            self.builtin.map(ExertionSource::Builtin),
            self.motion.as_deref().map(ExertionSource::Motion),
            self.activity.as_deref().map(ExertionSource::Activity),
            self.work.map(ExertionSource::Work),
        ];
        let mut given = all.into_iter().flatten();
        match (given.next(), given.next()) {
            (None, _) => Some(ExertionSource::Rest),
            (Some(one), None) => Some(one),
            (Some(_), Some(_)) => None,
        }
    }
}

impl ExertionCapture {
    /// Its parts in their order, one where there is no plan.
    pub fn parts(&self) -> Vec<WrittenPart<'_>> {
        if self.plan.is_empty() {
            let all = [
                self.builtin.map(ExertionSource::Builtin),
                self.motion.as_deref().map(ExertionSource::Motion),
                self.activity.as_deref().map(ExertionSource::Activity),
            ];
            let mut given = all.into_iter().flatten();
            let source = given.next().filter(|_| given.next().is_none());
            return vec![WrittenPart { place: String::new(), source, seconds: self.seconds }];
        }
        let part = |(i, own): (usize, &'_ ExertionPlanPart)| (format!("/plan/{i}"), own.seconds);
        let places = self.plan.iter().enumerate().map(part);
        let sources = self.plan.iter().map(ExertionPlanPart::source);
        places
            .zip(sources)
            .map(|((place, seconds), source)| WrittenPart { place, source, seconds })
            .collect()
    }

    /// How many sources are given beside one another.
    pub fn source_count(&self) -> usize {
        let single = [self.builtin.is_some(), self.motion.is_some(), self.activity.is_some()];
        single.into_iter().chain([!self.plan.is_empty()]).filter(|given| *given).count()
    }

    /// Its frames, where the file alone tells how long it is.
    pub fn frames(&self) -> Option<usize> {
        let seconds: Option<f64> = self.parts().iter().map(|part| part.seconds).sum();
        seconds.map(|seconds| (seconds * EXERTION_FRAMES_PER_SECOND + 1e-9).floor() as usize + 1)
    }

    /// Whether any file is needed to compute it.
    pub fn names_files(&self) -> bool {
        let of_file = |part: &WrittenPart<'_>| {
            matches!(part.source, Some(ExertionSource::Motion(_) | ExertionSource::Activity(_)))
        };
        self.parts().iter().any(of_file) || self.joints.is_some() || self.model_file().is_some()
    }

    /// The model's file; `None` for `rules` and `linear`.
    pub fn model_file(&self) -> Option<&str> {
        Some(&self.model[..]).filter(|model| !["rules", "linear"].contains(model))
    }
}

/// Frames per second of an exertion's face.
const EXERTION_FRAMES_PER_SECOND: f64 = 60.0;

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

/// Where the heart comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum ExertionHeart {
    /// By the law of Boukhalfi 2012, which has no steady state: for minutes.
    Thesis,
    /// Towards a steady state.
    Steady,
    /// What was recorded, in every second.
    Recorded,
}

impl ExertionHeart {
    /// The word of the study file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Steady => "steady",
            Self::Recorded => "recorded",
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
