//! The clips that the rules make, each with its factors.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{ClipEntry, MethodEntry, Study};

/// Free key -> value pairs that the analysis groups by.
pub type Factors = BTreeMap<String, FactorValue>;

/// The value of a factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FactorValue {
    /// `true`, `false`.
    Truth(bool),
    /// A number.
    Number(f64),
    /// A word.
    Text(String),
}

impl FactorValue {
    /// As the export writes it: whole numbers without a point.
    pub fn to_value(&self) -> Value {
        match self {
            Self::Truth(truth) => (*truth).into(),
            Self::Number(number) if number.fract() == 0.0 && number.abs() < 9e15 => {
                (*number as i64).into()
            }
            Self::Number(number) => (*number).into(),
            Self::Text(text) => text.as_str().into(),
        }
    }
}

impl std::fmt::Display for FactorValue {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Truth(truth) => write!(formatter, "{truth}"),
            Self::Number(number) => write!(formatter, "{number}"),
            Self::Text(text) => formatter.write_str(text),
        }
    }
}

/// The emotions of the built-in performances.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "camelCase")]
pub enum BuiltinExpression {
    /// Anger.
    Anger,
    /// Disgust.
    Disgust,
    /// Fear.
    Fear,
    /// Joy.
    Joy,
    /// Sadness.
    Sadness,
    /// Surprise.
    Surprise,
}

impl BuiltinExpression {
    /// All six, in alphabetical order.
    pub const ALL: [Self; 6] =
        [Self::Anger, Self::Disgust, Self::Fear, Self::Joy, Self::Sadness, Self::Surprise];

    /// The word of the file and of the export.
    pub fn word(self) -> &'static str {
        match self {
            Self::Anger => "anger",
            Self::Disgust => "disgust",
            Self::Fear => "fear",
            Self::Joy => "joy",
            Self::Sadness => "sadness",
            Self::Surprise => "surprise",
        }
    }
}

/// One stimulus: an avatar, a segment, a method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Clip {
    /// `joy2.lsts30`; with several avatars `joy2.lsts30.ada`; where the study names sounds, the sound at the end.
    pub id: String,
    /// Key of `stimuli.avatars`.
    pub avatar: String,
    /// Identifier of a segment.
    pub segment: String,
    /// Key of `stimuli.methods`.
    pub method: String,
    /// Key of `stimuli.sounds`, where there are any; the page knows it by the factor `sound`.
    #[serde(skip)]
    pub sound: Option<String>,
    /// Factors of avatar, segment, method and sound together. `method` is the method's name in the study file,
    /// `solverMethod` that in the solver, where the study has one of these under several names, and others.
    pub factors: Factors,
}

impl Clip {
    /// The value of a factor as text; `clip`, `avatar` and `segment` can be named too.
    pub fn factor_text(&self, factor: &str) -> Option<String> {
        match (self.factors.get(factor), factor) {
            (Some(value), _) => Some(value.to_string()),
            (None, "clip") => Some(self.id.clone()),
            (None, "avatar") => Some(self.avatar.clone()),
            (None, "segment") => Some(self.segment.clone()),
            (None, _) => None,
        }
    }
}

impl Study {
    /// Whether any capture shows motion of the head.
    pub fn shows_head_motion(&self) -> bool {
        self.stimuli.captures.values().any(|capture| capture.head_motion_shown() > 0.0)
    }

