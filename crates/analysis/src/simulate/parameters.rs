//! What a simulation assumes of people, clips and answers: the parameters file.
//!
//! | part | what it says |
//! |---|---|
//! | `ratings` | a scale each: mean, spreads of people, clips and noise, thresholds, effects |
//! | `recognition` | a question with a right answer each: confusion matrix, spreads, effects |
//! | `comparisons` | a question that chooses between two clips each: worths, spreads, side, ties |
//! | `panels` | a block of panels each: spread of pages, share of people who miss the reference |
//! | `discrimination` | an adaptive block each: threshold and its spread over people, spread, lapse |
//! | `scaling` | a block of difference scaling each: range and exponent of what is perceived, lapse |
//! | `templates` | a block of reverse correlation each: the faces that people have in mind, noise, criterion |
//! | `choices`, `numbers` | how other questions are answered, those about the participant too |
//! | `times` | log-normal answering times |
//! | `careless`, `attentionPass`, `dropout` | who does not take part as asked |
//! | `display` | late frames, replays, interruptions |
//!
//! A file may give any part; the rest is taken from the study's own defaults
//! ([`Parameters::for_study`]). Maps whose keys are levels or options (`effects`, `confusion`,
//! `personBySd`, a question's `choices`) are replaced whole, all else key by key.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::faces::FaceTemplates;
use super::scaling::PerceivedScale;

/// Level -> number.
pub type ByLevel = BTreeMap<String, f64>;

/// Everything that a simulation assumes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Parameters {
    /// Rating scales by response (`believability`, `grid.valence`).
    pub ratings: BTreeMap<String, Rating>,
    /// Questions whose right answer the clip holds.
    pub recognition: BTreeMap<String, Recognition>,
    /// Questions that choose between two clips.
    #[serde(default)]
    pub comparisons: BTreeMap<String, Compared>,
    /// Blocks of panels, beside the `ratings` of their question.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub panels: BTreeMap<String, PanelRatings>,
    /// Adaptive blocks: how people tell levels.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub discrimination: BTreeMap<String, Discrimination>,
    /// Blocks of difference scaling: what people perceive of the levels.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub scaling: BTreeMap<String, PerceivedScale>,
    /// Blocks of reverse correlation: the faces that people have in mind.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub templates: BTreeMap<String, FaceTemplates>,
    /// Other choices: share of each option.
    pub choices: BTreeMap<String, ByLevel>,
    /// Numbers that are typed.
    pub numbers: BTreeMap<String, NumberAnswer>,
    /// How long answers take.
    pub times: Times,
    /// People who answer without looking.
    pub careless: Careless,
    /// Probability that an attentive person passes an attention check.
    pub attention_pass: f64,
    /// People who do not reach the end.
    pub dropout: Dropout,
    /// How smoothly clips are shown, and what else happens meanwhile.
    pub display: Display,
}

/// A rating: a latent value in points of the scale, cut by thresholds.
///
/// latent = mean + person + person x level + segment + clip + effects + perTrial * trial + noise
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Rating {
    /// Mean of the latent value, points.
    pub mean: f64,
    /// Standard deviation from trial to trial.
    pub noise_sd: f64,
    /// Standard deviation of people.
    pub person_sd: f64,
    /// Standard deviation of how people take to the levels of a factor: factor -> sd.
    pub person_by_sd: ByLevel,
    /// Standard deviation of segments (performances), whatever the method.
    pub segment_sd: f64,
    /// Standard deviation of clips beyond their segment.
    pub clip_sd: f64,
    /// Borders between neighbouring points, ascending; half-way between them if empty.
    pub thresholds: Vec<f64>,
    /// Factor (of the clip, a question about the participant, or `assigned_condition`) -> level -> shift,
    /// points.
    pub effects: BTreeMap<String, ByLevel>,
    /// Shifts of combinations.
    pub interactions: Vec<Interaction>,
    /// Shift a trial: practice, or fatigue.
    pub per_trial: f64,
}

/// A shift where several factors have these levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Interaction {
    /// Factor -> level.
    pub levels: BTreeMap<String, String>,
    /// Shift.
    pub shift: f64,
}

