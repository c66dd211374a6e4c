//! A session, found and locked inside the writer's transaction.

use sqlx::AssertSqlSafe;

use super::row::{SESSION_COLUMNS, session_record};
use crate::database::{Transaction, query};
use crate::error::StorageError;
use crate::records::SessionRecord;

/// The session, locked until the transaction ends.
pub(super) async fn find_session(
    transaction: &mut Transaction,
    token_hash: &str,
) -> Result<Option<SessionRecord>, StorageError> {
    let lock = transaction.dialect().row_lock;
    let row = query(AssertSqlSafe(format!(
        "SELECT {SESSION_COLUMNS} FROM sessions WHERE token_hash = $1{lock}"
    )))
    .bind(token_hash)
    .fetch_optional(transaction)
    .await?;
    row.as_ref().map(session_record).transpose()
}

/// The session with this withdrawal code, of one study or of any, locked until the transaction ends.
pub(super) async fn find_by_code(
    transaction: &mut Transaction,
    study_id: Option<&str>,
    withdrawal_hash: &str,
) -> Result<Option<SessionRecord>, StorageError> {
    let lock = transaction.dialect().row_lock;
    let row = query(AssertSqlSafe(format!(
        "SELECT {SESSION_COLUMNS} FROM sessions WHERE withdrawal_hash = $1 \
         AND ($2 = '' OR study_id = $2) ORDER BY session_key LIMIT 1{lock}"
    )))
    .bind(withdrawal_hash)
    .bind(study_id.unwrap_or_default())
    .fetch_optional(transaction)
    .await?;
    row.as_ref().map(session_record).transpose()
}

/// The session, if it still takes events.
pub(super) async fn open_session(
    transaction: &mut Transaction,
    token_hash: &str,
) -> Result<SessionRecord, StorageError> {
    match find_session(transaction, token_hash).await? {
        None => Err(StorageError::UnknownSession),
        Some(session) if session.is_deleted() => Err(StorageError::Withdrawn),
        Some(session) => Ok(session),
    }
}
