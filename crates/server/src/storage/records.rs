//! The rows that storage takes and gives.

use std::collections::BTreeMap;

use mimique_study::wire::Acknowledged;

/// Where a session stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Begun, not ended.
    Started,
    /// The page said that it is at the end and every event is stored.
    Completed,
    /// The answers are deleted.
    Withdrawn,
}

impl Status {
    /// The word kept in the database and written to exports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Started => "started",
            Self::Completed => "completed",
            Self::Withdrawn => "withdrawn",
        }
    }

    /// The status with this word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Started, Self::Completed, Self::Withdrawn].into_iter().find(|s| s.word() == word)
    }
}

/// A version of a study as served.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyVersion {
    /// Identifier used in addresses.
    pub study_id: String,
    /// SHA-256 of the canonical study file, hexadecimal.
    pub config_hash: String,
    /// The study file, JSON text.
    pub file: String,
    /// Its clips and their packs (`wire::Bundle::clips`), JSON text.
    pub clips: String,
}

/// A session to start.
#[derive(Debug, Clone)]
pub struct NewSession {
    /// SHA-256 of the token, hexadecimal.
    pub token_hash: String,
    /// SHA-256 of the withdrawal code, hexadecimal.
    pub withdrawal_hash: String,
    /// The study.
    pub study_id: String,
    /// Its version.
    pub config_hash: String,
    /// Seed of its random streams.
    pub seed: u64,
    /// `pilot` or `live`.
    pub stage: String,
    /// Language of the pages.
    pub language: String,
    /// Browser, its major version, platform class; JSON text.
    pub client: String,
    /// Recruitment identifiers, kept apart.
    pub recruitment: BTreeMap<String, String>,
    /// The server's clock.
    pub now_ms: i64,
}

/// A stored session.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionRecord {
    /// Key inside the database.
    pub key: i64,
    /// The study.
    pub study_id: String,
    /// Participant number within the study.
    pub participant: u64,
    /// Version of the study.
    pub config_hash: String,
    /// Seed of the study's random streams.
    pub seed: u64,
    /// `pilot` or `live`.
    pub stage: String,
    /// Language of the pages.
    pub language: String,
    /// Browser, its major version, platform class; JSON text.
    pub client: String,
    /// SHA-256 of the withdrawal code, hexadecimal.
    pub withdrawal_hash: String,
    /// Where it stands.
    pub status: Status,
    /// When it started, milliseconds since 1970 by the server's clock.
    pub started_ms: i64,
    /// When its last new event came.
    pub last_event_ms: Option<i64>,
    /// When it was completed or withdrawn.
    pub ended_ms: Option<i64>,
    /// How many events are stored.
    pub event_count: u64,
    /// One more than the highest stored sequence.
    pub next_sequence: u64,
    /// Its receipt and how many events that covers, when completed.
    pub receipt: Option<(String, u64)>,
}

/// What an append did.
#[derive(Debug, Clone, PartialEq)]
pub struct Appended {
    /// What is stored now.
    pub acknowledged: Acknowledged,
    /// Sequences for which another body was already stored; the new one is kept apart.
    pub conflicts: Vec<u64>,
}

/// What completing did.
#[derive(Debug, Clone, PartialEq)]
pub struct Completed {
    /// Key of the session inside the database.
    pub key: i64,
    /// The study, for its completion code.
    pub study_id: String,
    /// Keyed hash over the stored events, hexadecimal.
    pub receipt: String,
    /// How many events it covers.
    pub stored: u64,
}

/// One recruitment identifier.
#[derive(Debug, Clone, PartialEq)]
pub struct RecruitmentEntry {
    /// Participant number.
    pub participant: u64,
    /// Name of the parameter, e.g. `PROLIFIC_PID`.
    pub name: String,
    /// Its value.
    pub value: String,
}
