//! A block whose levels follow the answers: a parameter of a method is varied, and the clip of each level is
//! told apart from one that stays the same.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::json_block::JsonBlock;
use super::{Clip, ClipEntry, Component, FactorValue, LocalText, MethodEntry, Study};

/// A block of trials whose levels follow the answers. Each trial shows the varied clip and the one that it is held
/// against side by side, in step, and asks which of them is the varied one, or whether they differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct AdaptiveComponent {
    /// What is varied: the nearer the level is to `to`, the more easily the clip must be told from the other.
    pub vary: Varied,
    /// Key of `stimuli.methods`: the method whose parameter is varied.
    pub method: String,
    /// Key of `stimuli.methods`: what the varied clip is held against, a clip of the same segment.
    pub against: String,
    /// Identifiers of segments that take turns; all of them if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<String>,
    /// Key of `stimuli.avatars`; may be left out where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avatar: Option<String>,
    /// What chooses the levels.
    pub rule: LevelRule,
    /// Trials of each track, at most.
    pub trials: u32,
    /// QUEST+ alone: a track ends as soon as the standard deviation of its threshold is below this, though not
    /// before 20 trials. In the unit of the parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop_sd: Option<f64>,
    /// Tracks that are mixed, each with levels of its own.
    #[serde(default = "one")]
    pub tracks: u32,
    /// Further trials that no track counts, as a share of all tracks' trials. They are at the easiest level and show who
    /// does not look; where the answer is `yes` or not they are at `from`, and show who says yes without a difference.
    #[serde(default)]
    pub catch: f64,
    /// Identifier of one of the study's `questions`, of type `comparison` without `allowSame`: which of the two clips
    /// is the varied one. With `yes`: of type `singleChoice` with two options.
    pub question: String,
    /// The option of a `singleChoice` that says that the clips differ: `yes`. Nobody is then right by chance, and catch
    /// trials are required.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yes: Option<String>,
    /// A line above the clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Most replays after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// Which clips are shown of each segment: derived ([`Study::adaptive`]), in no study file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(skip)]
    pub shown: Vec<ShownSegment>,
    /// Trials, at most, catch trials among them: derived ([`Study::adaptive`]), in no study file.
    #[serde(default, skip_serializing_if = "is_none_at_all")]
    #[schemars(skip)]
    pub steps: usize,
}

pub(super) fn is_none_at_all(count: &usize) -> bool {
    *count == 0
}

/// The clips of one segment of a block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShownSegment {
    /// What the clips of all levels are called but for the level: `joy2.lsts@alpha=`.
    pub levels: String,
    /// Clip that a level is held against.
    pub against: String,
}

/// A parameter and the levels that it may take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Varied {
    /// A number among the method's parameters: `alpha`, `gain`.
    pub parameter: String,
    /// The level that is hardest to tell from the other clip.
    pub from: f64,
    /// The level that is easiest to tell, above or below it.
    pub to: f64,
    /// How many levels there are, equally far from each other.
    pub levels: u32,
}

/// What chooses the levels: one of the two.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LevelRule {
    /// The level whose answer is expected to tell most (Watson 2017, Journal of Vision 17(3):10).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quest_plus: Option<QuestPlusRule>,
    /// Down after some right answers in a row, up after a wrong one (Levitt 1971, J. Acoust. Soc. Am. 49, 467).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub staircase: Option<StaircaseRule>,
}

/// What QUEST+ takes for possible.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct QuestPlusRule {
    /// Form of the psychometric function.
    #[serde(default)]
    pub function: PsychometricFunction,
    /// Thresholds: the lowest, the highest, how many.
    pub threshold: [f64; 3],
    /// Spreads (of Weibull: slopes).
    pub spread: Vec<f64>,
    /// Shares of wrong answers where all is seen.
    #[serde(default = "one_lapse")]
    pub lapse: Vec<f64>,
}

