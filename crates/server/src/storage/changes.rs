//! What a change does inside the writer's transaction. A change that is refused has written nothing.

use mimique_study::wire::{Acknowledged, Event};
use sqlx::{AssertSqlSafe, Row};

use super::super::super::records::{Appended, Completed, NewSession, SessionRecord, Status};
use super::super::super::{MOST_SEQUENCES_REPORTED, StorageError};
use super::super::{Connection, FOR_UPDATE};
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
    Started(SessionRecord),
    Appended(Appended),
    Completed(Completed),
    Withdrawn { deleted: u64 },
}

pub(super) async fn apply(
    connection: &mut Connection,
    change: &Change,
) -> Result<Outcome, StorageError> {
    match change {
        Change::Start(session) => start(connection, session).await.map(Outcome::Started),
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

async fn start(
    connection: &mut Connection,
    session: &NewSession,
) -> Result<SessionRecord, StorageError> {
    if let Some(record) = find_session(connection, &session.token_hash).await? {
        return Ok(record);
    }
    let number = sqlx::query(
        "UPDATE studies SET next_participant = next_participant + 1 WHERE study_id = $1 \
         RETURNING next_participant - 1 AS participant",
    )
    .bind(&session.study_id)
    .fetch_one(&mut *connection)
    .await?;
    let participant: i64 = number.try_get("participant")?;
    let row = sqlx::query(
        "INSERT INTO sessions (token_hash, study_id, participant, config_hash, seed, stage, \
         language, client, withdrawal_hash, status, started_ms, event_count, next_sequence) \
         VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, 'started', $10, 0, 0) RETURNING session_key",
    )
    .bind(&session.token_hash)
    .bind(&session.study_id)
    .bind(participant)
    .bind(&session.config_hash)
    .bind(session.seed.cast_signed())
    .bind(&session.stage)
    .bind(&session.language)
    .bind(&session.client)
    .bind(&session.withdrawal_hash)
    .bind(session.now_ms)
    .fetch_one(&mut *connection)
    .await?;
    let key: i64 = row.try_get("session_key")?;
    for (name, value) in &session.recruitment {
        sqlx::query("INSERT INTO recruitment (session_key, name, value) VALUES ($1, $2, $3)")
            .bind(key)
            .bind(name)
            .bind(value)
            .execute(&mut *connection)
            .await?;
    }
    Ok(SessionRecord {
        key,
        study_id: session.study_id.clone(),
        participant: unsigned("sessions", participant)?,
        config_hash: session.config_hash.clone(),
        seed: session.seed,
        stage: session.stage.clone(),
        language: session.language.clone(),
        client: session.client.clone(),
        withdrawal_hash: session.withdrawal_hash.clone(),
        status: Status::Started,
        started_ms: session.now_ms,
        last_event_ms: None,
        ended_ms: None,
        event_count: 0,
        next_sequence: 0,
        receipt: None,
    })
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
            "UPDATE sessions SET event_count = $1, next_sequence = $2, last_event_ms = $3 \
             WHERE session_key = $4",
        )
        .bind(signed(event_count))
        .bind(signed(next_sequence))
        .bind(now_ms)
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
    for row in &rows {
        let body: String = row.try_get("body")?;
        let sequence = unsigned("events", row.try_get("sequence")?)?;
        hasher.add(sequence, row.try_get("at_ms")?, &body);
    }
    let receipt = hasher.finish();
    sqlx::query(
        "UPDATE sessions SET status = 'completed', ended_ms = $1, receipt = $2, \
         receipt_events = $3 WHERE session_key = $4",
    )
    .bind(now_ms)
    .bind(&receipt)
    .bind(signed(events))
    .bind(session.key)
    .execute(connection)
    .await?;
    Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored: events })
}

async fn withdraw(
    connection: &mut Connection,
    token_hash: &str,
    withdrawal_hash: &str,
    now_ms: i64,
) -> Result<u64, StorageError> {
    let session =
        find_session(connection, token_hash).await?.ok_or(StorageError::UnknownSession)?;
    if !secret::same(&session.withdrawal_hash, withdrawal_hash) {
        return Err(StorageError::WrongWithdrawalCode);
    }
    let deleted = sqlx::query("DELETE FROM events WHERE session_key = $1")
        .bind(session.key)
        .execute(&mut *connection)
        .await?
        .rows_affected();
    for statement in [
        "DELETE FROM event_conflicts WHERE session_key = $1",
        "DELETE FROM recruitment WHERE session_key = $1",
    ] {
        sqlx::query(statement).bind(session.key).execute(&mut *connection).await?;
    }
    if session.status != Status::Withdrawn {
        sqlx::query(
            "UPDATE sessions SET status = 'withdrawn', ended_ms = $1, client = '{}', \
             event_count = 0, next_sequence = 0, last_event_ms = NULL, receipt = NULL, \
             receipt_events = NULL WHERE session_key = $2",
        )
        .bind(now_ms)
        .bind(session.key)
        .execute(connection)
        .await?;
    }
    Ok(deleted)
}

/// The session, locked until the transaction ends.
async fn find_session(
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
        Some(session) if session.status == Status::Withdrawn => Err(StorageError::Withdrawn),
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
