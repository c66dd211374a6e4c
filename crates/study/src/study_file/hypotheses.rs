//! What is tested, and which rules leave trials out: read by the statistics.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::LocalText;

/// One hypothesis and its test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Hypothesis {
    /// Short name: `H1`.
    pub id: String,
    /// What is supposed, as a sentence.
    pub statement: LocalText,
    /// The test, by its name in `mimique test`.
    pub test: TestName,
    /// Identifier of a question that trials ask; of one that gives several answers, a part: `grid.valence`, a row
    /// of a matrix, an option of a ranking.
    pub response: String,
    /// What of the response is tested.
    #[serde(default)]
    pub measure: Measure,
    /// The factors: one for most tests, two for an interaction. Factors of the clips, questions about the
    /// participant, or `assigned_condition`: the condition that the participant is in.
    pub factors: Vec<String>,
    /// The levels of the first factor that are compared, in the order of signs; all if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<super::FactorValue>,
    /// Which clips the hypothesis is about. Without it, or with `clips`, levels and interactions are decided for other people
    /// and other clips alike, by a linear mixed model with random effects of people and of segments. With `these clips` the
    /// test of these clips decides, and the report says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub generalise: Option<Generalise>,
    /// Of the test `equivalence`: the smallest difference that matters, either way, in points of the scale (of right
    /// answers a share from 0 to 1, of response times seconds).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_effect: Option<f64>,
    /// Why a smaller difference does not matter: the preregistration says it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_effect_reason: Option<LocalText>,
}

/// Which clips a hypothesis is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Generalise {
    /// Other people, and other clips of other segments.
    Clips,
    /// Other people who see these clips.
    #[serde(rename = "these clips")]
    TheseClips,
}

/// A test, by its name in `mimique test`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TestName {
    /// k independent groups.
    KruskalWallis,
    /// Two paired samples.
    Wilcoxon,
    /// Two independent samples.
    MannWhitney,
    /// Two factors on ranks.
    ScheirerRayHare,
    /// A contingency table.
    ChiSquare,
    /// A monotone relation.
    Spearman,
    /// k related samples.
    Friedman,
    /// Factors and their interaction on aligned ranks.
    AlignedRankTransform,
    /// Which of two is chosen more often, of answers that choose between clips.
    Sign,
    /// Worths of several from answers that choose between two of them.
    BradleyTerry,
    /// Whether two differ by less than the smallest difference that matters: two one-sided tests.
    Equivalence,
}

/// Segments that a verdict about other clips needs at least: fewer do not show how far other segments would differ.
pub const SEGMENTS_FOR_OTHER_CLIPS: usize = 5;

impl Hypothesis {
    /// Whether it is decided for other people and other clips alike, not for these clips.
    pub fn is_about_other_clips(&self) -> bool {
        self.test.holds_for_other_clips() && self.generalise != Some(Generalise::TheseClips)
    }
}

impl TestName {
    /// Whether it is a test of answers that choose between two clips.
    pub fn is_of_choices(self) -> bool {
        matches!(self, Self::Sign | Self::BradleyTerry)
    }

    /// Whether it compares levels, and not two factors, a relation, choices or counts.
    pub fn compares_levels(self) -> bool {
        matches!(self, Self::KruskalWallis | Self::Wilcoxon | Self::MannWhitney | Self::Friedman)
    }

    /// Whether there is a test of it that is about other clips too: of levels that are compared, of their equivalence, of
    /// interactions and of choices.
    pub fn holds_for_other_clips(self) -> bool {
        self != Self::Spearman
    }

    /// As a study file writes it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::KruskalWallis => "kruskal-wallis",
            Self::Wilcoxon => "wilcoxon",
            Self::MannWhitney => "mann-whitney",
            Self::ScheirerRayHare => "scheirer-ray-hare",
            Self::ChiSquare => "chi-square",
            Self::Spearman => "spearman",
            Self::Friedman => "friedman",
            Self::AlignedRankTransform => "aligned-rank-transform",
            Self::Sign => "sign",
            Self::BradleyTerry => "bradley-terry",
            Self::Equivalence => "equivalence",
        }
    }
}

/// What of a response is tested.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Measure {
    /// The answer itself.
    #[default]
    Answer,
    /// Whether it is right.
    Correct,
    /// The response time.
    Rt,
}

/// Rules, fixed beforehand, that leave trials or people out.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Exclusions {
    /// Leave out a trial with more than this share of late frames (0..1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub late_frame_share: Option<f64>,
    /// Leave out a trial with a frame longer than this, milliseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longest_frame_ms: Option<f64>,
    /// Leave out a trial answered sooner than this after answers could first be given, milliseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shortest_rt_ms: Option<f64>,
    /// Leave out a trial whose sound was not played, or was heard more than this, milliseconds, beside the time
    /// that the study asks for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound_offset_ms: Option<f64>,
    /// Leave out a participant who did not hear the tones of the sound check.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub sound_not_heard: bool,
    /// Leave out a participant who gave the same answer in too many trials in a row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_lining: Option<StraightLining>,
    /// Leave out a participant who failed more attention checks than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed_attention_checks: Option<u32>,
    /// Leave out a participant who did not finish.
    #[serde(default)]
    pub incomplete: bool,
}

/// A rule against straight-lining: the longest run of equal answers (the long-string index of Johnson 2005,
/// Journal of Research in Personality 39, 103-129). Runs are counted question by question over the trials
/// in their order, practice not counted; a question left unanswered neither ends a run nor adds to it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct StraightLining {
    /// Leave out a participant with more equal answers in a row than this.
    pub longest_run: u32,
    /// The questions whose answers are looked at. Without them: all that are asked in trials and answered
    /// on a scale or by options, but attention checks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub questions: Vec<String>,
}
