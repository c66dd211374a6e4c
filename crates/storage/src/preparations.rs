//! How far preparing each uploaded study is, so that every server on the database can say it.

use crate::database::query;
use crate::error::StorageError;
use crate::handle::Storage;

/// Preparing that has said nothing for so long has died with its server.
const LONGEST_SILENCE_MS: i64 = 30 * 60 * 1000;

impl Storage {
    /// Notes that preparing a study begins; false where it is under way already.
    pub async fn begin_preparation(
        &self,
        study_id: &str,
        notes: &str,
        now_ms: i64,
    ) -> Result<bool, StorageError> {
        let begun = query(
            "INSERT INTO preparations (study_id, state, notes, changed_ms) \
             VALUES ($1, 'under', $2, $3) ON CONFLICT (study_id) DO UPDATE SET state = 'under', \
             notes = excluded.notes, changed_ms = excluded.changed_ms \
             WHERE preparations.state <> 'under' OR preparations.changed_ms < $4",
        )
        .bind(study_id)
        .bind(notes)
        .bind(now_ms)
        .bind(now_ms - LONGEST_SILENCE_MS)
        .execute(&self.writers)
        .await?;
        Ok(begun > 0)
    }

    /// Notes how far it is; `is_under_way` until it has come to an end.
    pub async fn note_preparation(
        &self,
        study_id: &str,
        is_under_way: bool,
        notes: &str,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        query(
            "UPDATE preparations SET state = $2, notes = $3, changed_ms = $4 WHERE study_id = $1",
        )
        .bind(study_id)
        .bind(if is_under_way { "under" } else { "ended" })
        .bind(notes)
        .bind(now_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    /// What was noted last of a study.
    pub async fn preparation(&self, study_id: &str) -> Result<Option<String>, StorageError> {
        let row = query("SELECT notes FROM preparations WHERE study_id = $1")
            .bind(study_id)
            .fetch_optional(&self.readers)
            .await?;
        row.map(|row| row.get("notes")).transpose()
    }
}
