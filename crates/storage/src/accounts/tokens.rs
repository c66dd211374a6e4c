//! Keys for scripts.

use super::SEEN_STEP_MS;
use super::records::{Account, ApiToken, Role};
use super::row::{account, role};
use crate::database::query;
use crate::error::StorageError;
use crate::handle::Storage;

impl Storage {
    /// Remembers a token for scripts by its hash.
    pub async fn add_token(
        &self,
        secret_hash: &str,
        account_key: i64,
        name: &str,
        role: Role,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        query(
            "INSERT INTO api_tokens (secret_hash, account_key, name, role, created_ms) \
             VALUES ($1, $2, $3, $4, $5)",
        )
        .bind(secret_hash)
        .bind(account_key)
        .bind(name)
        .bind(role.word())
        .bind(now_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    /// Every token, revoked ones too, oldest first.
    pub async fn tokens(&self) -> Result<Vec<ApiToken>, StorageError> {
        let rows = query(
            "SELECT t.token_key, t.name, t.role, a.email, t.created_ms, t.used_ms, t.revoked_ms \
             FROM api_tokens t JOIN accounts a ON a.account_key = t.account_key \
             ORDER BY t.token_key",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(ApiToken {
                    key: row.get("token_key")?,
                    name: row.get("name")?,
                    role: role("api_tokens", row.get("role")?)?,
                    email: row.get("email")?,
                    created_ms: row.get("created_ms")?,
                    used_ms: row.get("used_ms")?,
                    revoked_ms: row.get("revoked_ms")?,
                })
            })
            .collect()
    }

    /// Ends a token.
    pub async fn revoke_token(&self, token_key: i64, now_ms: i64) -> Result<(), StorageError> {
        query("UPDATE api_tokens SET revoked_ms = $2 WHERE token_key = $1 AND revoked_ms IS NULL")
            .bind(token_key)
            .bind(now_ms)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    /// The account of a token that works, and the most that the token may do.
    pub async fn token_bearer(
        &self,
        secret_hash: &str,
        now_ms: i64,
    ) -> Result<Option<(Account, Role)>, StorageError> {
        let row = query(
            "SELECT a.account_key, a.email, a.role, a.password_hash, a.created_ms, a.disabled_ms, \
             t.role AS token_role, t.used_ms FROM api_tokens t \
             JOIN accounts a ON a.account_key = t.account_key \
             WHERE t.secret_hash = $1 AND t.revoked_ms IS NULL AND a.disabled_ms IS NULL",
        )
        .bind(secret_hash)
        .fetch_optional(&self.readers)
        .await?;
        let Some(row) = row else { return Ok(None) };
        let used: Option<i64> = row.get("used_ms")?;
        if used.is_none_or(|used| used < now_ms - SEEN_STEP_MS) {
            query("UPDATE api_tokens SET used_ms = $2 WHERE secret_hash = $1")
                .bind(secret_hash)
                .bind(now_ms)
                .execute(&self.writers)
                .await?;
        }
        let account = account(&row)?;
        Ok(Some((account, role("api_tokens", row.get("token_role")?)?)))
    }
}
