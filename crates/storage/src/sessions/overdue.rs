//! Answers whose time is over: marked first, deleted when the grace is over, kept if somebody says so; and
//! the times by which a clock that has jumped is known.

use sqlx::AssertSqlSafe;

use super::erase::{By, Cause, SERVER, erase};
use super::row::{SESSION_COLUMNS, session_record};
use crate::database::query;
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{Overdue, TimesSeen};

/// When a session ended, or showed its last sign of life.
const LAST_MS: &str = "COALESCE(ended_ms, last_event_ms, started_ms)";

impl Storage {
    /// Marks the sessions of a version that ended before `before_ms`, and takes the mark from those that
    /// did not: the clock has been put right, or somebody has gone on. How many were marked now.
    pub async fn mark_overdue(
        &self,
        study_id: &str,
        config_hash: &str,
        before_ms: i64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query(AssertSqlSafe(format!(
            "UPDATE sessions SET overdue_ms = NULL WHERE study_id = $1 AND config_hash = $2 \
             AND overdue_ms IS NOT NULL AND {LAST_MS} >= $3"
        )))
        .bind(study_id)
        .bind(config_hash)
        .bind(before_ms)
        .execute(&mut transaction)
        .await?;
        let marked = query(AssertSqlSafe(format!(
            "UPDATE sessions SET overdue_ms = $4 WHERE study_id = $1 AND config_hash = $2 \
             AND overdue_ms IS NULL AND deleted_ms IS NULL AND {LAST_MS} < $3"
        )))
        .bind(study_id)
        .bind(config_hash)
        .bind(before_ms)
        .bind(now_ms)
        .execute(&mut transaction)
        .await?;
        transaction.commit().await?;
        Ok(marked)
    }

    /// Deletes the answers of the sessions of a version that were marked at `marked_ms` or before; returns
    /// how many sessions.
    pub async fn erase_marked(
        &self,
        study_id: &str,
        config_hash: &str,
        marked_ms: i64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        let lock = transaction.dialect().row_lock;
        let rows = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND config_hash = $2 \
             AND deleted_ms IS NULL AND overdue_ms <= $3 ORDER BY session_key{lock}"
        )))
        .bind(study_id)
        .bind(config_hash)
        .bind(marked_ms)
        .fetch_all(&mut transaction)
        .await?;
        for row in &rows {
            let session = session_record(row)?;
            let by = By { who: SERVER, action: "delete answers whose time is over" };
            erase(&mut transaction, &session, Cause::TimeOver, by, now_ms).await?;
        }
        transaction.commit().await?;
        if !rows.is_empty() {
            self.wiper.wipe().await;
        }
        Ok(rows.len() as u64)
    }

    /// The sessions of a study whose answers wait to be deleted.
    pub async fn overdue(&self, study_id: &str) -> Result<Option<Overdue>, StorageError> {
        let row = query(
            "SELECT COUNT(*) AS found, MIN(overdue_ms) AS first FROM sessions \
             WHERE study_id = $1 AND overdue_ms IS NOT NULL AND deleted_ms IS NULL",
        )
        .bind(study_id)
        .fetch_one(&self.readers)
        .await?;
        let sessions = row.unsigned("sessions", "found")?;
        let first: Option<i64> = row.get("first")?;
        Ok(first.map(|first_marked_ms| Overdue { sessions, first_marked_ms }))
    }

    /// Takes the marks from a study's sessions: their answers are not deleted. How many there were.
    pub async fn keep_overdue(&self, study_id: &str) -> Result<u64, StorageError> {
        query(
            "UPDATE sessions SET overdue_ms = NULL WHERE study_id = $1 AND overdue_ms IS NOT NULL \
             AND deleted_ms IS NULL",
        )
        .bind(study_id)
        .execute(&self.writers)
        .await
    }

    /// The times that this database has seen.
    pub async fn times_seen(&self) -> Result<TimesSeen, StorageError> {
        let newest = query(
            "SELECT MAX(started_ms) AS started, MAX(last_event_ms) AS event, MAX(ended_ms) AS ended \
             FROM sessions",
        )
        .fetch_one(&self.readers)
        .await?;
        let mut seen = TimesSeen::default();
        for name in ["started", "event", "ended"] {
            seen.newest_ms = seen.newest_ms.max(newest.get::<Option<i64>>(name)?);
        }
        let rows = query("SELECT name, at_ms FROM clock_marks").fetch_all(&self.readers).await?;
        for row in &rows {
            match row.get::<String>("name")?.as_str() {
                SEEN => seen.believed_ms = row.get("at_ms")?,
                PASSED_OVER => seen.passed_over_ms = row.get("at_ms")?,
                _ => {}
            }
        }
        Ok(seen)
    }

    /// Remembers the time that is believed now.
    pub async fn believe_time(&self, now_ms: i64) -> Result<(), StorageError> {
        self.set_clock_mark(SEEN, now_ms).await
    }

    /// Remembers the newest event as one that the clock is not to be held against.
    pub async fn pass_over_events_until(&self, at_ms: i64) -> Result<(), StorageError> {
        self.set_clock_mark(PASSED_OVER, at_ms).await
    }

    async fn set_clock_mark(&self, name: &str, at_ms: i64) -> Result<(), StorageError> {
        query(
            "INSERT INTO clock_marks (name, at_ms) VALUES ($1, $2) \
             ON CONFLICT (name) DO UPDATE SET at_ms = excluded.at_ms",
        )
        .bind(name)
        .bind(at_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }
}

const SEEN: &str = "seen";
const PASSED_OVER: &str = "passed over";
