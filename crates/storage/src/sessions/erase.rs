//! Deleting: a participant withdraws, asks for it by letter, or the answers' time is over. The
//! session's row stays, empty, so that its number is never given again and backups know of it.

use mimique_session::Standing;
use sqlx::AssertSqlSafe;
use subtle::ConstantTimeEq;

use super::find::find_session;
use crate::database::{Transaction, query};
use crate::error::StorageError;
use crate::records::{Deletion, PERSONAL_TABLES, SessionRecord};

/// Deletes what a participant has answered who holds the withdrawal code; gives how many events.
pub(super) async fn withdraw(
    transaction: &mut Transaction,
    token_hash: &str,
    withdrawal_hash: &str,
    now_ms: i64,
) -> Result<u64, StorageError> {
    let session =
        find_session(transaction, token_hash).await?.ok_or(StorageError::UnknownSession)?;
    // In a time that does not tell where the two differ.
    if !bool::from(session.withdrawal_hash.as_bytes().ct_eq(withdrawal_hash.as_bytes())) {
        return Err(StorageError::WrongWithdrawalCode);
    }
    erase(transaction, &session, Cause::Wish, now_ms).await
}

/// Why answers are deleted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    /// The participant wished it.
    Wish,
    /// The time for which they may be kept is over.
    TimeOver,
}

impl Cause {
    /// The word in the list of deletions.
    fn word(self) -> &'static str {
        match self {
            Self::Wish => "withdrawn",
            Self::TimeOver => "erased",
        }
    }
}

/// Deletes everything that hangs on a session and empties its row.
pub(super) async fn erase(
    transaction: &mut Transaction,
    session: &SessionRecord,
    cause: Cause,
    now_ms: i64,
) -> Result<u64, StorageError> {
    let mut deleted = 0;
    for table in PERSONAL_TABLES {
        let rows = query(AssertSqlSafe(format!("DELETE FROM {table} WHERE session_key = $1")))
            .bind(session.key)
            .execute(&mut *transaction)
            .await?;
        if table == "events" {
            deleted = rows;
        }
    }
    if !session.is_deleted() {
        // Who is deleted since the time is over keeps the standing and, having completed, the place.
        let (standing, expires_ms) = match cause {
            Cause::Wish => (Standing::Withdrawn, "CASE WHEN slot_given = 0 THEN 0 ELSE NULL END"),
            Cause::TimeOver => (session.standing, "NULL"),
        };
        query(AssertSqlSafe(format!(
            "UPDATE sessions SET status = $1, ended_ms = $2, deleted_ms = $2, client = '{{}}', \
             event_count = 0, next_sequence = 0, last_event_ms = NULL, receipt = NULL, \
             receipt_events = NULL, slot_expires_ms = {expires_ms} WHERE session_key = $3"
        )))
        .bind(standing.stored_word())
        .bind(now_ms)
        .bind(session.key)
        .execute(transaction)
        .await?;
    }
    Ok(deleted)
}

/// Deletes again what was deleted after a backup was made; a session that is not here was started
/// later.
pub(crate) async fn repeat_deletions(
    transaction: &mut Transaction,
    deletions: &[Deletion],
) -> Result<u64, StorageError> {
    let mut repeated = 0;
    for deletion in deletions {
        let Some(session) = find_session(transaction, &deletion.token_hash).await? else {
            continue;
        };
        let causes = [Cause::Wish, Cause::TimeOver];
        match causes.into_iter().find(|cause| cause.word() == deletion.what) {
            Some(cause) => {
                repeated += u64::from(!session.is_deleted());
                erase(transaction, &session, cause, deletion.at_ms).await?;
            }
            None => {
                for table in ["recruitment", "repeat_marks"] {
                    repeated +=
                        query(AssertSqlSafe(format!("DELETE FROM {table} WHERE session_key = $1")))
                            .bind(session.key)
                            .execute(&mut *transaction)
                            .await?;
                }
                query("UPDATE sessions SET identifiers_erased_ms = $1 WHERE session_key = $2")
                    .bind(deletion.at_ms)
                    .bind(session.key)
                    .execute(&mut *transaction)
                    .await?;
            }
        }
    }
    Ok(repeated)
}
