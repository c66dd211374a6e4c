//! The start of a session: its participant number, its condition, its slot, and who cannot begin.
//!
//! The study's row is locked first, so that numbers, conditions, slots, places and marks are given to
//! one participant after the other, on one server or several.

use std::collections::BTreeMap;

use mimique_study::{Draw, drawn_condition};
use sqlx::{AssertSqlSafe, Row};

use super::super::super::StorageError;
use super::super::super::records::{NewSession, SessionRecord, Status};
use super::super::{Connection, FOR_UPDATE};
use super::changes::find_session;
use super::unsigned;

/// Starts a session, or finds the one with its token.
pub(super) async fn start(
    connection: &mut Connection,
    session: &NewSession,
) -> Result<SessionRecord, StorageError> {
    if let Some(record) = find_session(connection, &session.token_hash).await? {
        return Ok(record);
    }
    let study = sqlx::query(AssertSqlSafe(format!(
        "SELECT next_participant FROM studies WHERE study_id = $1{FOR_UPDATE}"
    )))
    .bind(&session.study_id)
    .fetch_one(&mut *connection)
    .await?;
    // The same request may have been answered by another server while this one waited.
    if let Some(record) = find_session(connection, &session.token_hash).await? {
        return Ok(record);
    }
    let participant: i64 = study.try_get("next_participant")?;
    refuse_repeats(connection, session).await?;
    refuse_beyond_places(connection, session).await?;
    let condition =
        choose_condition(connection, session, unsigned("studies", participant)?).await?;
    let slot = take_slot(connection, session, condition).await?;
    sqlx::query("UPDATE studies SET next_participant = $1 WHERE study_id = $2")
        .bind(participant + 1)
        .bind(&session.study_id)
        .execute(&mut *connection)
        .await?;
    let expires_ms = session.now_ms + session.reservation_ms;
    let row = sqlx::query(
        "INSERT INTO sessions (token_hash, study_id, participant, config_hash, seed, stage, \
         language, client, withdrawal_hash, status, started_ms, event_count, next_sequence, \
         slot, slot_expires_ms, slot_lasts_ms, assigned_condition) \
         VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, 'started', $10, 0, 0, $11, $12, $13, $14) \
         RETURNING session_key",
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
    .bind(slot)
    .bind(expires_ms)
    .bind(session.reservation_ms)
    .bind(condition)
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
    for mark in &session.marks {
        sqlx::query(
            "INSERT INTO repeat_marks (study_id, stage, mark, session_key) VALUES ($1, $2, $3, $4)",
        )
        .bind(&session.study_id)
        .bind(&session.stage)
        .bind(mark)
        .bind(key)
        .execute(&mut *connection)
        .await?;
    }
    Ok(SessionRecord {
        key,
        study_id: session.study_id.clone(),
        participant: unsigned("sessions", participant)?,
        slot: unsigned("sessions", slot)?,
        condition: Some(condition.to_owned()).filter(|name| !name.is_empty()),
        slot_expires_ms: Some(expires_ms),
        slot_lasts_ms: session.reservation_ms,
        finished: false,
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

async fn refuse_repeats(
    connection: &mut Connection,
    session: &NewSession,
) -> Result<(), StorageError> {
    for mark in &session.marks {
        let known = sqlx::query(
            "SELECT 1 FROM repeat_marks WHERE study_id = $1 AND stage = $2 AND mark = $3",
        )
        .bind(&session.study_id)
        .bind(&session.stage)
        .bind(mark)
        .fetch_optional(&mut *connection)
        .await?;
        if known.is_some() {
            return Err(StorageError::AlreadyTookPart);
        }
    }
    Ok(())
}

/// Those who have finished and those who are on their way count, over all versions of the study.
async fn refuse_beyond_places(
    connection: &mut Connection,
    session: &NewSession,
) -> Result<(), StorageError> {
    let Some(places) = session.places else { return Ok(()) };
    let row = sqlx::query(
        "SELECT COUNT(*) AS taken FROM sessions WHERE study_id = $1 AND stage = $2 \
         AND (finished = 1 OR slot_expires_ms > $3)",
    )
    .bind(&session.study_id)
    .bind(&session.stage)
    .bind(session.now_ms)
    .fetch_one(connection)
    .await?;
    let taken = unsigned("sessions", row.try_get("taken")?)?;
    if taken < places { Ok(()) } else { Err(StorageError::StudyFull) }
}

/// The condition in which the fewest have finished or are on their way; drawn where several have as
/// few. Empty in a study without conditions.
async fn choose_condition<'s>(
    connection: &mut Connection,
    session: &'s NewSession,
    participant: u64,
) -> Result<&'s str, StorageError> {
    let names: Vec<&str> = session.conditions.iter().map(String::as_str).collect();
    if let [] | [_] = names[..] {
        return Ok(names.first().copied().unwrap_or_default());
    }
    let rows = sqlx::query(
        "SELECT assigned_condition, COUNT(*) AS taken FROM sessions WHERE study_id = $1 \
         AND config_hash = $2 AND stage = $3 AND (finished = 1 OR slot_expires_ms > $4) \
         GROUP BY assigned_condition",
    )
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(session.now_ms)
    .fetch_all(connection)
    .await?;
    let mut taken: BTreeMap<String, i64> = BTreeMap::new();
    for row in &rows {
        taken.insert(row.try_get("assigned_condition")?, row.try_get("taken")?);
    }
    let count = |name: &&str| taken.get(*name).copied().unwrap_or(0);
    let fewest = names.iter().map(count).min();
    let names: Vec<&str> =
        names.iter().filter(|name| Some(count(name)) == fewest).copied().collect();
    let draw = Draw {
        seed: session.seed,
        config_hash: &session.config_hash,
        participant,
        condition: None,
    };
    Ok(drawn_condition(draw, &names).unwrap_or_default())
}

/// The condition's lowest slot that was given back or whose reservation has run out, else its next
/// new one.
async fn take_slot(
    connection: &mut Connection,
    session: &NewSession,
    condition: &str,
) -> Result<i64, StorageError> {
    let free = sqlx::query(
        "SELECT session_key, slot FROM sessions WHERE study_id = $1 AND config_hash = $2 \
         AND stage = $3 AND assigned_condition = $4 AND slot_expires_ms <= $5 \
         ORDER BY slot LIMIT 1",
    )
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(condition)
    .bind(session.now_ms)
    .fetch_optional(&mut *connection)
    .await?;
    if let Some(free) = free {
        let key: i64 = free.try_get("session_key")?;
        sqlx::query(
            "UPDATE sessions SET slot_expires_ms = NULL, slot_given = 1 WHERE session_key = $1",
        )
        .bind(key)
        .execute(connection)
        .await?;
        return Ok(free.try_get("slot")?);
    }
    let row = sqlx::query(
        "SELECT COALESCE(MAX(slot), 0) + 1 AS slot FROM sessions WHERE study_id = $1 \
         AND config_hash = $2 AND stage = $3 AND assigned_condition = $4",
    )
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(condition)
    .fetch_one(connection)
    .await?;
    Ok(row.try_get("slot")?)
}
