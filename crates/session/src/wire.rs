//! What passes between the participant's page and the server, as JSON.
//!
//! | request | body | answer |
//! |---|---|---|
//! | `GET  /api/studies` | | list of [`StudySummary`] |
//! | `GET  /api/studies/{study}` | | [`Bundle`]; with `?config_hash=` that of an earlier version |
//! | `POST /api/studies/{study}/arrivals` | [`StartSession`] | `null`, or why this participant cannot begin |
//! | `POST /api/studies/{study}/sessions` | [`StartSession`] | [`SessionStarted`] |
//! | `GET  /api/sessions/{session}` | | [`Resume`] |
//! | `POST /api/sessions/{session}/events` | [`AppendEvents`] | [`Acknowledged`] |
//! | `POST /api/sessions/{session}/complete` | [`Complete`] | [`Receipt`] |
//! | `POST /api/sessions/{session}/withdraw` | [`Withdraw`] | [`Withdrawn`] |
//! | `POST /api/panics` | [`PanicReport`] | `null` |
//! | `GET  /packs/{sha256}` | | bytes of a stimulus pack, cacheable for ever |
//!
//! Every refusal is a [`Refusal`] with a 4xx status. An append is idempotent: an event is known by
//! (session, sequence), and sending it again changes nothing. Another event under a sequence that is
//! stored (two windows with one session) is kept apart, the rest of its request is stored, and the
//! answer is 409 `event-conflict` with [`Refusal::sequences`]: resume, then go on.

use std::collections::BTreeMap;

use mimique_study::{ClipSource, StudyProjection};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// One study on this server.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StudySummary {
    /// Identifier used in addresses.
    pub id: String,
    /// Title a language.
    pub title: Value,
    /// SHA-256 of the canonical study file, hexadecimal.
    pub config_hash: String,
}

/// Everything the participant's page needs: the study and where its clips are. The page hands the clips
/// on to the stage as they came, and reads a `Bundle<Value>`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Bundle<Clip = ClipSource> {
    /// Identifier used in addresses.
    pub study_id: String,
    /// SHA-256 of the canonical study file, hexadecimal.
    pub config_hash: String,
    /// The study.
    pub study: StudyProjection,
    /// Every clip, by its identifier in the study.
    pub clips: BTreeMap<String, Clip>,
}

/// A participant begins: has agreed, on a device that may take part. From then on a place is held, and the
/// identifier is used. Sent to `arrivals` before that it asks whether there is a place, and changes nothing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartSession {
    /// Made by the page (128 random bits, hexadecimal), so that a repeated request starts one session.
    pub nonce: String,
    /// Recruitment parameters of the address (`PROLIFIC_PID`...), stored apart.
    #[serde(default)]
    pub recruitment: BTreeMap<String, String>,
    /// Condition that the address names (`?condition=`); the server gives one if it names none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub condition: Option<String>,
    /// Language of the pages.
    pub language: String,
    /// Browser name, its major version, platform class: nothing finer.
    #[serde(default)]
    pub client: BTreeMap<String, String>,
    /// Whether the participant does not take part: has declined, or has a device that cannot. Such a session
    /// is counted, holds no place, uses no identifier, and has no completion code.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub turned_away: bool,
}

/// The server's answer to [`StartSession`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SessionStarted {
    /// Secret token of the session, 128 bits, hexadecimal.
    pub session: String,
    /// Public participant identifier of the export, e.g. `p0007`.
    pub participant_id: String,
    /// Participant number, never given twice within a study.
    pub participant: u64,
    /// Place in the balance of conditions: decides the order. Who drops out gives it back, so that
    /// the next participant takes it. 0 in sessions of before there were slots: see [`Self::slot`].
    #[serde(default)]
    pub slot: u64,
    /// The participant's condition, for good; none in a study without conditions. Each condition has
    /// slots of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub condition: Option<String>,
    /// Seed of the study's random streams.
    pub seed: u64,
    /// `pilot` or `live`.
    pub stage: String,
    /// SHA-256 of the canonical study file, hexadecimal.
    pub config_hash: String,
    /// Code with which the participant can have the answers deleted.
    pub withdrawal_code: String,
}

impl SessionStarted {
    /// The place in the balance; the participant's number where none was given.
    pub fn slot(&self) -> u64 {
        if self.slot == 0 { self.participant } else { self.slot }
    }
}

/// One thing that happened, numbered from 0 without gaps by the page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Event {
    /// 0, 1, 2... within the session.
    pub sequence: u64,
    /// The page's clock, milliseconds since 1970.
    pub at_ms: f64,
    /// What happened ([`crate::EventKind`], tagged by `type`).
    pub body: Value,
}

/// Events to append.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AppendEvents {
    /// In ascending order of sequence.
    pub events: Vec<Event>,
}

/// Sent only after the events are committed to disk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Acknowledged {
    /// Number of events stored without a gap: every sequence below it is on disk.
    pub stored: u64,
    /// Sequences below the highest stored one that are missing.
    pub gaps: Vec<u64>,
}

/// What a page needs to go on after a reload.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resume {
    /// As at the start.
    pub started: SessionStarted,
    /// Every event stored, by sequence.
    pub events: Vec<Event>,
}

/// The page says that it is at the end and has sent everything.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Complete {
    /// How many events the page has sent.
    pub events: u64,
}

/// The server has everything: only now is the completion code shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Receipt {
    /// Keyed hash over the stored events, hexadecimal.
    pub receipt: String,
    /// How many events are stored.
    pub stored: u64,
    /// Completion code of the recruitment, if the study has one.
    pub completion_code: Option<String>,
    /// Address to return to, if the study has one.
    pub redirect: Option<String>,
}

/// A participant withdraws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Withdraw {
    /// The code given at the start.
    pub withdrawal_code: String,
}

/// The answers are deleted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Withdrawn {
    /// How many events were deleted.
    pub deleted: u64,
}

/// A panic of a page's module, without the values that its message holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PanicReport {
    /// Module: `app`, `solver`, `stage`, `studio`.
    pub module: String,
    /// Graphics interface of the canvas module: `webgpu` or `webgl2`; empty for the others.
    pub backend: String,
    /// Message; its values are left out by the page.
    pub message: String,
    /// Source file, line and column.
    pub place: String,
    /// Identifier of the study; empty on pages of no study.
    pub study: String,
}

/// A refused request.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Refusal {
    /// Stable word, e.g. `unknown-session`, `study-closed`, `already-took-part`, `bad-request`.
    pub code: String,
    /// What is wrong, for a person.
    pub message: String,
    /// What to do about it.
    pub remedy: String,
    /// Sequences concerned: those that are missing (`missing-events`) or that another event holds
    /// (`event-conflict`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sequences: Vec<u64>,
}
