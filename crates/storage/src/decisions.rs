//! What researchers decide: exclusions and uploaded studies, and the log of who did what.

use crate::accounts::records::{AuditEntry, Exclusion, UploadedStudy};
use crate::database::{Place, query};
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// Adds a line to the log; its key is given by the database.
    pub async fn add_audit_entry(&self, entry: &AuditEntry) -> Result<(), StorageError> {
        insert_entry(&self.writers, entry).await
    }

    /// The log's lines with keys below `before`, the newest first.
    pub async fn audit_entries(
        &self,
        before: i64,
        most: u32,
    ) -> Result<Vec<AuditEntry>, StorageError> {
        let rows = query(
            "SELECT entry_key, at_ms, who, action, study_id, subject FROM audit_log \
             WHERE entry_key < $1 ORDER BY entry_key DESC LIMIT $2",
        )
        .bind(before)
        .bind(i64::from(most))
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(AuditEntry {
                    key: row.get("entry_key")?,
                    at_ms: row.get("at_ms")?,
                    who: row.get("who")?,
                    action: row.get("action")?,
                    study_id: row.get("study_id")?,
                    subject: row.get("subject")?,
                })
            })
            .collect()
    }

    /// Excludes a session, or takes that back.
    pub async fn add_exclusion(&self, exclusion: &Exclusion) -> Result<(), StorageError> {
        query("INSERT INTO exclusions (session_key, reason, who, at_ms) VALUES ($1, $2, $3, $4)")
            .bind(exclusion.session_key)
            .bind(&exclusion.reason)
            .bind(&exclusion.who)
            .bind(exclusion.at_ms)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    /// Every exclusion in a study and every taking back, oldest first.
    pub async fn exclusions(&self, study_id: &str) -> Result<Vec<Exclusion>, StorageError> {
        let rows = query(
            "SELECT e.session_key, e.reason, e.who, e.at_ms FROM exclusions e \
             JOIN sessions s ON s.session_key = e.session_key \
             WHERE s.study_id = $1 ORDER BY e.exclusion_key",
        )
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(Exclusion {
                    session_key: row.get("session_key")?,
                    reason: row.get("reason")?,
                    who: row.get("who")?,
                    at_ms: row.get("at_ms")?,
                })
            })
            .collect()
    }

    /// Remembers an uploaded study, or its new version or stage.
    pub async fn put_upload(&self, study: &UploadedStudy) -> Result<(), StorageError> {
        query(
            "INSERT INTO uploaded_studies (study_id, config_hash, archive_hash, stage, changed_ms) \
             VALUES ($1, $2, $3, $4, $5) ON CONFLICT (study_id) DO UPDATE SET \
             config_hash = excluded.config_hash, archive_hash = excluded.archive_hash, \
             stage = excluded.stage, changed_ms = excluded.changed_ms, removed_ms = NULL",
        )
        .bind(&study.study_id)
        .bind(&study.config_hash)
        .bind(&study.archive_hash)
        .bind(&study.stage)
        .bind(study.changed_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    /// The uploaded studies that are not removed, by identifier.
    pub async fn uploads(&self) -> Result<Vec<UploadedStudy>, StorageError> {
        let rows = query(
            "SELECT study_id, config_hash, archive_hash, stage, changed_ms FROM uploaded_studies \
             WHERE removed_ms IS NULL ORDER BY study_id",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(UploadedStudy {
                    study_id: row.get("study_id")?,
                    config_hash: row.get("config_hash")?,
                    archive_hash: row.get("archive_hash")?,
                    stage: row.get("stage")?,
                    changed_ms: row.get("changed_ms")?,
                })
            })
            .collect()
    }

    /// Hosts an uploaded study no more; its answers stay.
    pub async fn remove_upload(&self, study_id: &str, now_ms: i64) -> Result<(), StorageError> {
        query("UPDATE uploaded_studies SET removed_ms = $2 WHERE study_id = $1")
            .bind(study_id)
            .bind(now_ms)
            .execute(&self.writers)
            .await?;
        Ok(())
    }
}

/// Adds a line to the log, perhaps in the transaction of what it tells.
pub(crate) async fn insert_entry(
    place: impl Into<Place<'_>>,
    entry: &AuditEntry,
) -> Result<(), StorageError> {
    query(
        "INSERT INTO audit_log (at_ms, who, action, study_id, subject) \
         VALUES ($1, $2, $3, $4, $5)",
    )
    .bind(entry.at_ms)
    .bind(&entry.who)
    .bind(&entry.action)
    .bind(&entry.study_id)
    .bind(&entry.subject)
    .execute(place)
    .await?;
    Ok(())
}
