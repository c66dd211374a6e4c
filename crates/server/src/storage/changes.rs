//! What a change does inside the writer's transaction. A change that is refused has written nothing.
//! Starting is in `enrol.rs`, deleting in `erase.rs`.

use mimique_study::wire::{Acknowledged, Event};
use sqlx::{AssertSqlSafe, Row};

use super::super::super::records::{Appended, Completed, NewSession, SessionRecord};
use super::super::super::{MOST_SEQUENCES_REPORTED, StorageError};
use super::super::{Connection, FOR_UPDATE};
use super::enrol::start;
use super::erase::withdraw;
use super::{SESSION_COLUMNS, session_record, signed, unsigned};
use crate::receipt::ReceiptHasher;
use crate::secret;

/// A change to make.
pub(super) enum Change {
    Start(NewSession),
    Append { token_hash: String, events: Vec<Event>, now_ms: i64 },
    Complete { token_hash: String, events: u64, receipt_key: Vec<u8>, now_ms: i64 },
    Withdraw { token_hash: String, withdrawal_hash: String, now_ms: i64 },
}

/// What a change did.
pub(super) enum Outcome {
    Started(Box<SessionRecord>),
    Appended(Appended),
    Completed(Completed),
    Withdrawn { deleted: u64 },
}

pub(super) async fn apply(
    connection: &mut Connection,
    change: &Change,
) -> Result<Outcome, StorageError> {
    match change {
        Change::Start(session) => {
            start(connection, session).await.map(Box::new).map(Outcome::Started)
        }
        Change::Append { token_hash, events, now_ms } => {
            append(connection, token_hash, events, *now_ms).await.map(Outcome::Appended)
        }
        Change::Complete { token_hash, events, receipt_key, now_ms } => {
            complete(connection, token_hash, *events, receipt_key, *now_ms)
                .await
                .map(Outcome::Completed)
        }
        Change::Withdraw { token_hash, withdrawal_hash, now_ms } => {
            let deleted = withdraw(connection, token_hash, withdrawal_hash, *now_ms).await?;
            Ok(Outcome::Withdrawn { deleted })
        }
    }
}

async fn append(
    connection: &mut Connection,
    token_hash: &str,
    events: &[Event],
    now_ms: i64,
) -> Result<Appended, StorageError> {
    let session = open_session(connection, token_hash).await?;
    let mut added = 0;
    let mut next_sequence = session.next_sequence;
    let mut conflicts = Vec::new();
    for event in events {
        let body = event.body.to_string();
        let inserted = sqlx::query(
            "INSERT INTO events (session_key, sequence, at_ms, received_ms, body) \
             VALUES ($1, $2, $3, $4, $5) ON CONFLICT (session_key, sequence) DO NOTHING",
        )
        .bind(session.key)
        .bind(signed(event.sequence))
        .bind(event.at_ms)
        .bind(now_ms)
        .bind(&body)
        .execute(&mut *connection)
        .await?;
        if inserted.rows_affected() == 1 {
            added += 1;
            next_sequence = next_sequence.max(event.sequence + 1);
        } else if !is_stored(connection, session.key, event, &body).await? {
            keep_apart(connection, session.key, event, &body, now_ms).await?;
            conflicts.push(event.sequence);
        }
    }
    let event_count = session.event_count + added;
    if added > 0 {
        sqlx::query(
            "UPDATE sessions SET event_count = $1, next_sequence = $2, last_event_ms = $3, \
             slot_expires_ms = COALESCE($4, slot_expires_ms) WHERE session_key = $5",
        )
        .bind(signed(event_count))
        .bind(signed(next_sequence))
        .bind(now_ms)
        .bind(renewed(&session, now_ms))
        .bind(session.key)
        .execute(&mut *connection)
        .await?;
    }
    let gaps = if event_count == next_sequence {
        Vec::new()
    } else {
        missing_below(connection, session.key, next_sequence).await?
    };
    let stored = gaps.first().copied().unwrap_or(next_sequence);
    Ok(Appended { acknowledged: Acknowledged { stored, gaps }, conflicts })
}

/// The end of the slot's reservation after a sign of life, where it is worth writing: in its second
/// half. A reservation that has run out is not renewed: the slot may be somebody else's already.
fn renewed(session: &SessionRecord, now_ms: i64) -> Option<i64> {
    let left = session.slot_expires_ms?.saturating_sub(now_ms);
    (left > 0 && left < session.slot_lasts_ms / 2).then(|| now_ms + session.slot_lasts_ms)
}

/// Whether exactly this event is what is stored under its sequence.
async fn is_stored(
    connection: &mut Connection,
    session_key: i64,
    event: &Event,
    body: &str,
) -> Result<bool, StorageError> {
    let row =
        sqlx::query("SELECT at_ms, body FROM events WHERE session_key = $1 AND sequence = $2")
            .bind(session_key)
            .bind(signed(event.sequence))
            .fetch_one(connection)
            .await?;
    let stored_at: f64 = row.try_get("at_ms")?;
    let stored_body: String = row.try_get("body")?;
    Ok(stored_at == event.at_ms && stored_body == body)
}

