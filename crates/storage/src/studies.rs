//! The studies that were ever served, version by version.

use sqlx::AssertSqlSafe;

use crate::database::{Row, Transaction, query};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{Registered, StudyVersion};

impl Storage {
    /// Makes this version the current one of its study, and says what that changes.
    pub async fn register_study(
        &self,
        version: &StudyVersion,
        now_ms: i64,
    ) -> Result<Registered, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        let lock = transaction.dialect().row_lock;
        let before = query(AssertSqlSafe(format!(
            "SELECT config_hash FROM studies WHERE study_id = $1{lock}"
        )))
        .bind(&version.study_id)
        .fetch_optional(&mut transaction)
        .await?;
        let before: Option<String> = before.map(|row| row.get("config_hash")).transpose()?;
        query(
            "INSERT INTO studies (study_id, config_hash, next_participant) VALUES ($1, $2, 1) \
             ON CONFLICT (study_id) DO UPDATE SET config_hash = excluded.config_hash",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .execute(&mut transaction)
        .await?;
        let known =
            query("SELECT clips FROM study_versions WHERE study_id = $1 AND config_hash = $2")
                .bind(&version.study_id)
                .bind(&version.config_hash)
                .fetch_optional(&mut transaction)
                .await?;
        let known: Option<String> = known.map(|row| row.get("clips")).transpose()?;
        query(
            "INSERT INTO study_versions (study_id, config_hash, file, clips, first_served_ms, measures) \
             VALUES ($1, $2, $3, $4, $5, $6) \
             ON CONFLICT (study_id, config_hash) \
             DO UPDATE SET clips = excluded.clips, measures = excluded.measures",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .bind(&version.file)
        .bind(&version.clips)
        .bind(now_ms)
        .bind(&version.measures)
        .execute(&mut transaction)
        .await?;
        let number = number(&mut transaction, version).await?;
        let running_elsewhere = running_elsewhere(&mut transaction, version).await?;
        transaction.commit().await?;
        Ok(Registered {
            version: number,
            replaces: before.filter(|hash| *hash != version.config_hash),
            running_elsewhere,
            stimuli_changed: known.is_some_and(|clips| clips != version.clips),
        })
    }

    /// Whether a study of this identifier was ever served.
    pub async fn has_study(&self, study_id: &str) -> Result<bool, StorageError> {
        let row = query("SELECT 1 FROM studies WHERE study_id = $1")
            .bind(study_id)
            .fetch_optional(&self.readers)
            .await?;
        Ok(row.is_some())
    }

    /// One version of a study, if it was ever served.
    pub async fn study_version(
        &self,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Option<StudyVersion>, StorageError> {
        let row = query(
            "SELECT study_id, config_hash, file, clips, measures FROM study_versions \
             WHERE study_id = $1 AND config_hash = $2",
        )
        .bind(study_id)
        .bind(config_hash)
        .fetch_optional(&self.readers)
        .await?;
        row.as_ref().map(study_version).transpose()
    }

    /// Every version of every study ever served, in order of study and first service.
    pub async fn study_versions(&self) -> Result<Vec<StudyVersion>, StorageError> {
        let rows = query(
            "SELECT study_id, config_hash, file, clips, measures FROM study_versions \
             ORDER BY study_id, first_served_ms, config_hash",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(study_version).collect()
    }
}

fn study_version(row: &Row) -> Result<StudyVersion, StorageError> {
    Ok(StudyVersion {
        study_id: row.get("study_id")?,
        config_hash: row.get("config_hash")?,
        file: row.get("file")?,
        clips: row.get("clips")?,
        measures: row.get("measures")?,
    })
}

/// Which version of its study this is, counted from 1 in the order of first service.
async fn number(
    transaction: &mut Transaction,
    version: &StudyVersion,
) -> Result<u64, StorageError> {
    let row = query(
        "SELECT COUNT(*) AS number FROM study_versions v JOIN study_versions mine \
         ON mine.study_id = v.study_id AND mine.config_hash = $2 WHERE v.study_id = $1 \
         AND (v.first_served_ms < mine.first_served_ms OR (v.first_served_ms = \
         mine.first_served_ms AND v.config_hash <= mine.config_hash))",
    )
    .bind(&version.study_id)
    .bind(&version.config_hash)
    .fetch_one(transaction)
    .await?;
    row.unsigned("study_versions", "number")
}

/// Live sessions in progress under other versions of the study.
async fn running_elsewhere(
    transaction: &mut Transaction,
    version: &StudyVersion,
) -> Result<u64, StorageError> {
    let row = query(
        "SELECT COUNT(*) AS number FROM sessions WHERE study_id = $1 AND config_hash <> $2 \
         AND stage = 'live' AND status = 'active' AND deleted_ms IS NULL",
    )
    .bind(&version.study_id)
    .bind(&version.config_hash)
    .fetch_one(transaction)
    .await?;
    row.unsigned("sessions", "number")
}
