//! Deletions that a researcher asks for, and the list of all there were.

use sqlx::AssertSqlSafe;

use super::erase::{By, Cause, erase};
use super::row::{SESSION_COLUMNS, session_record};
use crate::accounts::records::AuditEntry;
use crate::database::{query, signed};
use crate::decisions::insert_entry;
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{Deletion, participant_id};

impl Storage {
    /// Deletes a participant's answers and identifiers at their wish; returns how many events. `who` does
    /// it, for the log.
    pub async fn erase_participant(
        &self,
        study_id: &str,
        participant: u64,
        who: &str,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        let lock = transaction.dialect().row_lock;
        let row = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 AND participant = $2{lock}"
        )))
        .bind(study_id)
        .bind(signed(participant))
        .fetch_optional(&mut transaction)
        .await?;
        let session = session_record(&row.ok_or(StorageError::UnknownSession)?)?;
        let by = By { who, action: "delete a participant’s answers" };
        let deleted = erase(&mut transaction, &session, Cause::Wish, by, now_ms).await?;
        transaction.commit().await?;
        self.wiper.wipe().await;
        Ok(deleted)
    }

    /// Deletes recruitment identifiers and repeat marks, of one participant or of all of a study;
    /// returns how many. `who` does it, for the log.
    pub async fn erase_identifiers(
        &self,
        study_id: &str,
        participant: Option<u64>,
        who: &str,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        const WHOSE: &str = "study_id = $1 AND ($2 = 0 OR participant = $2)";
        let number = participant.map_or(0, signed);
        let mut transaction = self.writers.begin_write().await?;
        query(AssertSqlSafe(format!(
            "UPDATE sessions SET identifiers_erased_ms = $3 WHERE {WHOSE}"
        )))
        .bind(study_id)
        .bind(number)
        .bind(now_ms)
        .execute(&mut transaction)
        .await?;
        let mut deleted = 0;
        for table in ["recruitment", "repeat_marks"] {
            deleted += query(AssertSqlSafe(format!(
                "DELETE FROM {table} WHERE session_key IN \
                 (SELECT session_key FROM sessions WHERE {WHOSE})"
            )))
            .bind(study_id)
            .bind(number)
            .execute(&mut transaction)
            .await?;
        }
        let entry = AuditEntry {
            key: 0,
            at_ms: now_ms,
            who: who.to_owned(),
            action: "delete identifiers".to_owned(),
            study_id: study_id.to_owned(),
            subject: participant.map(participant_id).unwrap_or_default(),
        };
        insert_entry(&mut transaction, &entry).await?;
        transaction.commit().await?;
        self.wiper.wipe().await;
        Ok(deleted)
    }

    /// Every deletion there was, in order of time: what a backup must not bring back.
    pub async fn deletions(&self) -> Result<Vec<Deletion>, StorageError> {
        let rows = query(
            "SELECT token_hash, CASE WHEN status = 'withdrawn' THEN 'withdrawn' ELSE 'erased' END \
             AS what, deleted_ms AS at_ms FROM sessions WHERE deleted_ms IS NOT NULL \
             UNION ALL SELECT token_hash, 'identifiers' AS what, identifiers_erased_ms AS at_ms \
             FROM sessions WHERE identifiers_erased_ms IS NOT NULL ORDER BY 3, 1, 2",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(Deletion {
                    token_hash: row.get("token_hash")?,
                    what: row.get("what")?,
                    at_ms: row.get::<Option<i64>>("at_ms")?.unwrap_or_default(),
                })
            })
            .collect()
    }
}
