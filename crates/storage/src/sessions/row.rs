//! A session's row.

use futures_util::stream::{Stream, StreamExt as _};
use mimique_session::wire::Event;
use mimique_session::{EventKind, Record, Standing};
use serde::de::IgnoredAny;

use crate::database::{Row, unsigned};
use crate::error::StorageError;
use crate::records::{CountedEvent, SessionRecord};

/// Columns of a session, in the order in which [`session_record`] names them.
pub(super) const SESSION_COLUMNS: &str = "session_key, study_id, participant, config_hash, seed, stage, \
     language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, \
     event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, \
     deleted_ms, assigned_condition, first_gap, stored_bytes";

/// When the next sign of life is due: [`SessionRecord::sign_of_life_due_ms`], as SQL. The 60,000 milliseconds
/// are [`crate::FIRST_SIGN_OF_LIFE_MS`].
pub(super) const DUE_MS: &str = "CASE WHEN last_event_ms IS NOT NULL THEN last_event_ms + slot_lasts_ms \
     WHEN slot_lasts_ms < 60000 THEN started_ms + slot_lasts_ms ELSE started_ms + 60000 END";

/// A session as its row says.
pub(super) fn session_record(row: &Row) -> Result<SessionRecord, StorageError> {
    const TABLE: &str = "sessions";
    let status: String = row.get("status")?;
    let receipt: Option<String> = row.get("receipt")?;
    let receipt_events: Option<i64> = row.get("receipt_events")?;
    Ok(SessionRecord {
        key: row.get("session_key")?,
        study_id: row.get("study_id")?,
        participant: row.unsigned(TABLE, "participant")?,
        slot: row.unsigned(TABLE, "slot")?,
        condition: Some(row.get("assigned_condition")?).filter(|name: &String| !name.is_empty()),
        slot_expires_ms: row.get("slot_expires_ms")?,
        slot_lasts_ms: row.get("slot_lasts_ms")?,
        config_hash: row.get("config_hash")?,
        // The 64 bits of the seed, kept in a signed column.
        seed: row.get::<i64>("seed")?.cast_unsigned(),
        stage: row.get("stage")?,
        language: row.get("language")?,
        client: row.get("client")?,
        withdrawal_hash: row.get("withdrawal_hash")?,
        standing: standing(&status)?,
        started_ms: row.get("started_ms")?,
        last_event_ms: row.get("last_event_ms")?,
        ended_ms: row.get("ended_ms")?,
        deleted_ms: row.get("deleted_ms")?,
        event_count: row.unsigned(TABLE, "event_count")?,
        next_sequence: row.unsigned(TABLE, "next_sequence")?,
        first_gap: row.unsigned(TABLE, "first_gap")?,
        stored_bytes: row.unsigned(TABLE, "stored_bytes")?,
        receipt: match (receipt, receipt_events) {
            (Some(receipt), Some(events)) => Some((receipt, unsigned(TABLE, events)?)),
            _ => None,
        },
    })
}

/// How a session stands, by the word that is stored.
pub(super) fn standing(word: &str) -> Result<Standing, StorageError> {
    Standing::from_stored_word(word).ok_or_else(|| StorageError::Damaged {
        table: "sessions",
        problem: format!("status {word}"),
    })
}

/// The events of a session that count, by sequence: neither those that cannot be one of it, nor those
/// that came after its receipt, which does not cover them.
pub(super) const COUNTED_EVENTS: &str = "SELECT e.sequence, e.at_ms, e.body FROM events e \
     JOIN sessions s ON s.session_key = e.session_key WHERE e.session_key = $1 \
     AND e.misfit IS NULL AND (s.receipt_events IS NULL OR e.sequence < s.receipt_events) \
     AND e.sequence < $2 ORDER BY e.sequence";

/// The same without the logs of plays, which are most of what a session has.
pub(super) const COUNTED_WITHOUT_PLAYS: &str = "SELECT e.sequence, e.at_ms, e.body FROM events e \
     JOIN sessions s ON s.session_key = e.session_key WHERE e.session_key = $1 \
     AND e.misfit IS NULL AND (s.receipt_events IS NULL OR e.sequence < s.receipt_events) \
     AND e.sequence < $2 AND e.body NOT LIKE '%\"type\":\"trial_played\"}' ORDER BY e.sequence";

/// An event of a session as its row says.
pub(super) fn event(session_key: i64, row: &Row) -> Result<Event, StorageError> {
    let body: String = row.get("body")?;
    Ok(Event {
        sequence: row.unsigned("events", "sequence")?,
        at_ms: row.get("at_ms")?,
        body: serde_json::from_str(&body).map_err(|problem| damaged(session_key, problem))?,
    })
}

/// An event that counts as its row says.
pub(super) fn counted_event(session_key: i64, row: &Row) -> Result<CountedEvent, StorageError> {
    let body: String = row.get("body")?;
    let kind = EventKind::from_text(&body);
    if kind.is_none() {
        check_json(session_key, &body)?;
    }
    let sequence = row.unsigned("events", "sequence")?;
    Ok(CountedEvent { sequence, at_ms: row.get("at_ms")?, kind })
}

/// Makes the record of a session's events as they come: one of them is in memory.
pub(super) async fn record_of(
    events: impl Stream<Item = Result<CountedEvent, StorageError>>,
) -> Result<Record, StorageError> {
    let mut record = Record::default();
    let mut events = std::pin::pin!(events);
    while let Some(event) = events.next().await {
        let CountedEvent { sequence, at_ms, kind } = event?;
        record.add(None, sequence, at_ms, kind);
    }
    Ok(record)
}

/// What is stored is JSON, or it is damaged.
pub(super) fn check_json(session_key: i64, body: &str) -> Result<(), StorageError> {
    let read: Result<IgnoredAny, _> = serde_json::from_str(body);
    read.map(drop).map_err(|problem| damaged(session_key, problem))
}

fn damaged(session_key: i64, problem: serde_json::Error) -> StorageError {
    StorageError::Damaged {
        table: "events",
        problem: format!("session key {session_key}: {problem}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::FIRST_SIGN_OF_LIFE_MS;

    #[test]
    fn the_statement_has_the_time_of_the_first_sign_of_life() {
        assert_eq!(DUE_MS.matches(&FIRST_SIGN_OF_LIFE_MS.to_string()).count(), 2, "{DUE_MS}");
    }
}