    /// Every clip, in the order of the file: the cross product (segment by segment, method by
    /// method, avatar by avatar, sound by sound), then the list. Combinations whose parts do not exist are left out
    /// (the check reports them), and so is the second of two that are alike.
    pub fn clips(&self) -> Vec<Clip> {
        let stimuli = &self.stimuli;
        let mut entries = Vec::new();
        let rules = &stimuli.clips;
        let everything = rules.cross.is_none() && rules.list.is_empty();
        let cross = rules.cross.clone().unwrap_or_default();
        if everything || rules.cross.is_some() {
            let or_all = |given: &[String], all: Vec<&String>| -> Vec<String> {
                if given.is_empty() { all.into_iter().cloned().collect() } else { given.to_vec() }
            };
            let avatars = or_all(&cross.avatars, stimuli.avatars.keys().collect());
            let segments =
                or_all(&cross.segments, stimuli.segments.iter().map(|each| &each.id).collect());
            let methods = or_all(&cross.methods, stimuli.methods.keys().collect());
            let sounds = or_all(&cross.sounds, stimuli.sounds.keys().collect());
            let mut sounds: Vec<Option<String>> = sounds.into_iter().map(Some).collect();
            if sounds.is_empty() {
                sounds.push(None);
            }
            for segment in &segments {
                for method in &methods {
                    for avatar in &avatars {
                        entries.extend(sounds.iter().map(|sound| ClipEntry {
                            avatar: avatar.clone(),
                            segment: segment.clone(),
                            method: method.clone(),
                            sound: sound.clone(),
                        }));
                    }
                }
            }
        }
        entries.extend(rules.list.iter().cloned());
        let several_avatars =
            entries.first().is_some_and(|one| entries.iter().any(|each| each.avatar != one.avatar));
        let mut seen = BTreeMap::new();
        entries
            .iter()
            .filter_map(|entry| self.clip(entry, several_avatars))
            .filter(|clip| seen.insert(clip.id.clone(), ()).is_none())
            .collect()
    }

    pub(super) fn clip(&self, entry: &ClipEntry, several_avatars: bool) -> Option<Clip> {
        let avatar = self.stimuli.avatars.get(&entry.avatar)?;
        let segment = self.stimuli.segments.iter().find(|each| each.id == entry.segment)?;
        let method = self.stimuli.methods.get(&entry.method)?;
        let mut factors = Factors::new();
        if let Some(performance) = segment.performance {
            let word = performance.expression.word().to_owned();
            factors.insert("expression".to_owned(), FactorValue::Text(word));
            let intensity = f64::from(performance.intensity);
            factors.insert("intensity".to_owned(), FactorValue::Number(intensity));
        }
        factors.insert("method".to_owned(), FactorValue::Text(entry.method.clone()));
        if self.groups_methods() {
            factors.insert("solverMethod".to_owned(), FactorValue::Text(method.word()));
        }
        if let Some(alpha) = method.spec.alpha {
            factors.insert("alpha".to_owned(), FactorValue::Number(alpha));
        }
        let sound = match &entry.sound {
            Some(name) => Some(self.stimuli.sounds.get_key_value(name)?),
            None => None,
        };
        if let Some((name, _)) = sound {
            factors.insert("sound".to_owned(), FactorValue::Text(name.clone()));
        }
        let of_sound = sound.map(|(_, rule)| &rule.factors);
        for given in
            [&avatar.factors, &segment.factors, &method.factors].into_iter().chain(of_sound)
        {
            factors.extend(given.iter().map(|(key, value)| (key.clone(), value.clone())));
        }
        let mut id = format!("{}.{}", entry.segment, entry.method);
        if several_avatars {
            id = format!("{id}.{}", entry.avatar);
        }
        if let Some(sound) = &entry.sound {
            id = format!("{id}.{sound}");
        }
        Some(Clip {
            id,
            avatar: entry.avatar.clone(),
            segment: entry.segment.clone(),
            method: entry.method.clone(),
            sound: entry.sound.clone(),
            factors,
        })
    }

    /// Whether the solver's methods are a factor of their own: one of them is there under several names, as with several
    /// parameters, and there are others.
    fn groups_methods(&self) -> bool {
        let methods = &self.stimuli.methods;
        let words: BTreeSet<String> = methods.values().map(MethodEntry::word).collect();
        words.len() > 1 && words.len() < methods.len()
    }

    /// Every factor that some clip has, in alphabetical order.
    pub fn factor_names(&self) -> Vec<String> {
        let drawn = self.clips_at_rest().into_iter().map(|(clip, _)| clip);
        let clips = self.clips().into_iter().chain(drawn);
        let names: BTreeSet<String> = clips.flat_map(|clip| clip.factors.into_keys()).collect();
        names.into_iter().collect()
    }
}
