//! A block of difference scaling: how a perceived difference grows with a parameter of a method, from judgements which
//! of two pairs of its levels differ more (Maloney and Yang 2003).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::adaptive::is_none_at_all;
use super::json_block::JsonBlock;
use super::{Component, LocalText, Study, TimeLimit};

/// A block of difference scaling. Each trial shows the same segment at three or four levels of a method's parameter, in
/// step, and asks which of two pairs of them differ more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ScalingComponent {
    /// A number among the method's parameters: `alpha`, `gain`.
    pub parameter: String,
    /// Its levels, ascending, 5 to 11.
    pub levels: Vec<f64>,
    /// Key of `stimuli.methods`: the method whose parameter is scaled.
    pub method: String,
    /// Identifiers of segments that are shown; all of them if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<String>,
    /// Key of `stimuli.avatars`; may be left out where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avatar: Option<String>,
    /// How many levels a trial shows.
    #[serde(default)]
    pub rule: ScalingRule,
    /// Trials of each participant: drawn from all sets of levels and segments, none twice before all were shown.
    pub trials: u32,
    /// Identifier of one of the study's `questions`, of type `singleChoice` with two options: the first says that the
    /// first pair differs more (of three clips the first and the second), the second that the second pair does.
    pub question: String,
    /// A line above the clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Most replays after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// How long the answer may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
    /// What the clips of each segment are called but for the level, `joy2.lsts@alpha=`: derived
    /// ([`Study::scalings`]), in no study file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(skip)]
    pub shown: Vec<String>,
    /// Levels of a trial: derived, in no study file.
    #[serde(default, skip_serializing_if = "is_none_at_all")]
    #[schemars(skip)]
    pub each: usize,
}

/// How many levels a trial shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum ScalingRule {
    /// Three, a < b < c or the other way round: do the first two differ more, or the last two?
    #[default]
    Triads,
    /// Four, a < b < c < d or the other way round: do the first two differ more, or the last two?
    Quadruples,
}

impl ScalingRule {
    /// Levels of a trial.
    pub fn each(self) -> usize {
        match self {
            Self::Triads => 3,
            Self::Quadruples => 4,
        }
    }

    /// The two pairs that a trial's levels, as they stand, are judged as.
    pub fn pairs(levels: &[f64]) -> Option<[f64; 4]> {
        match *levels {
            [a, b, c] => Some([a, b, b, c]),
            [a, b, c, d] => Some([a, b, c, d]),
            _ => None,
        }
    }
}

/// The block as pages carry it.
pub type ScalingBlock = JsonBlock<ScalingComponent>;

impl Study {
    /// The blocks of difference scaling, by name, each with the clips that it shows. What cannot be read is left out:
    /// the check reports it.
    pub fn scalings(&self) -> impl Iterator<Item = (&str, ScalingComponent)> {
        self.components.iter().filter_map(|(name, component)| match component {
            Component::Scaling(block) => {
                let mut block = block.read().ok()?;
                let varied = self.varied(block.avatar.as_ref(), &block.segments, &block.method);
                let prefix = |clip: &super::Clip| format!("{}@{}=", clip.id, block.parameter);
                block.shown = varied.iter().map(prefix).collect();
                block.each = block.rule.each();
                Some((name.as_str(), block))
            }
            _ => None,
        })
    }

    /// Whether a block of difference scaling asks a question.
    pub fn is_asked_of_scales(&self, question: &str) -> bool {
        self.components
            .values()
            .any(|each| matches!(each, Component::Scaling(block) if block.question() == question))
    }
}