/// Keeps a second body of a stored sequence beside the responses.
async fn keep_apart(
    connection: &mut Connection,
    session_key: i64,
    event: &Event,
    body: &str,
    now_ms: i64,
) -> Result<(), StorageError> {
    sqlx::query(
        "INSERT INTO event_conflicts (session_key, sequence, digest, at_ms, received_ms, body) \
         VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT DO NOTHING",
    )
    .bind(session_key)
    .bind(signed(event.sequence))
    .bind(secret::hash(&format!("{} {body}", event.at_ms)))
    .bind(event.at_ms)
    .bind(now_ms)
    .bind(body)
    .execute(connection)
    .await?;
    Ok(())
}

async fn complete(
    connection: &mut Connection,
    token_hash: &str,
    events: u64,
    receipt_key: &[u8],
    now_ms: i64,
) -> Result<Completed, StorageError> {
    let session = open_session(connection, token_hash).await?;
    if let Some((receipt, stored)) = session.receipt {
        return Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored });
    }
    // An unbroken prefix needs no search; otherwise the gaps and the unseen end are missing.
    let unbroken = session.event_count == session.next_sequence && events <= session.event_count;
    if !unbroken {
        let missing = missing_below(connection, session.key, events).await?;
        if !missing.is_empty() {
            return Err(StorageError::MissingEvents { missing });
        }
    }
    let mut hasher = ReceiptHasher::new(receipt_key, &session.study_id, session.participant);
    let rows = sqlx::query(
        "SELECT sequence, at_ms, body FROM events WHERE session_key = $1 AND sequence < $2 \
         ORDER BY sequence",
    )
    .bind(session.key)
    .bind(signed(events))
    .fetch_all(&mut *connection)
    .await?;
    let mut finished = false;
    for row in &rows {
        let body: String = row.try_get("body")?;
        let sequence = unsigned("events", row.try_get("sequence")?)?;
        finished |= is_the_end(&body);
        hasher.add(sequence, row.try_get("at_ms")?, &body);
    }
    let receipt = hasher.finish();
    sqlx::query(
        "UPDATE sessions SET status = 'completed', ended_ms = $1, receipt = $2, \
         receipt_events = $3, finished = $4, \
         slot_expires_ms = CASE WHEN $4 = 0 AND slot_given = 0 THEN 0 ELSE NULL END \
         WHERE session_key = $5",
    )
    .bind(now_ms)
    .bind(&receipt)
    .bind(signed(events))
    .bind(i64::from(finished))
    .bind(session.key)
    .execute(connection)
    .await?;
    Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored: events })
}

/// Whether this event says that every step is done.
fn is_the_end(body: &str) -> bool {
    #[derive(serde::Deserialize)]
    struct Kind<'a> {
        #[serde(borrow, rename = "type")]
        kind: Option<std::borrow::Cow<'a, str>>,
    }
    body.contains("finished")
        && serde_json::from_str::<Kind<'_>>(body)
            .is_ok_and(|event| event.kind.as_deref() == Some("finished"))
}

/// The session, locked until the transaction ends.
pub(super) async fn find_session(
    connection: &mut Connection,
    token_hash: &str,
) -> Result<Option<SessionRecord>, StorageError> {
    let row = sqlx::query(AssertSqlSafe(format!(
        "SELECT {SESSION_COLUMNS} FROM sessions WHERE token_hash = $1{FOR_UPDATE}"
    )))
    .bind(token_hash)
    .fetch_optional(connection)
    .await?;
    row.as_ref().map(session_record).transpose()
}

/// The session, if it still takes events.
async fn open_session(
    connection: &mut Connection,
    token_hash: &str,
) -> Result<SessionRecord, StorageError> {
    match find_session(connection, token_hash).await? {
        None => Err(StorageError::UnknownSession),
        Some(session) if session.status.is_deleted() => Err(StorageError::Withdrawn),
        Some(session) => Ok(session),
    }
}

/// The sequences in `0..end` that are not stored, at most [`MOST_SEQUENCES_REPORTED`].
async fn missing_below(
    connection: &mut Connection,
    session_key: i64,
    end: u64,
) -> Result<Vec<u64>, StorageError> {
    let rows = sqlx::query(
        "SELECT sequence FROM events WHERE session_key = $1 AND sequence < $2 ORDER BY sequence",
    )
    .bind(session_key)
    .bind(signed(end))
    .fetch_all(connection)
    .await?;
    let mut missing = Vec::new();
    let mut expected = 0;
    for row in &rows {
        let sequence = unsigned("events", row.try_get("sequence")?)?;
        let room = MOST_SEQUENCES_REPORTED - missing.len();
        missing.extend((expected..sequence).take(room));
        expected = sequence + 1;
    }
    let room = MOST_SEQUENCES_REPORTED - missing.len();
    missing.extend((expected..end).take(room));
    Ok(missing)
}
