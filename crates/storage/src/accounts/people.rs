//! Accounts: who may log in, and what as.

use super::records::{Account, Role};
use super::row::account;
use crate::database::{Transaction, query};
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// Whether anybody has an account.
    pub async fn has_accounts(&self) -> Result<bool, StorageError> {
        let row = query("SELECT COUNT(*) AS found FROM accounts").fetch_one(&self.readers).await?;
        Ok(row.get::<i64>("found")? > 0)
    }

    /// Every account, by address.
    pub async fn accounts(&self) -> Result<Vec<Account>, StorageError> {
        let rows = query(
            "SELECT account_key, email, role, password_hash, created_ms, disabled_ms \
             FROM accounts ORDER BY email",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(account).collect()
    }

    /// The account with this address (in lower case).
    pub async fn account_by_email(&self, email: &str) -> Result<Option<Account>, StorageError> {
        let row = query(
            "SELECT account_key, email, role, password_hash, created_ms, disabled_ms \
             FROM accounts WHERE email = $1",
        )
        .bind(email)
        .fetch_optional(&self.readers)
        .await?;
        row.as_ref().map(account).transpose()
    }

    /// Sets a password and ends every other session of the account, its tokens and its links.
    pub async fn set_password(
        &self,
        account_key: i64,
        password_hash: &str,
        kept_session: &str,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query("UPDATE accounts SET password_hash = $2 WHERE account_key = $1")
            .bind(account_key)
            .bind(password_hash)
            .execute(&mut transaction)
            .await?;
        end_access(&mut transaction, account_key, kept_session, now_ms).await?;
        transaction.commit().await?;
        Ok(())
    }

    /// Sets a role; false where it would leave nobody to own the server.
    pub async fn set_role(&self, account_key: i64, role: Role) -> Result<bool, StorageError> {
        let done = query(
            "UPDATE accounts SET role = $2 WHERE account_key = $1 \
             AND (role <> 'owner' OR $2 = 'owner' OR (SELECT COUNT(*) FROM accounts \
             WHERE role = 'owner' AND disabled_ms IS NULL AND account_key <> $1) > 0)",
        )
        .bind(account_key)
        .bind(role.word())
        .execute(&self.writers)
        .await?;
        Ok(done == 1)
    }

    /// Disables an account and ends its sessions, tokens and links; false where nobody would be left to own the server.
    pub async fn disable_account(
        &self,
        account_key: i64,
        now_ms: i64,
    ) -> Result<bool, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        let done = query(
            "UPDATE accounts SET disabled_ms = $2 WHERE account_key = $1 AND disabled_ms IS NULL \
             AND (role <> 'owner' OR (SELECT COUNT(*) FROM accounts WHERE role = 'owner' \
             AND disabled_ms IS NULL AND account_key <> $1) > 0)",
        )
        .bind(account_key)
        .bind(now_ms)
        .execute(&mut transaction)
        .await?;
        if done == 0 {
            return Ok(false);
        }
        end_access(&mut transaction, account_key, "", now_ms).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Enables an account again.
    pub async fn enable_account(&self, account_key: i64) -> Result<bool, StorageError> {
        let done = query("UPDATE accounts SET disabled_ms = NULL WHERE account_key = $1")
            .bind(account_key)
            .execute(&self.writers)
            .await?;
        Ok(done == 1)
    }
}

/// Ends every way into an account but one browser's session: other sessions, tokens, links that wait.
pub(super) async fn end_access(
    transaction: &mut Transaction,
    account_key: i64,
    kept_session: &str,
    now_ms: i64,
) -> Result<(), StorageError> {
    query("DELETE FROM account_sessions WHERE account_key = $1 AND secret_hash <> $2")
        .bind(account_key)
        .bind(kept_session)
        .execute(&mut *transaction)
        .await?;
    query("UPDATE api_tokens SET revoked_ms = $2 WHERE account_key = $1 AND revoked_ms IS NULL")
        .bind(account_key)
        .bind(now_ms)
        .execute(&mut *transaction)
        .await?;
    query(
        "DELETE FROM account_links WHERE used_ms IS NULL \
         AND email = (SELECT email FROM accounts WHERE account_key = $1)",
    )
    .bind(account_key)
    .execute(transaction)
    .await?;
    Ok(())
}
