//! Rows of accounts and links.

use super::records::{Account, AccountLink, LinkPurpose, Role};
use crate::database::Row;
use crate::error::StorageError;

pub(super) fn account(row: &Row) -> Result<Account, StorageError> {
    Ok(Account {
        key: row.get("account_key")?,
        email: row.get("email")?,
        role: role("accounts", row.get("role")?)?,
        password_hash: row.get("password_hash")?,
        created_ms: row.get("created_ms")?,
        disabled_ms: row.get("disabled_ms")?,
    })
}

pub(super) fn account_link(row: &Row) -> Result<AccountLink, StorageError> {
    let purpose: String = row.get("purpose")?;
    Ok(AccountLink {
        purpose: LinkPurpose::from_word(&purpose).ok_or_else(|| StorageError::Damaged {
            table: "account_links",
            problem: format!("purpose {purpose}"),
        })?,
        email: row.get("email")?,
        role: role("account_links", row.get("role")?)?,
        study_id: Some(row.get("study_id")?).filter(|id: &String| !id.is_empty()),
        expires_ms: row.get("expires_ms")?,
    })
}

pub(super) fn role(table: &'static str, word: String) -> Result<Role, StorageError> {
    Role::from_word(&word)
        .ok_or_else(|| StorageError::Damaged { table, problem: format!("role {word}") })
}
