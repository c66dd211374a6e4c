//! The rows that storage takes and gives.

use std::collections::BTreeMap;

use mimique_session::wire::{Acknowledged, Event};
use mimique_session::{EventKind, Misfit, Standing};

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
    /// What was measured of its clips, a JSON list; `[]` where nothing was.
    pub measures: String,
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
    /// Keyed hashes of what tells a second participation of one person; none where the study does
    /// not ask.
    pub marks: Vec<String>,
    /// The conditions between which the participant is put; none in a study without.
    pub conditions: Vec<String>,
    /// How many participants the study takes.
    pub places: Option<u64>,
    /// How long the place in the balance is kept after the last sign of life, milliseconds.
    pub reservation_ms: i64,
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
    /// Place in the balance of conditions, from 1 in each version, stage and condition between
    /// participants.
    pub slot: u64,
    /// The participant's condition, for good; none in a study without.
    pub condition: Option<String>,
    /// Until when the place is kept unless a sign of life comes; none when it is kept for good or
    /// somebody else has it.
    pub slot_expires_ms: Option<i64>,
    /// How long it is kept after each sign of life.
    pub slot_lasts_ms: i64,
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
    /// How it stands by its events, whatever the time is.
    pub standing: Standing,
    /// When it started, milliseconds since 1970 by the server's clock.
    pub started_ms: i64,
    /// When its last new event came.
    pub last_event_ms: Option<i64>,
    /// When it got its receipt, or its answers were deleted.
    pub ended_ms: Option<i64>,
    /// When its answers were deleted: at the participant's wish if it stands withdrawn, else since their
    /// time was over.
    pub deleted_ms: Option<i64>,
    /// How many events are stored.
    pub event_count: u64,
    /// One more than the highest stored sequence.
    pub next_sequence: u64,
    /// The lowest sequence that is not stored.
    pub first_gap: u64,
    /// Bytes of the events' bodies that are kept.
    pub stored_bytes: u64,
    /// Its receipt and how many events that covers, when completed.
    pub receipt: Option<(String, u64)>,
}

/// Who has begun shows at once that a page is there, by its first events: until it has, a place is held for
/// so long and no longer, milliseconds.
pub const FIRST_SIGN_OF_LIFE_MS: i64 = 60_000;

impl SessionRecord {
    /// What its sums are to be made of.
    pub fn counted(&self) -> CountedSo {
        let receipt_events = self.receipt.as_ref().map(|(_, events)| *events);
        CountedSo { event_count: self.event_count, receipt_events }
    }

    /// Whether the answers are gone and nothing more is taken.
    pub fn is_deleted(&self) -> bool {
        self.deleted_ms.is_some()
    }

    /// When the next sign of life is due at the latest, milliseconds since 1970: after that the session
    /// is abandoned.
    pub fn sign_of_life_due_ms(&self) -> i64 {
        match self.last_event_ms {
            Some(last) => last.saturating_add(self.slot_lasts_ms),
            None => self.started_ms.saturating_add(self.slot_lasts_ms.min(FIRST_SIGN_OF_LIFE_MS)),
        }
    }
}

/// An event of a session that counts.
#[derive(Debug, Clone, PartialEq)]
pub struct CountedEvent {
    /// Its place in the session, from 0.
    pub sequence: u64,
    /// When it happened, milliseconds of the page's clock.
    pub at_ms: f64,
    /// What happened; none where this version cannot read it.
    pub kind: Option<EventKind>,
}

/// What a session's sums are made of: they are current as long as this is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CountedSo {
    /// How many events were stored.
    pub event_count: u64,
    /// How many of them the receipt covers.
    pub receipt_events: Option<u64>,
}

