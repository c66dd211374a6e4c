//! How a session is conducted: which devices may take part, how large things are shown, how long
//! people have, whom the study turns away.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::LocalText;
use crate::question::Condition;

/// What a device must have. It is looked at right after consent; whoever cannot put right what is missing
/// is screened out with the reason.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct DeviceRules {
    /// Least width of the window, CSS pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_width: Option<u32>,
    /// Least height of the window, CSS pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_height: Option<u32>,
    /// Which kind of device.
    #[serde(default)]
    pub kind: DeviceKind,
    /// What the browser must draw with.
    #[serde(default)]
    pub backend: BackendRule,
    /// Least refresh rate of the display as the browser draws, Hz; 5 % below it still count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_refresh_hz: Option<f64>,
    /// Least share of its frames that a play must show to count, 0 to 1; of those that the display shows in
    /// the clip's time, 60 a second at most. A play below it is played once more; after the second one the
    /// session ends with `deviceCode`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_frame_share: Option<f64>,
    /// Whether the pages fill the screen.
    #[serde(default)]
    pub fullscreen: FullscreenRule,
}

/// Which kind of device.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum DeviceKind {
    /// Any.
    #[default]
    Any,
    /// A computer: its main pointer is a mouse or a touch pad.
    Desktop,
}

/// What the browser must draw with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum BackendRule {
    /// WebGPU or WebGL 2.
    #[default]
    Any,
    /// WebGPU alone.
    Webgpu,
}

/// Whether the pages fill the screen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum FullscreenRule {
    /// Nobody asks.
    #[default]
    No,
    /// Participants are asked and may go on without.
    Asked,
    /// No clip is played unless the pages fill the screen.
    Required,
}

/// How large a CSS pixel is, and how far away the eyes are: a page after the instructions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Calibration {
    /// Whether a bank card is held against the screen and its picture made as large.
    #[serde(default = "yes")]
    pub card: bool,
    /// Whether it can be left out (by those who have no card at hand).
    #[serde(default)]
    pub required: bool,
    /// A line below the heading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<LocalText>,
    /// Distance from eyes to screen that participants are asked to take, centimetres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_cm: Option<f64>,
    /// Whether participants are asked how far they sit.
    #[serde(default)]
    pub ask_distance: bool,
}

fn yes() -> bool {
    true
}

/// How long a page, or the answers of a trial, may take. The clock of a trial begins when its clip
/// was seen once. When it ends, the answers so far are sent and marked `timed_out`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct TimeLimit {
    /// Seconds.
    pub seconds: f64,
    /// How often a participant may get the same time again by one press: ten times unless the limit
    /// is essential (WCAG 2.2, success criterion 2.2.1).
    #[serde(default = "ten")]
    pub extensions: u32,
    /// Why the time cannot be extended as often as that; told before the clock begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub essential: Option<LocalText>,
}

fn ten() -> u32 {
    10
}

/// How many practice clips must be answered right before the study goes on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Criterion {
    /// Least number of clips of one round with every known answer right.
    pub correct: u32,
    /// Most rounds.
    pub maximum_rounds: u32,
    /// What happens after the last round without success.
    #[serde(default)]
    pub otherwise: AfterTraining,
}

/// What happens after the last round of practice without success.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum AfterTraining {
    /// The study goes on.
    #[default]
    GoOn,
    /// The participant is screened out.
    ScreenOut,
}

/// Right answers that no factor of the clip gives: clip -> question -> answer.
pub type StatedAnswers = BTreeMap<String, BTreeMap<String, Value>>;

/// What becomes of failed attention checks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct AttentionRule {
    /// How many may be failed.
    pub allowed_failures: u32,
    /// When the session of somebody who failed more ends.
    #[serde(default)]
    pub when: AttentionEnd,
}

/// When a session with too many failed attention checks ends.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum AttentionEnd {
    /// After the last page, like any other.
    #[default]
    AtEnd,
    /// Right after the check that was one too many.
    Immediately,
}

/// Whom the study does not take, by an answer of a page of questions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ScreeningRule {
    /// The answer that ends the session, once its page is sent.
    #[serde(rename = "if")]
    pub condition: Condition,
    /// Why, as the participant reads it.
    pub reason: LocalText,
}

/// Where answers go when the pages are hosted as files, without the server
/// (`mimique export-site`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct StaticHosting {
    /// Address that takes a session's JSON lines by POST; `{session}` stands for the session's
    /// name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub post: Option<String>,
    /// Whether every answer is posted as it comes, so that those who leave leave what they answered.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub post_progress: bool,
    /// Whether the participant is offered the answers as a file at the end.
    #[serde(default = "yes")]
    pub download: bool,
}

impl Default for StaticHosting {
    fn default() -> Self {
        Self { post: None, post_progress: false, download: true }
    }
}
