//! The start of a session: its participant number, its condition, its slot, and who cannot begin.
//!
//! The study's row is locked first, so that numbers, conditions, slots, places and marks are given to
//! one participant after the other, on one server or several.

use std::collections::BTreeMap;

use mimique_session::Standing;
use mimique_study::{Draw, drawn_condition};
use sqlx::AssertSqlSafe;

use super::find::find_session;
use super::row::DUE_MS;
use crate::database::{Transaction, query, unsigned};
use crate::error::StorageError;
use crate::records::{FIRST_SIGN_OF_LIFE_MS, NewSession, SessionRecord};

/// Starts a session, or finds the one with its token.
pub(super) async fn start(
    transaction: &mut Transaction,
    session: &NewSession,
) -> Result<SessionRecord, StorageError> {
    if let Some(record) = find_session(transaction, &session.token_hash).await? {
        return Ok(record);
    }
    let lock = transaction.dialect().row_lock;
    let study = query(AssertSqlSafe(format!(
        "SELECT next_participant FROM studies WHERE study_id = $1{lock}"
    )))
    .bind(&session.study_id)
    .fetch_one(&mut *transaction)
    .await?;
    // The same request may have been answered by another server while this one waited.
    if let Some(record) = find_session(transaction, &session.token_hash).await? {
        return Ok(record);
    }
    let participant: i64 = study.get("next_participant")?;
    refuse_repeats(transaction, session).await?;
    refuse_beyond_places(transaction, session).await?;
    let condition =
        choose_condition(transaction, session, unsigned("studies", participant)?).await?;
    let slot = take_slot(transaction, session, condition).await?;
    query("UPDATE studies SET next_participant = $1 WHERE study_id = $2")
        .bind(participant + 1)
        .bind(&session.study_id)
        .execute(&mut *transaction)
        .await?;
    let expires_ms = session.now_ms + session.reservation_ms.min(FIRST_SIGN_OF_LIFE_MS);
    let place = Place { participant, slot, condition, expires_ms };
    let key = insert(transaction, session, &place).await?;
    insert_recruitment(transaction, session, key).await?;
    fresh(session, &place, key)
}

/// Whether a session could start: refuses as [`start`] does, and writes nothing.
pub(super) async fn may_start(
    transaction: &mut Transaction,
    session: &NewSession,
) -> Result<(), StorageError> {
    // Nothing is locked: a snapshot is for reading alone.
    let known = query("SELECT 1 FROM sessions WHERE token_hash = $1")
        .bind(&session.token_hash)
        .fetch_optional(&mut *transaction)
        .await?;
    if known.is_some() {
        return Ok(());
    }
    refuse_repeats(transaction, session).await?;
    refuse_beyond_places(transaction, session).await
}

/// What a session is given at its start.
struct Place<'s> {
    participant: i64,
    slot: i64,
    /// Empty in a study without conditions.
    condition: &'s str,
    /// When the slot goes to others if nothing is heard.
    expires_ms: i64,
}

/// The row of a session; its key.
async fn insert(
    transaction: &mut Transaction,
    session: &NewSession,
    place: &Place<'_>,
) -> Result<i64, StorageError> {
    let row = query(
        "INSERT INTO sessions (token_hash, study_id, participant, config_hash, seed, stage, \
         language, client, withdrawal_hash, status, started_ms, event_count, next_sequence, \
         slot, slot_expires_ms, slot_lasts_ms, assigned_condition) \
         VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, 'active', $10, 0, 0, $11, $12, $13, $14) \
         RETURNING session_key",
    )
    .bind(&session.token_hash)
    .bind(&session.study_id)
    .bind(place.participant)
    .bind(&session.config_hash)
    .bind(session.seed.cast_signed())
    .bind(&session.stage)
    .bind(&session.language)
    .bind(&session.client)
    .bind(&session.withdrawal_hash)
    .bind(session.now_ms)
    .bind(place.slot)
    .bind(place.expires_ms)
    .bind(session.reservation_ms)
    .bind(place.condition)
    .fetch_one(transaction)
    .await?;
    row.get("session_key")
}

/// The parameters of the recruiter's link, and the marks by which repeats are known.
async fn insert_recruitment(
    transaction: &mut Transaction,
    session: &NewSession,
    key: i64,
) -> Result<(), StorageError> {
    for (name, value) in &session.recruitment {
        query("INSERT INTO recruitment (session_key, name, value) VALUES ($1, $2, $3)")
            .bind(key)
            .bind(name)
            .bind(value)
            .execute(&mut *transaction)
            .await?;
    }
    for mark in &session.marks {
        query(
            "INSERT INTO repeat_marks (study_id, stage, mark, session_key) VALUES ($1, $2, $3, $4)",
        )
        .bind(&session.study_id)
        .bind(&session.stage)
        .bind(mark)
        .bind(key)
        .execute(&mut *transaction)
        .await?;
    }
    Ok(())
}