/// A forced choice: a confusion matrix, and a latent value that decides whether the answer is right.
///
/// The row of the clip gives the share p of right answers over people and clips; the answer is right
/// where person + person x level + segment + clip + effects + noise exceeds the threshold that
/// leaves p above it (a probit, noise of standard deviation 1). A wrong answer is drawn by the row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Recognition {
    /// The second factor that tells rows apart (`intensity`); empty if there is none.
    pub by: String,
    /// Right answer -> level of `by` (`*` for every other) -> answer -> share. Shares of a row are
    /// relative; answers that are not named are never given.
    pub confusion: BTreeMap<String, BTreeMap<String, ByLevel>>,
    /// Standard deviation of people, in standard deviations of the noise.
    pub person_sd: f64,
    /// Factor -> standard deviation of how people take to its levels.
    pub person_by_sd: ByLevel,
    /// Standard deviation of segments.
    pub segment_sd: f64,
    /// Standard deviation of clips beyond their segment.
    pub clip_sd: f64,
    /// Factor -> level -> shift of the latent value.
    pub effects: BTreeMap<String, ByLevel>,
    /// Shifts of combinations.
    pub interactions: Vec<Interaction>,
    /// Where the question names a rating of `confidence`: by how much this is higher after a right answer than after a
    /// wrong one, in standard deviations of its noise.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub confidence: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A choice between two clips: Bradley and Terry's model with Davidson's ties and a side bias.
///
/// P(left) : P(same) : P(right) = exp(wl + s/2) : exp(t + (wl + wr)/2) : exp(wr - s/2); the worth of a clip is that
/// of its level + person x level + clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Compared {
    /// The factor of the clips whose levels have worths.
    pub factor: String,
    /// Level -> worth, log scale; 0 for what is not named. A difference of ln 3 = 1.1 is chosen in 75 %.
    pub worth: ByLevel,
    /// Standard deviation of how people take to each level.
    pub person_sd: f64,
    /// Standard deviation of a level from one segment to the other: of clips.
    pub segment_sd: f64,
    /// What standing on the left adds.
    pub side: f64,
    /// t: the logarithm of Davidson's nu. Of two equal clips exp(t) / (2 + exp(t)) of answers see no difference.
    pub tie: f64,
    /// Share of answers without looking.
    pub lapse: f64,
}

/// How people rate a block of panels: who finds the hidden reference rates it at the end of the scale, all else as the
/// `ratings` of the question say, the clips of a page with a shift in common.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PanelRatings {
    /// Standard deviation of the shift that the clips of a page have in common, points.
    pub page_sd: f64,
    /// Share of people who do not find the hidden reference and rate it as any other clip.
    pub misses_reference: f64,
}

/// How people tell the levels of an adaptive block: P(right) = 1/2 + (1/2 - lapse) Φ((level - threshold) / spread), or
/// P(yes) = false alarm + (1 - false alarm - lapse) Φ(...).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Discrimination {
    /// Mean threshold of people, in the unit of the level.
    pub threshold: f64,
    /// Standard deviation of thresholds from person to person.
    pub person_sd: f64,
    /// Spread of the function, above 0.
    pub spread: f64,
    /// Share of wrong answers where all is seen.
    pub lapse: f64,
    /// Blocks of yes or no: share of yes where nothing is seen.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub false_alarm: f64,
}

/// A number that is typed: normal, kept within the question's bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct NumberAnswer {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Answering times: each question takes a log-normal time after the one before (the first after the
/// clip).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Times {
    /// Median, milliseconds.
    pub median_ms: f64,
    /// Standard deviation of the logarithm from answer to answer.
    pub sigma: f64,
    /// Standard deviation of the logarithm from person to person.
    pub person_sigma: f64,
    /// Factor, as of ratings -> level -> shift of the logarithm (0.1: about 10 % longer).
    pub effects: BTreeMap<String, ByLevel>,
    /// Length of a clip, milliseconds.
    pub clip_ms: f64,
}

/// People who answer without looking: every answer equally likely, quickly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Careless {
    /// Their share.
    pub share: f64,
    /// Probability that they pass an attention check.
    pub attention_pass: f64,
    /// Their times as a share of other people's.
    pub time_share: f64,
}

/// People who do not reach the end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Dropout {
    /// Share who do not agree.
    pub declined: f64,
    /// Probability to leave at a trial.
    pub per_trial: f64,
    /// Share of those who leave who take their answers back.
    pub withdrawn: f64,
}

/// How smoothly clips are shown, and what else happens meanwhile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Display {
    /// Rate of the display, Hz.
    pub refresh_hz: f64,
    /// Share of late frames.
    pub late_share: f64,
    /// Share of people whose computer is slow.
    pub slow_people: f64,
    /// Share of late frames on a slow computer.
    pub slow_late_share: f64,
    /// Share of people whose browser has WebGL 2 alone.
    pub webgl2: f64,
    /// Probability to play a clip once more.
    pub replay: f64,
    /// Probability that a play is cut short (the clip is then played anew).
    pub cut_short: f64,
    /// Probability that the page loses the focus in a trial.
    pub focus_loss: f64,
    /// Probability that the page is opened anew in a trial.
    pub reload: f64,
}
