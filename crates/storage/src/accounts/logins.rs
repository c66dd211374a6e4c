//! Browsers' sessions, and attempts to log in.

use super::SEEN_STEP_MS;
use super::records::Account;
use super::row::account;
use crate::database::query;
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// Remembers a browser's session by its secret's hash.
    pub async fn log_in(
        &self,
        secret_hash: &str,
        account_key: i64,
        now_ms: i64,
        expires_ms: i64,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query("DELETE FROM account_sessions WHERE expires_ms < $1")
            .bind(now_ms)
            .execute(&mut transaction)
            .await?;
        query(
            "INSERT INTO account_sessions (secret_hash, account_key, seen_ms, expires_ms) \
             VALUES ($1, $2, $3, $4)",
        )
        .bind(secret_hash)
        .bind(account_key)
        .bind(now_ms)
        .bind(expires_ms)
        .execute(&mut transaction)
        .await?;
        transaction.commit().await?;
        Ok(())
    }

    /// The account of a browser's session that has not expired, idle or in all.
    pub async fn logged_in(
        &self,
        secret_hash: &str,
        now_ms: i64,
        longest_idle_ms: i64,
    ) -> Result<Option<Account>, StorageError> {
        let row = query(
            "SELECT a.account_key, a.email, a.role, a.password_hash, a.created_ms, a.disabled_ms, \
             s.seen_ms FROM account_sessions s JOIN accounts a ON a.account_key = s.account_key \
             WHERE s.secret_hash = $1 AND s.expires_ms >= $2 AND s.seen_ms >= $3 \
             AND a.disabled_ms IS NULL",
        )
        .bind(secret_hash)
        .bind(now_ms)
        .bind(now_ms - longest_idle_ms)
        .fetch_optional(&self.readers)
        .await?;
        let Some(row) = row else { return Ok(None) };
        if row.get::<i64>("seen_ms")? < now_ms - SEEN_STEP_MS {
            query("UPDATE account_sessions SET seen_ms = $2 WHERE secret_hash = $1")
                .bind(secret_hash)
                .bind(now_ms)
                .execute(&self.writers)
                .await?;
        }
        account(&row).map(Some)
    }

    /// Ends a browser's session.
    pub async fn log_out(&self, secret_hash: &str) -> Result<(), StorageError> {
        query("DELETE FROM account_sessions WHERE secret_hash = $1")
            .bind(secret_hash)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    /// Ends every session of an account.
    pub async fn log_out_everywhere(&self, account_key: i64) -> Result<(), StorageError> {
        query("DELETE FROM account_sessions WHERE account_key = $1")
            .bind(account_key)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    /// Counts an attempt to log in; how many there were within the window, this one included. Beyond `most`
    /// attempts are not remembered: they neither prolong the wait nor fill the table.
    pub async fn count_attempt(
        &self,
        subject: &str,
        now_ms: i64,
        window_ms: i64,
        most: u64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query("DELETE FROM login_attempts WHERE at_ms < $1")
            .bind(now_ms - window_ms)
            .execute(&mut transaction)
            .await?;
        let row = query("SELECT COUNT(*) AS found FROM login_attempts WHERE subject = $1")
            .bind(subject)
            .fetch_one(&mut transaction)
            .await?;
        let before = row.unsigned("login_attempts", "found")?;
        if before < most {
            query("INSERT INTO login_attempts (subject, at_ms) VALUES ($1, $2)")
                .bind(subject)
                .bind(now_ms)
                .execute(&mut transaction)
                .await?;
        }
        transaction.commit().await?;
        Ok(before + 1)
    }

    /// Forgets the attempts of one who has logged in.
    pub async fn forget_attempts(&self, subject: &str) -> Result<(), StorageError> {
        query("DELETE FROM login_attempts WHERE subject = $1")
            .bind(subject)
            .execute(&self.writers)
            .await?;
        Ok(())
    }
}
