//! Researchers' accounts, links, sessions, tokens, log, exclusions; compiled once for each database
//! (see `storage/mod.rs`). These are few and small: they do not go through the group commit.

use sqlx::Row;

use super::super::super::StorageError;
use super::super::super::account_records::{
    Account, AccountLink, ApiToken, AuditEntry, Exclusion, LinkPurpose, Role, UploadedStudy,
};
use super::super::{BEGIN_WRITE, Db};
use super::Store;

/// "Last seen" is kept to the minute: a page's every request need not write.
const SEEN_STEP_MS: i64 = 60_000;

impl Store {
    pub async fn has_accounts(&self) -> Result<bool, StorageError> {
        let row =
            sqlx::query("SELECT COUNT(*) AS found FROM accounts").fetch_one(&self.readers).await?;
        Ok(row.try_get::<i64, _>("found")? > 0)
    }

    pub async fn accounts(&self) -> Result<Vec<Account>, StorageError> {
        let rows = sqlx::query(
            "SELECT account_key, email, role, password_hash, created_ms, disabled_ms \
             FROM accounts ORDER BY email",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(account).collect()
    }

    pub async fn account_by_email(&self, email: &str) -> Result<Option<Account>, StorageError> {
        let row = sqlx::query(
            "SELECT account_key, email, role, password_hash, created_ms, disabled_ms \
             FROM accounts WHERE email = $1",
        )
        .bind(email)
        .fetch_optional(&self.readers)
        .await?;
        row.as_ref().map(account).transpose()
    }

    pub async fn add_link(
        &self,
        secret_hash: &str,
        link: &AccountLink,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query("DELETE FROM account_links WHERE expires_ms < $1")
            .bind(now_ms)
            .execute(&mut *transaction)
            .await?;
        // A new link to the same person replaces the one before it.
        sqlx::query("DELETE FROM account_links WHERE email = $1 AND email <> ''")
            .bind(&link.email)
            .execute(&mut *transaction)
            .await?;
        sqlx::query(
            "INSERT INTO account_links (secret_hash, purpose, email, role, expires_ms) \
             VALUES ($1, $2, $3, $4, $5)",
        )
        .bind(secret_hash)
        .bind(link.purpose.word())
        .bind(&link.email)
        .bind(link.role.word())
        .bind(link.expires_ms)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(())
    }

    pub async fn link(
        &self,
        secret_hash: &str,
        now_ms: i64,
    ) -> Result<Option<AccountLink>, StorageError> {
        let row = sqlx::query(
            "SELECT purpose, email, role, expires_ms FROM account_links \
             WHERE secret_hash = $1 AND used_ms IS NULL AND expires_ms >= $2",
        )
        .bind(secret_hash)
        .bind(now_ms)
        .fetch_optional(&self.readers)
        .await?;
        row.as_ref().map(account_link).transpose()
    }

    pub async fn use_link(
        &self,
        secret_hash: &str,
        email: &str,
        password_hash: &str,
        now_ms: i64,
    ) -> Result<Option<Account>, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        let row = sqlx::query(
            "UPDATE account_links SET used_ms = $2 \
             WHERE secret_hash = $1 AND used_ms IS NULL AND expires_ms >= $2 \
             RETURNING purpose, email, role, expires_ms",
        )
        .bind(secret_hash)
        .bind(now_ms)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(link) = row.as_ref().map(account_link).transpose()? else { return Ok(None) };
        let email = if link.email.is_empty() { email } else { &link.email };
        let found = match link.purpose {
            LinkPurpose::Reset => {
                // Whoever was logged in by the old password is so no more.
                sqlx::query(
                    "DELETE FROM account_sessions WHERE account_key IN \
                     (SELECT account_key FROM accounts WHERE email = $1)",
                )
                .bind(email)
                .execute(&mut *transaction)
                .await?;
                sqlx::query(
                    "UPDATE accounts SET password_hash = $2, disabled_ms = NULL WHERE email = $1 \
                     RETURNING account_key, email, role, password_hash, created_ms, disabled_ms",
                )
                .bind(email)
                .bind(password_hash)
                .fetch_optional(&mut *transaction)
                .await?
            }
            purpose => {
                // Two first links used at once: one of them makes the owner.
                if purpose == LinkPurpose::FirstOwner {
                    let first = sqlx::query(
                        "INSERT INTO server_keys (name, secret) VALUES ('first owner', 'made') \
                         ON CONFLICT DO NOTHING",
                    )
                    .execute(&mut *transaction)
                    .await?;
                    if first.rows_affected() == 0 {
                        return Ok(None);
                    }
                }
                sqlx::query(
                    "INSERT INTO accounts (email, role, password_hash, created_ms) \
                     VALUES ($1, $2, $3, $4) ON CONFLICT (email) DO NOTHING \
                     RETURNING account_key, email, role, password_hash, created_ms, disabled_ms",
                )
                .bind(email)
                .bind(link.role.word())
                .bind(password_hash)
                .bind(now_ms)
                .fetch_optional(&mut *transaction)
                .await?
            }
        };
        let Some(found) = found.as_ref().map(account).transpose()? else { return Ok(None) };
        transaction.commit().await?;
        Ok(Some(found))
    }

