//! What is shown in which order: components, blocks of trials, sequences.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Criterion, FactorValue, LocalText, Question, StatedAnswers, TimeLimit};

/// A part of the study that a sequence names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "camelCase")]
pub enum Component {
    /// A block: one trial a clip.
    Trials(TrialsComponent),
    /// A block of paired comparisons.
    Pairs(#[schemars(with = "super::PairsComponent")] super::PairsBlock),
    /// A block of several clips a page, on one scale.
    Panel(#[schemars(with = "super::PanelComponent")] super::PanelBlock),
    /// A block whose levels follow the answers.
    Adaptive(#[schemars(with = "super::AdaptiveComponent")] super::AdaptiveBlock),
    /// A block of which differences between levels are larger.
    Scaling(#[schemars(with = "super::ScalingComponent")] super::ScalingBlock),
    /// A block of faces that move at random.
    ReverseCorrelation(
        #[schemars(with = "super::ReverseCorrelationComponent")] super::ReverseCorrelationBlock,
    ),
    /// A page of questions.
    Questionnaire(Questionnaire),
    /// A page to read.
    Page(PageComponent),
    /// A rest.
    Break(BreakComponent),
}

/// A block of trials, one a clip. In a sequence it stands for its trials: they take their places
/// by that sequence's order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct TrialsComponent {
    /// Which clips; all of them if not given.
    #[serde(default)]
    pub clips: ClipSelection,
    /// A line above the clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Identifiers of the study's `questions`, in the order they are asked.
    pub questions: Vec<String>,
    /// Most replays after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// How many times each clip is shown.
    #[serde(default = "once")]
    pub repetitions: u32,
    /// Beside each clip, in step with it: another clip of the same segment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beside: Option<Beside>,
    /// How long its answers may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
    /// The pairs that it shows in place of single clips: derived ([`super::PairsComponent::trials`]), in no study file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub pairs: Option<Box<super::DealtPairs>>,
    /// The panels that it shows in place of single clips: derived ([`super::PanelComponent::trials`]), in no study file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub panel: Option<Box<super::PanelPages>>,
}

/// What is played in step beside each clip of a block: the clip of the same segment by another
/// method, or of another avatar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Beside {
    /// Key of `stimuli.methods`.
    pub method: String,
    /// Key of `stimuli.avatars`; the clip's own if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avatar: Option<String>,
    /// On which side of the clip it stands.
    #[serde(default)]
    pub side: Side,
    /// A line below it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub caption: Option<LocalText>,
    /// A line below the clip itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip_caption: Option<LocalText>,
}

/// On which side of the clip its companion stands, on every screen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Side {
    /// Always left.
    Left,
    /// Always right.
    #[default]
    Right,
    /// Drawn for each trial, each side in half of a participant's trials.
    Random,
}

/// How the clips of a trial of several are shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum ClipShowing {
    /// Side by side, in step.
    #[default]
    InStep,
    /// Side by side, one after the other from left to right.
    InTurn,
}

impl ClipShowing {
    fn is_in_step(&self) -> bool {
        *self == Self::InStep
    }
}

fn once() -> u32 {
    1
}

/// Which clips a block shows. With both parts, a clip must be in the list and have the factors.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ClipSelection {
    /// Clip identifiers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ids: Vec<String>,
    /// Factor -> the values that are taken.
    #[serde(default, rename = "where", skip_serializing_if = "BTreeMap::is_empty")]
    pub factors: BTreeMap<String, Vec<FactorValue>>,
}

/// A page of questions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Questionnaire {
    /// Heading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<LocalText>,
    /// A line below it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<LocalText>,
    /// The questions.
    pub questions: Vec<Question>,
    /// How long the page may stand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
}

/// A page to read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PageComponent {
    /// Heading.
    pub heading: LocalText,
    /// Text; an empty line parts paragraphs.
    pub text: LocalText,
    /// How long the page may stand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
}

/// A rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct BreakComponent {
    /// Heading.
    pub heading: LocalText,
    /// Text.
    pub text: LocalText,
    /// Shortest rest in seconds.
    #[serde(default)]
    pub minimum_seconds: f64,
}

/// Trials for practice, shown in this order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Training {
    /// Clip identifiers.
    pub clips: Vec<String>,
    /// The clip that stands to the right of a practice clip: clip -> clip. A question that chooses between two clips
    /// needs one beside each.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub beside: BTreeMap<String, String>,
    /// How the two are shown.
    #[serde(default, skip_serializing_if = "ClipShowing::is_in_step")]
    pub show: ClipShowing,
    /// Identifiers of the study's `questions`.
    pub questions: Vec<String>,
    /// A line above the clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Whether each practice clip is followed by a page that says which answers were right. Right
    /// is what the question's `truth` says of the clip, or `answers`.
    #[serde(default)]
    pub feedback: bool,
    /// Right answers that no factor of the clip gives: clip -> question -> answer.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub answers: StatedAnswers,
    /// How many clips must be answered right before the study goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub criterion: Option<Criterion>,
    /// How long its answers may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
}