/// Form of a psychometric function.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum PsychometricFunction {
    /// Cumulative normal: the threshold is its mean, the spread its standard deviation.
    #[default]
    Normal,
    /// Logistic.
    Logistic,
    /// Weibull, of levels above 0.
    Weibull,
}

/// How a staircase goes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct StaircaseRule {
    /// Right answers in a row before a step down.
    pub down: u32,
    /// Steps in the unit of the parameter: the first until the first reversal, then the next, the last for good.
    pub steps: Vec<f64>,
    /// First level; the easiest if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f64>,
}

fn one() -> u32 {
    1
}

fn one_lapse() -> Vec<f64> {
    vec![0.02]
}

impl Varied {
    /// How easily a level is told, as a number that rises with it: the level, or minus the level where levels fall
    /// from the hardest to the easiest. The same takes such a number back to its level.
    pub fn ease(&self, level: f64) -> f64 {
        if self.from <= self.to { level } else { -level }
    }

    /// The levels, from the hardest to the easiest.
    pub fn all(&self) -> Vec<f64> {
        let steps = f64::from(self.levels.saturating_sub(1).max(1));
        let level = |step: u32| self.from + (self.to - self.from) * f64::from(step) / steps;
        (0..self.levels).map(|step| tidy(level(step))).collect()
    }
}

/// To 12 decimals, so that a level has a short name.
fn tidy(level: f64) -> f64 {
    let scaled = level * 1e12;
    if scaled.abs() < 9e15 { libm::round(scaled) / 1e12 } else { level }
}

impl AdaptiveComponent {
    /// Share of answers that the difference is seen where nobody sees it: one of two clips by chance, or none.
    pub fn guess(&self) -> f64 {
        if self.yes.is_some() { 0.0 } else { 0.5 }
    }

    /// The level of catch trials: where everybody sees the difference, or where there is none.
    pub fn catch_level(&self) -> f64 {
        if self.yes.is_some() { self.vary.from } else { self.vary.to }
    }

    /// Whether an answer says that the difference is seen: the varied clip was chosen, or `yes`. `left`: whether the clip
    /// that stays the same stands left.
    pub fn seen(&self, answer: &str, left: bool) -> Option<bool> {
        match (&self.yes, answer) {
            (Some(yes), answer) => Some(yes == answer),
            (None, "left") => Some(!left),
            (None, "right") => Some(left),
            _ => None,
        }
    }

    /// Whether that is right: in a catch trial without a difference it is not.
    pub fn is_right(&self, seen: bool, catch: bool) -> bool {
        seen != (catch && self.yes.is_some())
    }

    /// Catch trials.
    pub fn catches(&self) -> usize {
        let counted = f64::from(self.trials) * f64::from(self.tracks);
        libm::round(counted * self.catch.clamp(0.0, 1.0)) as usize
    }
}

/// The block as pages carry it.
pub type AdaptiveBlock = JsonBlock<AdaptiveComponent>;

impl AdaptiveBlock {
    /// Trials, at most, of a projected block.
    pub fn steps(&self) -> u64 {
        self.0["steps"].as_u64().unwrap_or_default()
    }
}

/// A clip of a level.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelClip {
    /// The clip, as trials show it.
    pub clip: Clip,
    /// Its method, the parameter at its level.
    pub method: MethodEntry,
    /// The level.
    pub level: f64,
    /// Component that shows it.
    pub component: String,
}

impl Study {
    /// The adaptive blocks, by name, each with the clips that it shows. What cannot be read is left out: the check
    /// reports it.
    pub fn adaptive(&self) -> impl Iterator<Item = (&str, AdaptiveComponent)> {
        self.components.iter().filter_map(|(name, component)| match component {
            Component::Adaptive(block) => {
                let mut block = block.read().ok()?;
                block.shown = self.shown(&block).into_iter().map(|(_, shown)| shown).collect();
                let counted = (block.trials as usize).saturating_mul(block.tracks as usize);
                block.steps = counted.saturating_add(block.catches());
                Some((name.as_str(), block))
            }
            _ => None,
        })
    }

