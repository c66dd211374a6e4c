//! A block of dynamic reverse correlation: each trial shows a face whose action units move at random, drawn from the
//! seed, and asks what it is.

use mimique_adaptive::TrajectoryDesign;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::json_block::JsonBlock;
use super::{Avatar, Clip, Component, LocalText, Study, TimeLimit};

/// A block of dynamic reverse correlation (Yu, Garrod and Schyns 2012; Jack et al. 2012). Nothing but the avatar is
/// downloaded: the browser draws which units move, when and how far, from the study's seed and the participant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ReverseCorrelationComponent {
    /// Key of `stimuli.avatars`; may be left out where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avatar: Option<String>,
    /// Action units that are drawn from, by their numbers in FACS: `AU04`, `AU12`, of one side `AU12_L`.
    pub units: Vec<String>,
    /// Trials of each participant.
    pub trials: u32,
    /// How long the face moves, seconds.
    #[serde(default = "usual_duration")]
    pub duration_seconds: f64,
    /// Units of a trial on average, from 1; 3, or all of fewer, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_units: Option<f64>,
    /// Units of a trial at most; 6, or all of fewer, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_units: Option<u32>,
    /// Lowest and highest peak of a unit, above 0 to 1.
    #[serde(default = "usual_amplitude")]
    pub amplitude: [f64; 2],
    /// Identifier of one of the study's `questions`, of type `singleChoice`: what the face is. Its options are the
    /// categories.
    pub question: String,
    /// Identifier of one of the study's `questions`, of type `likert` or `slider`: how intense it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub intensity: Option<String>,
    /// A line above the face.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Most replays after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// How long the answers may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
    /// The clip of the avatar at rest: derived ([`Study::reverse_correlations`]), in no study file.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(skip)]
    pub clip: String,
}

fn usual_duration() -> f64 {
    TrajectoryDesign::of_units(1).duration_s
}

fn usual_amplitude() -> [f64; 2] {
    TrajectoryDesign::of_units(1).amplitude
}

impl ReverseCorrelationComponent {
    /// What the trajectories are drawn from.
    pub fn design(&self) -> TrajectoryDesign {
        let usual = TrajectoryDesign::of_units(self.units.len());
        let most_units = self.most_units.map_or(usual.most_units, |most| most as usize);
        TrajectoryDesign {
            duration_s: self.duration_seconds,
            mean_units: self.mean_units.unwrap_or(usual.mean_units.min(most_units as f64)),
            most_units,
            amplitude: self.amplitude,
            ..usual
        }
    }

    /// The questions of every trial.
    pub fn questions(&self) -> Vec<String> {
        [&self.question].into_iter().chain(&self.intensity).cloned().collect()
    }
}

/// The block as pages carry it.
pub type ReverseCorrelationBlock = JsonBlock<ReverseCorrelationComponent>;

impl ReverseCorrelationBlock {
    /// Trials of each participant.
    pub fn trials(&self) -> u64 {
        self.0["trials"].as_u64().unwrap_or_default()
    }

    /// The clip of the avatar at rest, of a projected block.
    pub fn clip(&self) -> &str {
        self.0["clip"].as_str().unwrap_or_default()
    }

    /// The questions of every trial.
    pub fn questions(&self) -> Vec<String> {
        let asked = [&self.0["question"], &self.0["intensity"]];
        asked.into_iter().filter_map(|id| Some(id.as_str()?.to_owned())).collect()
    }
}

impl Study {
    /// The blocks of reverse correlation, by name, each with its clip. What cannot be read is left out: the check
    /// reports it.
    pub fn reverse_correlations(
        &self,
    ) -> impl Iterator<Item = (&str, ReverseCorrelationComponent)> {
        self.components.iter().filter_map(|(name, component)| match component {
            Component::ReverseCorrelation(block) => {
                let mut block = block.read().ok()?;
                block.clip = [name, "@drawn"].concat();
                Some((name.as_str(), block))
            }
            _ => None,
        })
    }

    /// Whether a block of reverse correlation asks a question.
    pub fn is_asked_of_drawn_faces(&self, question: &str) -> bool {
        let mut blocks = self.reverse_correlations();
        blocks.any(|(_, block)| block.questions().iter().any(|id| id == question))
    }

    /// Whether a question's answers are about no clip of the list: levels follow answers, or faces are drawn at random.
    pub fn is_asked_of_no_clip(&self, question: &str) -> bool {
        self.is_asked_of_levels(question)
            || self.is_asked_of_scales(question)
            || self.is_asked_of_drawn_faces(question)
    }

    /// The avatar of a block of reverse correlation, by its key.
    pub fn avatar_of_faces(
        &self,
        block: &ReverseCorrelationComponent,
    ) -> Option<(&String, &Avatar)> {
        let avatars = &self.stimuli.avatars;
        match &block.avatar {
            Some(named) => avatars.get_key_value(named),
            None => avatars.iter().next().filter(|_| avatars.len() == 1),
        }
    }

    /// The clip of the avatar at rest of every block of reverse correlation, which its trials move, with the block.
    pub fn clips_at_rest(&self) -> Vec<(Clip, ReverseCorrelationComponent)> {
        let of = |(_, block): (&str, ReverseCorrelationComponent)| {
            let (avatar, entry) = self.avatar_of_faces(&block)?;
            let clip = Clip {
                id: block.clip.clone(),
                avatar: avatar.clone(),
                segment: String::new(),
                method: String::new(),
                sound: None,
                factors: entry.factors.clone(),
            };
            Some((clip, block))
        };
        self.reverse_correlations().filter_map(of).collect()
    }
}