/// A session without events.
fn fresh(session: &NewSession, place: &Place<'_>, key: i64) -> Result<SessionRecord, StorageError> {
    Ok(SessionRecord {
        key,
        study_id: session.study_id.clone(),
        participant: unsigned("sessions", place.participant)?,
        slot: unsigned("sessions", place.slot)?,
        condition: Some(place.condition.to_owned()).filter(|name| !name.is_empty()),
        slot_expires_ms: Some(place.expires_ms),
        slot_lasts_ms: session.reservation_ms,
        config_hash: session.config_hash.clone(),
        seed: session.seed,
        stage: session.stage.clone(),
        language: session.language.clone(),
        client: session.client.clone(),
        withdrawal_hash: session.withdrawal_hash.clone(),
        standing: Standing::InProgress,
        started_ms: session.now_ms,
        last_event_ms: None,
        ended_ms: None,
        deleted_ms: None,
        event_count: 0,
        next_sequence: 0,
        first_gap: 0,
        stored_bytes: 0,
        receipt: None,
    })
}

/// The sessions that hold a place at a time: [`Standing::holds_place`] of [`Standing::at`], as SQL.
fn holds_place(now_ms: &str) -> String {
    format!(
        "(status = '{}' OR (status = '{}' AND deleted_ms IS NULL \
         AND {DUE_MS} > {now_ms}))",
        Standing::Completed.stored_word(),
        Standing::InProgress.stored_word(),
    )
}

async fn refuse_repeats(
    transaction: &mut Transaction,
    session: &NewSession,
) -> Result<(), StorageError> {
    for mark in &session.marks {
        let known =
            query("SELECT 1 FROM repeat_marks WHERE study_id = $1 AND stage = $2 AND mark = $3")
                .bind(&session.study_id)
                .bind(&session.stage)
                .bind(mark)
                .fetch_optional(&mut *transaction)
                .await?;
        if known.is_some() {
            return Err(StorageError::AlreadyTookPart);
        }
    }
    Ok(())
}

/// Those who have completed and those who are in progress count, over all versions of the study.
async fn refuse_beyond_places(
    transaction: &mut Transaction,
    session: &NewSession,
) -> Result<(), StorageError> {
    let Some(places) = session.places else { return Ok(()) };
    let row = query(AssertSqlSafe(format!(
        "SELECT COUNT(*) AS taken FROM sessions WHERE study_id = $1 AND stage = $2 \
         AND {}",
        holds_place("$3")
    )))
    .bind(&session.study_id)
    .bind(&session.stage)
    .bind(session.now_ms)
    .fetch_one(transaction)
    .await?;
    let taken = row.unsigned("sessions", "taken")?;
    if taken < places { Ok(()) } else { Err(StorageError::StudyFull) }
}

/// The condition in which the fewest have completed or are in progress; drawn where several have as
/// few. Empty in a study without conditions.
async fn choose_condition<'s>(
    transaction: &mut Transaction,
    session: &'s NewSession,
    participant: u64,
) -> Result<&'s str, StorageError> {
    let names: Vec<&str> = session.conditions.iter().map(String::as_str).collect();
    if let [] | [_] = names[..] {
        return Ok(names.first().copied().unwrap_or_default());
    }
    let rows = query(AssertSqlSafe(format!(
        "SELECT assigned_condition, COUNT(*) AS taken FROM sessions WHERE study_id = $1 \
         AND config_hash = $2 AND stage = $3 AND {} GROUP BY assigned_condition",
        holds_place("$4")
    )))
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(session.now_ms)
    .fetch_all(transaction)
    .await?;
    let mut taken: BTreeMap<String, i64> = BTreeMap::new();
    for row in &rows {
        taken.insert(row.get("assigned_condition")?, row.get("taken")?);
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
    transaction: &mut Transaction,
    session: &NewSession,
    condition: &str,
) -> Result<i64, StorageError> {
    let free = query(
        "SELECT session_key, slot FROM sessions WHERE study_id = $1 AND config_hash = $2 \
         AND stage = $3 AND assigned_condition = $4 AND slot_expires_ms <= $5 \
         ORDER BY slot LIMIT 1",
    )
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(condition)
    .bind(session.now_ms)
    .fetch_optional(&mut *transaction)
    .await?;
    if let Some(free) = free {
        let key: i64 = free.get("session_key")?;
        query("UPDATE sessions SET slot_expires_ms = NULL, slot_given = 1 WHERE session_key = $1")
            .bind(key)
            .execute(transaction)
            .await?;
        return free.get("slot");
    }
    let row = query(
        "SELECT COALESCE(MAX(slot), 0) + 1 AS slot FROM sessions WHERE study_id = $1 \
         AND config_hash = $2 AND stage = $3 AND assigned_condition = $4",
    )
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.stage)
    .bind(condition)
    .fetch_one(transaction)
    .await?;
    row.get("slot")
}