    /// Whether an adaptive block asks a question.
    pub fn is_asked_of_levels(&self, question: &str) -> bool {
        self.components
            .values()
            .any(|each| matches!(each, Component::Adaptive(block) if block.question() == question))
    }

    /// The clip of each of the segments (all of them if none is named) by a method, of an avatar (the only one if none
    /// is named): what levels are varied of.
    pub(super) fn varied(
        &self,
        avatar: Option<&String>,
        segments: &[String],
        method: &str,
    ) -> Vec<Clip> {
        let avatars = &self.stimuli.avatars;
        let only = || avatars.keys().next().filter(|_| avatars.len() == 1);
        let Some(avatar) = avatar.or_else(only) else { return Vec::new() };
        let clips = self.clips();
        let several = clips.iter().any(|clip| clip.avatar != clips[0].avatar);
        let taken = self.stimuli.segments.iter();
        let taken = taken.filter(|each| segments.is_empty() || segments.contains(&each.id));
        let of = |segment: &super::Segment| {
            let entry = ClipEntry {
                avatar: avatar.clone(),
                segment: segment.id.clone(),
                method: method.to_owned(),
                sound: None,
            };
            self.clip(&entry, several)
        };
        taken.filter_map(of).collect()
    }

    /// Of each segment of a block: the clip of its method without a level, and what is shown.
    fn shown(&self, block: &AdaptiveComponent) -> Vec<(Clip, ShownSegment)> {
        let clips = self.clips();
        let of = |varied: Clip| {
            let is_other = |clip: &&Clip| {
                clip.segment == varied.segment
                    && clip.method == block.against
                    && clip.avatar == varied.avatar
            };
            let against = clips.iter().find(is_other)?.id.clone();
            let levels = format!("{}@{}=", varied.id, block.vary.parameter);
            Some((varied, ShownSegment { levels, against }))
        };
        let varied = self.varied(block.avatar.as_ref(), &block.segments, &block.method);
        varied.into_iter().filter_map(of).collect()
    }

    /// The clips of every level of every adaptive block and every block of difference scaling, in the order of
    /// components, segments and levels.
    pub fn level_clips(&self) -> Vec<LevelClip> {
        let mut all: Vec<LevelClip> = Vec::new();
        let mut add = |component: &str, varied: &Clip, parameter: &str, levels: &[f64]| {
            for &level in levels {
                let id = format!("{}@{parameter}={level}", varied.id);
                let Some(method) = self.method_at(&varied.method, parameter, level) else {
                    continue;
                };
                if all.iter().any(|known| known.clip.id == id) {
                    continue;
                }
                let mut clip = Clip { id, ..varied.clone() };
                if parameter == "alpha" {
                    clip.factors.insert("alpha".to_owned(), FactorValue::Number(level));
                }
                all.push(LevelClip { clip, method, level, component: component.to_owned() });
            }
        };
        for (component, block) in self.adaptive() {
            for (varied, _) in self.shown(&block) {
                add(component, &varied, &block.vary.parameter, &block.vary.all());
            }
        }
        for (component, block) in self.scalings() {
            for varied in self.varied(block.avatar.as_ref(), &block.segments, &block.method) {
                add(component, &varied, &block.parameter, &block.levels);
            }
        }
        all
    }

    /// A method with a parameter at a level; none where there is no such method or parameter.
    fn method_at(&self, method: &str, parameter: &str, level: f64) -> Option<MethodEntry> {
        let entry = self.stimuli.methods.get(method)?;
        let mut spec = serde_json::to_value(&entry.spec).ok()?;
        spec[parameter] = level.into();
        let spec = mimique_solver::MethodSpec::checked(&spec).ok()?;
        Some(MethodEntry { spec, ..entry.clone() })
    }
}
