//! What a change does inside the writer's transaction. A change that is refused has written nothing.
//! Starting is in `enrol.rs`, appending in `appends.rs`, deleting in `erase.rs`.

use sqlx::{AssertSqlSafe, Row};

use super::super::super::StorageError;
use super::super::super::records::{Appended, Completed, NewSession, SessionRecord};
use super::super::{Connection, FOR_UPDATE};
use super::appends::{Append, append_all, missing_below};
use super::enrol::start;
use super::erase::withdraw;
use super::{SESSION_COLUMNS, session_record, signed, unsigned};
use crate::receipt::ReceiptHasher;

/// A change to make.
pub(super) enum Change {
    Start(Box<NewSession>),
    Append(Append),
    Complete { token_hash: String, events: u64, receipt_key: Vec<u8>, now_ms: i64 },
    Withdraw { token_hash: String, withdrawal_hash: String, now_ms: i64 },
}

impl Change {
    /// The append, if it is one.
    pub fn append(&self) -> Option<&Append> {
        match self {
            Self::Append(append) => Some(append),
            _ => None,
        }
    }
}

/// What a change did.
pub(super) enum Outcome {
    Started(Box<SessionRecord>),
    Appended(Appended),
    Completed(Completed),
    Withdrawn { deleted: u64 },
}

pub(super) async fn apply(
    connection: &mut Connection,
    change: &Change,
) -> Result<Outcome, StorageError> {
    match change {
        Change::Start(session) => {
            start(connection, session).await.map(Box::new).map(Outcome::Started)
        }
        Change::Append(append) => {
            let mut outcomes = append_all(connection, &[append]).await?;
            outcomes.pop().unwrap_or(Err(StorageError::Stopping)).map(Outcome::Appended)
        }
        Change::Complete { token_hash, events, receipt_key, now_ms } => {
            complete(connection, token_hash, *events, receipt_key, *now_ms)
                .await
                .map(Outcome::Completed)
        }
        Change::Withdraw { token_hash, withdrawal_hash, now_ms } => {
            let deleted = withdraw(connection, token_hash, withdrawal_hash, *now_ms).await?;
            Ok(Outcome::Withdrawn { deleted })
        }
    }
}

async fn complete(
    connection: &mut Connection,
    token_hash: &str,
    events: u64,
    receipt_key: &[u8],
    now_ms: i64,
) -> Result<Completed, StorageError> {
    let session = open_session(connection, token_hash).await?;
    if let Some((receipt, stored)) = session.receipt {
        return Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored });
    }
    // An unbroken prefix needs no search; otherwise the gaps and the unseen end are missing.
    let unbroken = session.event_count == session.next_sequence && events <= session.event_count;
    if !unbroken {
        let missing = missing_below(connection, session.key, events).await?;
        if !missing.is_empty() {
            return Err(StorageError::MissingEvents { missing });
        }
    }
    let mut hasher = ReceiptHasher::new(receipt_key, &session.study_id, session.participant);
    let rows = sqlx::query(
        "SELECT sequence, at_ms, body FROM events WHERE session_key = $1 AND sequence < $2 \
         ORDER BY sequence",
    )
    .bind(session.key)
    .bind(signed(events))
    .fetch_all(&mut *connection)
    .await?;
    let mut finished = false;
    for row in &rows {
        let body: String = row.try_get("body")?;
        let sequence = unsigned("events", row.try_get("sequence")?)?;
        finished |= is_the_end(&body);
        hasher.add(sequence, row.try_get("at_ms")?, &body);
    }
    let receipt = hasher.finish();
    sqlx::query(
        "UPDATE sessions SET status = 'completed', ended_ms = $1, receipt = $2, \
         receipt_events = $3, finished = $4, \
         slot_expires_ms = CASE WHEN $4 = 0 AND slot_given = 0 THEN 0 ELSE NULL END \
         WHERE session_key = $5",
    )
    .bind(now_ms)
    .bind(&receipt)
    .bind(signed(events))
    .bind(i64::from(finished))
    .bind(session.key)
    .execute(connection)
    .await?;
    Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored: events })
}

/// Whether this event says that every step is done.
fn is_the_end(body: &str) -> bool {
    #[derive(serde::Deserialize)]
    struct Kind<'a> {
        #[serde(borrow, rename = "type")]
        kind: Option<std::borrow::Cow<'a, str>>,
    }
    body.contains("finished")
        && serde_json::from_str::<Kind<'_>>(body)
            .is_ok_and(|event| event.kind.as_deref() == Some("finished"))
}

/// The session, locked until the transaction ends.
pub(super) async fn find_session(
    connection: &mut Connection,
    token_hash: &str,
) -> Result<Option<SessionRecord>, StorageError> {
    let row = sqlx::query(AssertSqlSafe(format!(
        "SELECT {SESSION_COLUMNS} FROM sessions WHERE token_hash = $1{FOR_UPDATE}"
    )))
    .bind(token_hash)
    .fetch_optional(connection)
    .await?;
    row.as_ref().map(session_record).transpose()
}

/// The session, if it still takes events.
async fn open_session(
    connection: &mut Connection,
    token_hash: &str,
) -> Result<SessionRecord, StorageError> {
    match find_session(connection, token_hash).await? {
        None => Err(StorageError::UnknownSession),
        Some(session) if session.status.is_deleted() => Err(StorageError::Withdrawn),
        Some(session) => Ok(session),
    }
}
