//! What accounts may do in single studies, beside what they may do in all.

use std::collections::BTreeMap;

use super::records::{Role, StudyRole};
use super::row::role;
use crate::database::{Place, query};
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// The roles that an account has in single studies.
    pub async fn study_roles_of(
        &self,
        account_key: i64,
    ) -> Result<BTreeMap<String, Role>, StorageError> {
        let rows = query("SELECT study_id, role FROM study_roles WHERE account_key = $1")
            .bind(account_key)
            .fetch_all(&self.readers)
            .await?;
        rows.iter()
            .map(|row| Ok((row.get("study_id")?, role("study_roles", row.get("role")?)?)))
            .collect()
    }

    /// Everybody's roles in single studies, by account and study.
    pub async fn study_roles(&self) -> Result<Vec<StudyRole>, StorageError> {
        let rows = query(
            "SELECT account_key, study_id, role FROM study_roles ORDER BY account_key, study_id",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(StudyRole {
                    account_key: row.get("account_key")?,
                    study_id: row.get("study_id")?,
                    role: role("study_roles", row.get("role")?)?,
                })
            })
            .collect()
    }

    /// Gives an account a role in a study, or takes it away ([`Role::Nothing`]).
    pub async fn set_study_role(&self, given: &StudyRole) -> Result<(), StorageError> {
        if given.role == Role::Nothing {
            query("DELETE FROM study_roles WHERE account_key = $1 AND study_id = $2")
                .bind(given.account_key)
                .bind(&given.study_id)
                .execute(&self.writers)
                .await?;
            return Ok(());
        }
        put_study_role(&self.writers, given).await
    }
}

/// Gives an account a role in a study.
pub(super) async fn put_study_role(
    place: impl Into<Place<'_>>,
    given: &StudyRole,
) -> Result<(), StorageError> {
    query(
        "INSERT INTO study_roles (account_key, study_id, role) VALUES ($1, $2, $3) \
         ON CONFLICT (account_key, study_id) DO UPDATE SET role = excluded.role",
    )
    .bind(given.account_key)
    .bind(&given.study_id)
    .bind(given.role.word())
    .execute(place)
    .await?;
    Ok(())
}