    pub async fn set_password(
        &self,
        account_key: i64,
        password_hash: &str,
        kept_session: &str,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query("UPDATE accounts SET password_hash = $2 WHERE account_key = $1")
            .bind(account_key)
            .bind(password_hash)
            .execute(&mut *transaction)
            .await?;
        sqlx::query("DELETE FROM account_sessions WHERE account_key = $1 AND secret_hash <> $2")
            .bind(account_key)
            .bind(kept_session)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(())
    }

    pub async fn set_role(&self, account_key: i64, role: Role) -> Result<bool, StorageError> {
        let done = sqlx::query(
            "UPDATE accounts SET role = $2 WHERE account_key = $1 \
             AND (role <> 'owner' OR $2 = 'owner' OR (SELECT COUNT(*) FROM accounts \
             WHERE role = 'owner' AND disabled_ms IS NULL AND account_key <> $1) > 0)",
        )
        .bind(account_key)
        .bind(role.word())
        .execute(&self.writers)
        .await?;
        Ok(done.rows_affected() == 1)
    }

    pub async fn disable_account(
        &self,
        account_key: i64,
        now_ms: i64,
    ) -> Result<bool, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        let done = sqlx::query(
            "UPDATE accounts SET disabled_ms = $2 WHERE account_key = $1 AND disabled_ms IS NULL \
             AND (role <> 'owner' OR (SELECT COUNT(*) FROM accounts WHERE role = 'owner' \
             AND disabled_ms IS NULL AND account_key <> $1) > 0)",
        )
        .bind(account_key)
        .bind(now_ms)
        .execute(&mut *transaction)
        .await?;
        if done.rows_affected() == 0 {
            return Ok(false);
        }
        sqlx::query("DELETE FROM account_sessions WHERE account_key = $1")
            .bind(account_key)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(true)
    }

    pub async fn enable_account(&self, account_key: i64) -> Result<bool, StorageError> {
        let done = sqlx::query("UPDATE accounts SET disabled_ms = NULL WHERE account_key = $1")
            .bind(account_key)
            .execute(&self.writers)
            .await?;
        Ok(done.rows_affected() == 1)
    }

    pub async fn log_in(
        &self,
        secret_hash: &str,
        account_key: i64,
        now_ms: i64,
        expires_ms: i64,
    ) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query("DELETE FROM account_sessions WHERE expires_ms < $1")
            .bind(now_ms)
            .execute(&mut *transaction)
            .await?;
        sqlx::query(
            "INSERT INTO account_sessions (secret_hash, account_key, seen_ms, expires_ms) \
             VALUES ($1, $2, $3, $4)",
        )
        .bind(secret_hash)
        .bind(account_key)
        .bind(now_ms)
        .bind(expires_ms)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(())
    }

    pub async fn logged_in(
        &self,
        secret_hash: &str,
        now_ms: i64,
        longest_idle_ms: i64,
    ) -> Result<Option<Account>, StorageError> {
        let row = sqlx::query(
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
        if row.try_get::<i64, _>("seen_ms")? < now_ms - SEEN_STEP_MS {
            sqlx::query("UPDATE account_sessions SET seen_ms = $2 WHERE secret_hash = $1")
                .bind(secret_hash)
                .bind(now_ms)
                .execute(&self.writers)
                .await?;
        }
        account(&row).map(Some)
    }

    pub async fn log_out(&self, secret_hash: &str) -> Result<(), StorageError> {
        sqlx::query("DELETE FROM account_sessions WHERE secret_hash = $1")
            .bind(secret_hash)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    pub async fn log_out_everywhere(&self, account_key: i64) -> Result<(), StorageError> {
        sqlx::query("DELETE FROM account_sessions WHERE account_key = $1")
            .bind(account_key)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    pub async fn count_attempt(
        &self,
        subject: &str,
        now_ms: i64,
        window_ms: i64,
    ) -> Result<u64, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query("DELETE FROM login_attempts WHERE at_ms < $1")
            .bind(now_ms - window_ms)
            .execute(&mut *transaction)
            .await?;
        sqlx::query("INSERT INTO login_attempts (subject, at_ms) VALUES ($1, $2)")
            .bind(subject)
            .bind(now_ms)
            .execute(&mut *transaction)
            .await?;
        let row = sqlx::query("SELECT COUNT(*) AS found FROM login_attempts WHERE subject = $1")
            .bind(subject)
            .fetch_one(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(row.try_get::<i64, _>("found")?.unsigned_abs())
    }

    pub async fn forget_attempts(&self, subject: &str) -> Result<(), StorageError> {
        sqlx::query("DELETE FROM login_attempts WHERE subject = $1")
            .bind(subject)
            .execute(&self.writers)
            .await?;
        Ok(())
    }

    pub async fn add_token(
        &self,
        secret_hash: &str,
        account_key: i64,
        name: &str,
        role: Role,
        now_ms: i64,
    ) -> Result<(), StorageError> {
        sqlx::query(
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

    pub async fn tokens(&self) -> Result<Vec<ApiToken>, StorageError> {
        let rows = sqlx::query(
            "SELECT t.token_key, t.name, t.role, a.email, t.created_ms, t.used_ms, t.revoked_ms \
             FROM api_tokens t JOIN accounts a ON a.account_key = t.account_key \
             ORDER BY t.token_key",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(ApiToken {
                    key: row.try_get("token_key")?,
                    name: row.try_get("name")?,
                    role: role("api_tokens", row.try_get("role")?)?,
                    email: row.try_get("email")?,
                    created_ms: row.try_get("created_ms")?,
                    used_ms: row.try_get("used_ms")?,
                    revoked_ms: row.try_get("revoked_ms")?,
                })
            })
            .collect()
    }

    pub async fn revoke_token(&self, token_key: i64, now_ms: i64) -> Result<(), StorageError> {
        sqlx::query(
            "UPDATE api_tokens SET revoked_ms = $2 WHERE token_key = $1 AND revoked_ms IS NULL",
        )
        .bind(token_key)
        .bind(now_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    pub async fn token_bearer(
        &self,
        secret_hash: &str,
        now_ms: i64,
    ) -> Result<Option<(Account, Role)>, StorageError> {
        let row = sqlx::query(
            "SELECT a.account_key, a.email, a.role, a.password_hash, a.created_ms, a.disabled_ms, \
             t.role AS token_role, t.used_ms FROM api_tokens t \
             JOIN accounts a ON a.account_key = t.account_key \
             WHERE t.secret_hash = $1 AND t.revoked_ms IS NULL AND a.disabled_ms IS NULL",
        )
        .bind(secret_hash)
        .fetch_optional(&self.readers)
        .await?;
        let Some(row) = row else { return Ok(None) };
        let used: Option<i64> = row.try_get("used_ms")?;
        if used.is_none_or(|used| used < now_ms - SEEN_STEP_MS) {
            sqlx::query("UPDATE api_tokens SET used_ms = $2 WHERE secret_hash = $1")
                .bind(secret_hash)
                .bind(now_ms)
                .execute(&self.writers)
                .await?;
        }
        let account = account(&row)?;
        let role = role("api_tokens", row.try_get("token_role")?)?.min(account.role);
        Ok(Some((account, role)))
    }

    pub async fn add_audit_entry(&self, entry: &AuditEntry) -> Result<(), StorageError> {
        sqlx::query(
            "INSERT INTO audit_log (at_ms, who, action, study_id, subject) \
             VALUES ($1, $2, $3, $4, $5)",
        )
        .bind(entry.at_ms)
        .bind(&entry.who)
        .bind(&entry.action)
        .bind(&entry.study_id)
        .bind(&entry.subject)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    pub async fn audit_entries(
        &self,
        before: i64,
        most: u32,
    ) -> Result<Vec<AuditEntry>, StorageError> {
        let rows = sqlx::query(
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
                    key: row.try_get("entry_key")?,
                    at_ms: row.try_get("at_ms")?,
                    who: row.try_get("who")?,
                    action: row.try_get("action")?,
                    study_id: row.try_get("study_id")?,
                    subject: row.try_get("subject")?,
                })
            })
            .collect()
    }

    pub async fn add_exclusion(&self, exclusion: &Exclusion) -> Result<(), StorageError> {
        sqlx::query(
            "INSERT INTO exclusions (session_key, reason, who, at_ms) VALUES ($1, $2, $3, $4)",
        )
        .bind(exclusion.session_key)
        .bind(&exclusion.reason)
        .bind(&exclusion.who)
        .bind(exclusion.at_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    pub async fn exclusions(&self, study_id: &str) -> Result<Vec<Exclusion>, StorageError> {
        let rows = sqlx::query(
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
                    session_key: row.try_get("session_key")?,
                    reason: row.try_get("reason")?,
                    who: row.try_get("who")?,
                    at_ms: row.try_get("at_ms")?,
                })
            })
            .collect()
    }

    pub async fn pulse(&self) -> Result<Vec<(String, String)>, StorageError> {
        let rows = sqlx::query(
            "SELECT s.study_id, COUNT(*) AS sessions, \
             CAST(COALESCE(SUM(s.event_count), 0) AS BIGINT) AS events, \
             COUNT(s.ended_ms) AS ended, COALESCE(MAX(s.ended_ms), 0) AS last_ended, \
             COALESCE(MAX(e.last), 0) AS last_exclusion FROM sessions s LEFT JOIN \
             (SELECT session_key, MAX(exclusion_key) AS last FROM exclusions GROUP BY session_key) \
             e ON e.session_key = s.session_key GROUP BY s.study_id",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let mut pulse = String::new();
                for name in ["sessions", "events", "ended", "last_ended", "last_exclusion"] {
                    pulse.push_str(&format!("{}.", row.try_get::<i64, _>(name)?));
                }
                Ok((row.try_get("study_id")?, pulse))
            })
            .collect()
    }

    pub async fn put_upload(&self, study: &UploadedStudy) -> Result<(), StorageError> {
        sqlx::query(
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

    pub async fn uploads(&self) -> Result<Vec<UploadedStudy>, StorageError> {
        let rows = sqlx::query(
            "SELECT study_id, config_hash, archive_hash, stage, changed_ms FROM uploaded_studies \
             WHERE removed_ms IS NULL ORDER BY study_id",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(UploadedStudy {
                    study_id: row.try_get("study_id")?,
                    config_hash: row.try_get("config_hash")?,
                    archive_hash: row.try_get("archive_hash")?,
                    stage: row.try_get("stage")?,
                    changed_ms: row.try_get("changed_ms")?,
                })
            })
            .collect()
    }

    pub async fn remove_upload(&self, study_id: &str, now_ms: i64) -> Result<(), StorageError> {
        sqlx::query("UPDATE uploaded_studies SET removed_ms = $2 WHERE study_id = $1")
            .bind(study_id)
            .bind(now_ms)
            .execute(&self.writers)
            .await?;
        Ok(())
    }
}

type DbRow = <Db as sqlx::Database>::Row;

fn account(row: &DbRow) -> Result<Account, StorageError> {
    Ok(Account {
        key: row.try_get("account_key")?,
        email: row.try_get("email")?,
        role: role("accounts", row.try_get("role")?)?,
        password_hash: row.try_get("password_hash")?,
        created_ms: row.try_get("created_ms")?,
        disabled_ms: row.try_get("disabled_ms")?,
    })
}

fn account_link(row: &DbRow) -> Result<AccountLink, StorageError> {
    let purpose: String = row.try_get("purpose")?;
    Ok(AccountLink {
        purpose: LinkPurpose::from_word(&purpose).ok_or_else(|| StorageError::Damaged {
            table: "account_links",
            problem: format!("purpose {purpose}"),
        })?,
        email: row.try_get("email")?,
        role: role("account_links", row.try_get("role")?)?,
        expires_ms: row.try_get("expires_ms")?,
    })
}

fn role(table: &'static str, word: String) -> Result<Role, StorageError> {
    Role::from_word(&word)
        .ok_or_else(|| StorageError::Damaged { table, problem: format!("role {word}") })
}