/// Of a session what a list of many needs.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionState {
    /// Key inside the database.
    pub key: i64,
    /// Participant number within the study.
    pub participant: u64,
    /// Version of the study.
    pub config_hash: String,
    /// `pilot` or `live`.
    pub stage: String,
    /// The participant's condition; none in a study without.
    pub condition: Option<String>,
    /// How it stands by its events, whatever the time is.
    pub standing: Standing,
    /// Whether its answers are gone.
    pub is_deleted: bool,
    /// When it got its receipt, or its answers were deleted; milliseconds since 1970.
    pub ended_ms: Option<i64>,
    /// When the next sign of life is due at the latest, milliseconds since 1970.
    pub sign_of_life_due_ms: i64,
    /// What its sums are to be made of.
    pub counted: CountedSo,
    /// What the sums that are kept of it were made of; none where none are, of the form asked for.
    pub summed: Option<CountedSo>,
}

/// The sums of a session as they are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptSums {
    /// Key of the session inside the database.
    pub session_key: i64,
    /// What they were made of.
    pub counted: CountedSo,
    /// JSON, of a form that storage does not know.
    pub sums: String,
}

/// An event as it is stored.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenEvent {
    /// Its place in the session, from 0.
    pub sequence: u64,
    /// When it happened, milliseconds of the page's clock.
    pub at_ms: f64,
    /// JSON, keys in alphabetical order: the receipt is over this text.
    pub body: String,
    /// Whether it can end the session.
    pub may_end: bool,
    /// Why it cannot be one of the session's, if it cannot: it is kept and counts for nothing.
    pub misfit: Option<Misfit>,
}

impl WrittenEvent {
    /// The same as one that was found to be so.
    #[must_use]
    pub fn found(self, misfit: Option<Misfit>) -> Self {
        Self { may_end: self.may_end && misfit.is_none(), misfit, ..self }
    }
}

/// An event as it lies in the database.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredEvent {
    /// Its place in the session, from 0.
    pub sequence: u64,
    /// When it happened, milliseconds of the page's clock.
    pub at_ms: f64,
    /// JSON as it was stored.
    pub body: String,
    /// The word for why it cannot be one of the session's (`Misfit::word`).
    pub misfit: Option<String>,
}

impl From<Event> for WrittenEvent {
    fn from(event: Event) -> Self {
        Self {
            sequence: event.sequence,
            at_ms: event.at_ms,
            body: event.body.to_string(),
            may_end: EventKind::may_end(&event.body),
            misfit: None,
        }
    }
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

/// How a study's version came to be served.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Registered {
    /// Number of the version within the study, from 1 in order of first service.
    pub version: u64,
    /// Hash of the version that this one replaces.
    pub replaces: Option<String>,
    /// Live sessions that began under other versions and have not ended.
    pub running_elsewhere: u64,
    /// The file is as it was, but the stimuli that it names are not.
    pub stimuli_changed: bool,
}

/// A session whose answers or identifiers were deleted: what a backup must not bring back.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Deletion {
    /// SHA-256 of the session's token, hexadecimal.
    pub token_hash: String,
    /// `withdrawn`, `erased` or `identifiers`.
    pub what: String,
    /// When, milliseconds since 1970.
    pub at_ms: i64,
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

/// Sessions whose answers are over their time and not deleted yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overdue {
    /// How many.
    pub sessions: u64,
    /// When the first of them was marked, milliseconds since 1970.
    pub first_marked_ms: i64,
}

/// What a database knows of the time, milliseconds since 1970: the witnesses against a wrong clock.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TimesSeen {
    /// The newest start, event or end of a session.
    pub newest_ms: Option<i64>,
    /// The latest time of the server's clock that was believed.
    pub believed_ms: Option<i64>,
    /// The newest event that an owner has said not to go by.
    pub passed_over_ms: Option<i64>,
}

/// A participant whose answers are deleted at their own wish.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Withdrawal {
    /// The study.
    pub study_id: String,
    /// Participant number within it.
    pub participant: u64,
    /// How many events were deleted now; none where they were gone already.
    pub deleted: u64,
}

/// The public name of a participant: `p0007`.
pub fn participant_id(number: u64) -> String {
    format!("p{number:04}")
}

/// Tables with rows of a session (`session_key`) that are deleted with its answers.
pub(crate) const PERSONAL_TABLES: [&str; 6] =
    ["events", "event_conflicts", "recruitment", "repeat_marks", "exclusions", "session_sums"];
