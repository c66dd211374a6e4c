//! Deleting: a participant withdraws, asks for it by letter, or the answers' time is over. The
//! session's row stays, empty, so that its number is never given again and backups know of it.

use sqlx::{AssertSqlSafe, Row};

use super::super::super::records::{Deletion, SessionRecord, Status};
use super::super::super::{PERSONAL_TABLES, StorageError};
use super::super::{BEGIN_WRITE, Connection, FOR_UPDATE};
use super::changes::find_session;
use super::{SESSION_COLUMNS, Store, session_record, signed};
use crate::secret;

/// Deletes what a participant has answered who holds the withdrawal code; gives how many events.
pub(super) async fn withdraw(
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
    erase(connection, &session, Status::Withdrawn, now_ms).await
}

/// Deletes everything that hangs on a session and empties its row.
pub(super) async fn erase(
    connection: &mut Connection,
    session: &SessionRecord,
    status: Status,
    now_ms: i64,
) -> Result<u64, StorageError> {
    let mut deleted = 0;
    for table in PERSONAL_TABLES {
        let rows =
            sqlx::query(AssertSqlSafe(format!("DELETE FROM {table} WHERE session_key = $1")))
                .bind(session.key)
                .execute(&mut *connection)
                .await?
                .rows_affected();
        if table == "events" {
            deleted = rows;
        }
    }
    if !session.status.is_deleted() {
        sqlx::query(
            "UPDATE sessions SET status = $1, ended_ms = $2, client = '{}', event_count = 0, \
             next_sequence = 0, last_event_ms = NULL, receipt = NULL, receipt_events = NULL, \
             slot_expires_ms = CASE WHEN slot_given = 0 AND $1 = 'withdrawn' THEN 0 ELSE NULL END, \
             finished = CASE WHEN $1 = 'withdrawn' THEN 0 ELSE finished END \
             WHERE session_key = $3",
        )
        .bind(status.word())
        .bind(now_ms)
        .bind(session.key)
        .execute(connection)
        .await?;
    }
    Ok(deleted)
}

impl Store {
    pub async fn erase_participant(
        &self,
        study_id: &str,
        participant: u64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        let row = sqlx::query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND participant = $2\
             {FOR_UPDATE}"
        )))
        .bind(study_id)
        .bind(signed(participant))
        .fetch_optional(&mut *transaction)
        .await?;
        let session = session_record(&row.ok_or(StorageError::UnknownSession)?)?;
        let deleted = erase(&mut transaction, &session, Status::Withdrawn, now_ms).await?;
        transaction.commit().await?;
        Ok(deleted)
    }

    pub async fn erase_identifiers(
        &self,
        study_id: &str,
        participant: Option<u64>,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        const WHOSE: &str = "study_id = $1 AND ($2 = 0 OR participant = $2)";
        let number = participant.map_or(0, signed);
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query(AssertSqlSafe(format!(
            "UPDATE sessions SET identifiers_erased_ms = $3 WHERE {WHOSE}"
        )))
        .bind(study_id)
        .bind(number)
        .bind(now_ms)
        .execute(&mut *transaction)
        .await?;
        let mut deleted = 0;
        for table in ["recruitment", "repeat_marks"] {
            deleted += sqlx::query(AssertSqlSafe(format!(
                "DELETE FROM {table} WHERE session_key IN \
                 (SELECT session_key FROM sessions WHERE {WHOSE})"
            )))
            .bind(study_id)
            .bind(number)
            .execute(&mut *transaction)
            .await?
            .rows_affected();
        }
        transaction.commit().await?;
        Ok(deleted)
    }

    pub async fn erase_ended_before(
        &self,
        study_id: &str,
        config_hash: &str,
        before_ms: i64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        let rows = sqlx::query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND config_hash = $2 \
             AND status IN ('started', 'completed') \
             AND COALESCE(ended_ms, last_event_ms, started_ms) < $3 \
             ORDER BY session_key{FOR_UPDATE}"
        )))
        .bind(study_id)
        .bind(config_hash)
        .bind(before_ms)
        .fetch_all(&mut *transaction)
        .await?;
        for row in &rows {
            let session = session_record(row)?;
            erase(&mut transaction, &session, Status::Erased, now_ms).await?;
        }
        transaction.commit().await?;
        Ok(rows.len() as u64)
    }

    pub async fn deletions(&self) -> Result<Vec<Deletion>, StorageError> {
        let rows = sqlx::query(
            "SELECT token_hash, status AS what, ended_ms AS at_ms FROM sessions \
             WHERE status IN ('withdrawn', 'erased') \
             UNION ALL SELECT token_hash, 'identifiers' AS what, identifiers_erased_ms AS at_ms \
             FROM sessions WHERE identifiers_erased_ms IS NOT NULL ORDER BY 3, 1, 2",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(Deletion {
                    token_hash: row.try_get("token_hash")?,
                    what: row.try_get("what")?,
                    at_ms: row.try_get::<Option<i64>, _>("at_ms")?.unwrap_or_default(),
                })
            })
            .collect()
    }
}

/// Deletes again what was deleted after a backup was made; a session that is not here was started
/// later.
pub(super) async fn repeat_deletions(
    connection: &mut Connection,
    deletions: &[Deletion],
) -> Result<u64, StorageError> {
    let mut repeated = 0;
    for deletion in deletions {
        let Some(session) = find_session(connection, &deletion.token_hash).await? else {
            continue;
        };
        match Status::from_word(&deletion.what) {
            Some(status) if status.is_deleted() => {
                repeated += u64::from(!session.status.is_deleted());
                erase(connection, &session, status, deletion.at_ms).await?;
            }
            _ => {
                for table in ["recruitment", "repeat_marks"] {
                    repeated += sqlx::query(AssertSqlSafe(format!(
                        "DELETE FROM {table} WHERE session_key = $1"
                    )))
                    .bind(session.key)
                    .execute(&mut *connection)
                    .await?
                    .rows_affected();
                }
                sqlx::query(
                    "UPDATE sessions SET identifiers_erased_ms = $1 WHERE session_key = $2",
                )
                .bind(deletion.at_ms)
                .bind(session.key)
                .execute(&mut *connection)
                .await?;
            }
        }
    }
    Ok(repeated)
}
