//! Deleting: a participant withdraws, asks for it by letter, or the answers' time is over. The
//! session's row stays, empty, so that its number is never given again and backups know of it.

use mimique_session::Standing;
use sqlx::AssertSqlSafe;
use subtle::ConstantTimeEq;

use super::find::{find_by_code, find_session};
use crate::accounts::records::AuditEntry;
use crate::database::{Transaction, query};
use crate::decisions::insert_entry;
use crate::error::StorageError;
use crate::records::{Deletion, PERSONAL_TABLES, SessionRecord, Withdrawal, participant_id};

/// Who holds a withdrawal code.
pub(super) enum Holder {
    /// The session's own page.
    Page { token_hash: String },
    /// Somebody who brings the code alone, to one study or to any.
    Code { study_id: Option<String>, who: String },
}

/// Deletes what a participant has answered who holds the withdrawal code.
pub(super) async fn withdraw(
    transaction: &mut Transaction,
    holder: &Holder,
    withdrawal_hash: &str,
    now_ms: i64,
) -> Result<Withdrawal, StorageError> {
    let (session, who) = match holder {
        Holder::Page { token_hash } => {
            let session = find_session(transaction, token_hash).await?;
            let session = session.ok_or(StorageError::UnknownSession)?;
            // In a time that does not tell where the two differ.
            if !bool::from(session.withdrawal_hash.as_bytes().ct_eq(withdrawal_hash.as_bytes())) {
                return Err(StorageError::WrongWithdrawalCode);
            }
            (session, PARTICIPANT)
        }
        Holder::Code { study_id, who } => {
            let session = find_by_code(transaction, study_id.as_deref(), withdrawal_hash).await?;
            (session.ok_or(StorageError::UnknownWithdrawalCode)?, who.as_str())
        }
    };
    let by = By { who, action: "withdraw" };
    let deleted = erase(transaction, &session, Cause::Wish, by, now_ms).await?;
    Ok(Withdrawal { study_id: session.study_id, participant: session.participant, deleted })
}

/// The participant in the log: whoever holds the code, by whatever way.
pub(super) const PARTICIPANT: &str = "(participant)";

/// The command line and the server itself, in the log.
pub(super) const SERVER: &str = "(server)";

/// Who deletes, and what the log calls it.
#[derive(Debug, Clone, Copy)]
pub(super) struct By<'a> {
    pub who: &'a str,
    pub action: &'a str,
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
    by: By<'_>,
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
             event_count = 0, next_sequence = 0, first_gap = 0, stored_bytes = 0, last_event_ms = NULL, receipt = NULL, \
             receipt_events = NULL, overdue_ms = NULL, slot_expires_ms = {expires_ms} WHERE session_key = $3"
        )))
        .bind(standing.stored_word())
        .bind(now_ms)
        .bind(session.key)
        .execute(&mut *transaction)
        .await?;
        log(transaction, session, by, now_ms).await?;
    }
    Ok(deleted)
}

/// A line of the log: in the transaction of the deletion, so that neither is without the other.
async fn log(
    transaction: &mut Transaction,
    session: &SessionRecord,
    by: By<'_>,
    now_ms: i64,
) -> Result<(), StorageError> {
    let entry = AuditEntry {
        key: 0,
        at_ms: now_ms,
        who: by.who.to_owned(),
        action: by.action.to_owned(),
        study_id: session.study_id.clone(),
        subject: participant_id(session.participant),
    };
    insert_entry(transaction, &entry).await
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
                let by = By { who: SERVER, action: "delete again after a restoration" };
                erase(transaction, &session, cause, by, deletion.at_ms).await?;
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