/// Components, or further sequences, in an order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Sequence {
    /// Name of a nested sequence, for the export's column `condition`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Whether a nested sequence is shown to some participants only: those whose address says
    /// `?condition=ID`, and those who are given this condition since theirs names none. It may be
    /// empty, for a condition with nothing of its own.
    #[serde(default)]
    pub conditional: bool,
    /// How the parts are ordered.
    pub order: OrderRule,
    /// Names of components, or sequences that stay together.
    pub components: Vec<SequenceItem>,
    /// Components put in after every so many trials of this sequence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub interruptions: Vec<Interruption>,
    /// What a random order must keep to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<Constraint>,
    /// Show only so many of the parts to each participant, each part equally often over
    /// participants.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub num_samples: Option<usize>,
}

/// A part of a sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SequenceItem {
    /// Name of a component.
    Component(String),
    /// A sequence that stays together.
    Sequence(Box<Sequence>),
}

/// How the parts of a sequence are ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum OrderRule {
    /// As in the file.
    Fixed,
    /// Every order that the constraints allow.
    Random,
    /// A Williams square: over participants, each part stands at each place, and follows each other
    /// part, equally often.
    LatinSquare,
}

/// A component put in after every so many trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Interruption {
    /// Name of a component: a break, a page or a questionnaire.
    pub component: String,
    /// Number of trials between two of them. None is put after the last trial.
    pub spacing: usize,
    /// Number of trials before the first one; `spacing` if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_location: Option<usize>,
}

/// What a random order must keep to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Constraint {
    /// A factor; `segment`, `avatar` and `clip` can be named too.
    pub factor: String,
    /// Most trials in a row with the same value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most_alike: Option<usize>,
    /// Fewest trials from one with a value to the next with the same value (1: next to each other).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_distance: Option<usize>,
}

impl Beside {
    /// The companion of `clip` among `clips`; `None` where the study makes no such clip, or where
    /// it would be the clip itself.
    pub fn of<'a>(&self, clip: &super::Clip, clips: &'a [super::Clip]) -> Option<&'a super::Clip> {
        let avatar = self.avatar.as_ref().unwrap_or(&clip.avatar);
        clips.iter().find(|each| {
            each.segment == clip.segment
                && each.method == self.method
                && each.avatar == *avatar
                && each.factors.get("sound") == clip.factors.get("sound")
                && each.id != clip.id
        })
    }
}

impl Component {
    /// Whether it stands for trials.
    pub fn is_block(&self) -> bool {
        !matches!(self, Self::Questionnaire(_) | Self::Page(_) | Self::Break(_))
    }
}

impl TrialsComponent {
    /// Each clip that is shown with what stands beside it; of pairs each pair once, whatever its sides. The clips of a
    /// panel are answered one by one: nothing stands beside them.
    pub fn shown<'c>(
        &self,
        clips: &'c [super::Clip],
    ) -> Vec<(&'c super::Clip, Option<&'c super::Clip>)> {
        let Some(pairs) = &self.pairs else {
            let taken = clips.iter().filter(|clip| self.clips.takes(clip));
            let companion = |clip| self.beside.as_ref().and_then(|beside| beside.of(clip, clips));
            return taken.map(|clip| (clip, companion(clip))).collect();
        };
        let mut places: Vec<[usize; 2]> = pairs.slots.iter().flatten().copied().collect();
        places.iter_mut().for_each(|pair| pair.sort_unstable());
        places.sort_unstable();
        places.dedup();
        let clip = |place: usize| clips.iter().find(|clip| clip.id == pairs.clips[place]);
        places.into_iter().filter_map(|[one, other]| Some((clip(one)?, clip(other)))).collect()
    }

    /// How many trials each participant is shown.
    pub fn trial_count(&self, clips: &[super::Clip]) -> usize {
        match (&self.pairs, &self.panel) {
            (Some(pairs), _) => pairs.each(),
            (_, Some(panel)) => panel.pages.len(),
            (None, None) => {
                let taken = clips.iter().filter(|clip| self.clips.takes(clip)).count();
                taken.saturating_mul(self.repetitions as usize)
            }
        }
    }

    /// Whether the answers of its trials are about two clips.
    pub fn shows_two(&self) -> bool {
        self.beside.is_some() || self.pairs.is_some()
    }
}

impl ClipSelection {
    /// Whether every clip is taken.
    pub fn is_everything(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the block shows this clip.
    pub fn takes(&self, clip: &super::Clip) -> bool {
        (self.ids.is_empty() || self.ids.contains(&clip.id))
            && self.factors.iter().all(|(factor, wanted)| {
                clip.factor_text(factor)
                    .is_some_and(|value| wanted.iter().any(|each| each.to_string() == value))
            })
    }
}
