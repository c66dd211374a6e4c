//! One-time links.

use super::people::end_access;
use super::records::{Account, AccountLink, LinkPurpose, Role, StudyRole};
use super::row::{account, account_link};
use super::study_roles::put_study_role;
use crate::database::{Row, Transaction, query};
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// Remembers a one-time link by its secret's hash; replaces an earlier one to the same person.
    pub async fn add_link(
        &self,
        secret_hash: &str,
        link: &AccountLink,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query("DELETE FROM account_links WHERE expires_ms < $1")
            .bind(now_ms)
            .execute(&mut transaction)
            .await?;
        // A new link to the same person replaces the one before it.
        query("DELETE FROM account_links WHERE email = $1 AND email <> ''")
            .bind(&link.email)
            .execute(&mut transaction)
            .await?;
        query(
            "INSERT INTO account_links (secret_hash, purpose, email, role, study_id, expires_ms) \
             VALUES ($1, $2, $3, $4, $5, $6)",
        )
        .bind(secret_hash)
        .bind(link.purpose.word())
        .bind(&link.email)
        .bind(link.role.word())
        .bind(link.study_id.as_deref().unwrap_or_default())
        .bind(link.expires_ms)
        .execute(&mut transaction)
        .await?;
        transaction.commit().await?;
        Ok(())
    }

    /// The link with this hash, unless it was used or has expired.
    pub async fn link(
        &self,
        secret_hash: &str,
        now_ms: i64,
    ) -> Result<Option<AccountLink>, StorageError> {
        let row = query(
            "SELECT purpose, email, role, study_id, expires_ms FROM account_links \
             WHERE secret_hash = $1 AND used_ms IS NULL AND expires_ms >= $2",
        )
        .bind(secret_hash)
        .bind(now_ms)
        .fetch_optional(&self.readers)
        .await?;
        row.as_ref().map(account_link).transpose()
    }

    /// Uses a link once: makes the account or sets its password. `email` is taken where the link
    /// names nobody. None where the link does not work any more or the account exists.
    pub async fn use_link(
        &self,
        secret_hash: &str,
        email: &str,
        password_hash: &str,
        now_ms: i64,
    ) -> Result<Option<Account>, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        let row = query(
            "UPDATE account_links SET used_ms = $2 \
             WHERE secret_hash = $1 AND used_ms IS NULL AND expires_ms >= $2 \
             RETURNING purpose, email, role, study_id, expires_ms",
        )
        .bind(secret_hash)
        .bind(now_ms)
        .fetch_optional(&mut transaction)
        .await?;
        let Some(link) = row.as_ref().map(account_link).transpose()? else { return Ok(None) };
        let email = if link.email.is_empty() { email } else { &link.email };
        let found = match link.purpose {
            LinkPurpose::Recovery => {
                enable(&mut transaction, email).await?;
                reset(&mut transaction, email, password_hash, now_ms).await?
            }
            LinkPurpose::Reset => reset(&mut transaction, email, password_hash, now_ms).await?,
            LinkPurpose::FirstOwner if !is_first_owner(&mut transaction).await? => None,
            _ => add_account(&mut transaction, &link, email, password_hash, now_ms).await?,
        };
        let Some(found) = found.as_ref().map(account).transpose()? else { return Ok(None) };
        transaction.commit().await?;
        Ok(Some(found))
    }
}

/// Makes the account that a link is for, with its role in all studies or in the one that is named. None where
/// somebody has an account by that address.
async fn add_account(
    transaction: &mut Transaction,
    link: &AccountLink,
    email: &str,
    password_hash: &str,
    now_ms: i64,
) -> Result<Option<Row>, StorageError> {
    let in_all = if link.study_id.is_some() { Role::Nothing } else { link.role };
    let row = query(
        "INSERT INTO accounts (email, role, password_hash, created_ms) \
         VALUES ($1, $2, $3, $4) ON CONFLICT (email) DO NOTHING \
         RETURNING account_key, email, role, password_hash, created_ms, disabled_ms",
    )
    .bind(email)
    .bind(in_all.word())
    .bind(password_hash)
    .bind(now_ms)
    .fetch_optional(&mut *transaction)
    .await?;
    if let (Some(row), Some(study_id)) = (&row, &link.study_id) {
        let account_key = row.get("account_key")?;
        let role = StudyRole { account_key, study_id: study_id.clone(), role: link.role };
        put_study_role(transaction, &role).await?;
    }
    Ok(row)
}

/// Lets an account be used again.
async fn enable(transaction: &mut Transaction, email: &str) -> Result<(), StorageError> {
    query("UPDATE accounts SET disabled_ms = NULL WHERE email = $1")
        .bind(email)
        .execute(transaction)
        .await?;
    Ok(())
}

/// Sets the password of an account that can be used; whoever was logged in by the old one, or has a token
/// from that time, is so no more.
async fn reset(
    transaction: &mut Transaction,
    email: &str,
    password_hash: &str,
    now_ms: i64,
) -> Result<Option<Row>, StorageError> {
    let row = query(
        "UPDATE accounts SET password_hash = $2 WHERE email = $1 AND disabled_ms IS NULL \
         RETURNING account_key, email, role, password_hash, created_ms, disabled_ms",
    )
    .bind(email)
    .bind(password_hash)
    .fetch_optional(&mut *transaction)
    .await?;
    if let Some(row) = &row {
        end_access(transaction, row.get("account_key")?, "", now_ms).await?;
    }
    Ok(row)
}

/// Whether nobody has become the first owner; of two first links used at once one makes the owner.
async fn is_first_owner(transaction: &mut Transaction) -> Result<bool, StorageError> {
    let made = query(
        "INSERT INTO server_keys (name, secret) VALUES ('first owner', 'made') \
         ON CONFLICT DO NOTHING",
    )
    .execute(transaction)
    .await?;
    Ok(made > 0)
}
