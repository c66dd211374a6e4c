//! Some of a study's sessions, and of all of them what a list needs.

use sqlx::AssertSqlSafe;

use super::row::{DUE_MS, SESSION_COLUMNS, session_record, standing};
use crate::database::{Row, query, signed};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{CountedSo, SessionRecord, SessionState};

impl Storage {
    /// So many sessions of a study at most, by participant number, those after one: a piece of what may be
    /// many.
    pub async fn sessions_after(
        &self,
        study_id: &str,
        participant: u64,
        most: u32,
    ) -> Result<Vec<SessionRecord>, StorageError> {
        let rows = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND participant > $2 \
             ORDER BY participant LIMIT $3"
        )))
        .bind(study_id)
        .bind(signed(participant))
        .bind(i64::from(most))
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(session_record).collect()
    }

    /// The session of a participant.
    pub async fn participant_session(
        &self,
        study_id: &str,
        participant: u64,
    ) -> Result<SessionRecord, StorageError> {
        let row = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND participant = $2"
        )))
        .bind(study_id)
        .bind(signed(participant))
        .fetch_optional(&self.readers)
        .await?;
        session_record(&row.ok_or(StorageError::UnknownSession)?)
    }

    /// Some sessions of a study, by participant number.
    pub async fn sessions_of(
        &self,
        study_id: &str,
        participants: &[u64],
    ) -> Result<Vec<SessionRecord>, StorageError> {
        let mut sessions = Vec::with_capacity(participants.len());
        for participant in participants {
            match self.participant_session(study_id, *participant).await {
                Ok(session) => sessions.push(session),
                Err(StorageError::UnknownSession) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(sessions)
    }

    /// How every session of a study stands, by participant number, and of what its kept sums of a form were
    /// made.
    pub async fn session_states(
        &self,
        study_id: &str,
        form: i64,
    ) -> Result<Vec<SessionState>, StorageError> {
        let rows = query(AssertSqlSafe(format!(
            "SELECT s.session_key, s.participant, s.config_hash, s.stage, s.assigned_condition, s.status, \
             s.deleted_ms, s.ended_ms, {DUE_MS} AS due_ms, s.event_count, s.receipt_events, v.event_count AS summed_events, \
             v.receipt_events AS summed_receipt \
             FROM sessions s LEFT JOIN session_sums v \
             ON v.session_key = s.session_key AND v.form = $2 \
             WHERE s.study_id = $1 ORDER BY s.participant"
        )))
        .bind(study_id)
        .bind(form)
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(session_state).collect()
    }
}

fn session_state(row: &Row) -> Result<SessionState, StorageError> {
    const TABLE: &str = "sessions";
    let condition: String = row.get("assigned_condition")?;
    let receipt_events: Option<i64> = row.get("receipt_events")?;
    let summed: Option<i64> = row.get("summed_events")?;
    let summed_receipt: Option<i64> = row.get("summed_receipt")?;
    let events = |count: i64| crate::database::unsigned(TABLE, count);
    let summed = match (summed, summed_receipt) {
        (Some(count), Some(receipt)) => Some(CountedSo {
            event_count: events(count)?,
            // -1 where there was no receipt.
            receipt_events: u64::try_from(receipt).ok(),
        }),
        _ => None,
    };
    Ok(SessionState {
        key: row.get("session_key")?,
        participant: row.unsigned(TABLE, "participant")?,
        config_hash: row.get("config_hash")?,
        stage: row.get("stage")?,
        condition: Some(condition).filter(|name| !name.is_empty()),
        standing: standing(&row.get::<String>("status")?)?,
        is_deleted: row.get::<Option<i64>>("deleted_ms")?.is_some(),
        ended_ms: row.get("ended_ms")?,
        sign_of_life_due_ms: row.get("due_ms")?,
        counted: CountedSo {
            event_count: row.unsigned(TABLE, "event_count")?,
            receipt_events: receipt_events.map(events).transpose()?,
        },
        summed,
    })
}
