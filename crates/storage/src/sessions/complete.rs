//! The end of a session: every event is there, and the receipt says so.

use futures_util::stream::StreamExt as _;

use super::find::open_session;
use super::gaps::missing_between;
use super::receipt::ReceiptHasher;
use crate::database::{Transaction, query, signed};
use crate::error::StorageError;
use crate::records::{Completed, SessionRecord};

/// Completes a session, or finds the receipt that it has already.
pub(super) async fn complete(
    transaction: &mut Transaction,
    token_hash: &str,
    events: u64,
    receipt_key: &[u8],
    now_ms: i64,
) -> Result<Completed, StorageError> {
    let session = open_session(transaction, token_hash).await?;
    if let Some((receipt, stored)) = session.receipt {
        return Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored });
    }
    if events > session.first_gap {
        let range = session.first_gap..events;
        let missing = missing_between(transaction, session.key, range).await?;
        return Err(StorageError::MissingEvents { missing });
    }
    let receipt = receipt(transaction, &session, events, receipt_key).await?;
    query(
        "UPDATE sessions SET ended_ms = $1, receipt = $2, receipt_events = $3 \
         WHERE session_key = $4",
    )
    .bind(now_ms)
    .bind(&receipt)
    .bind(signed(events))
    .bind(session.key)
    .execute(transaction)
    .await?;
    Ok(Completed { key: session.key, study_id: session.study_id, receipt, stored: events })
}

/// The receipt over the first events of a session, one of which is in memory at a time.
async fn receipt(
    transaction: &mut Transaction,
    session: &SessionRecord,
    events: u64,
    receipt_key: &[u8],
) -> Result<String, StorageError> {
    let mut hasher = ReceiptHasher::new(receipt_key, &session.study_id, session.participant);
    let mut rows = query(
        "SELECT sequence, at_ms, body FROM events WHERE session_key = $1 AND sequence < $2 \
         ORDER BY sequence",
    )
    .bind(session.key)
    .bind(signed(events))
    .stream(transaction);
    while let Some(row) = rows.next().await {
        let row = row?;
        let body: String = row.get("body")?;
        hasher.add(row.unsigned("events", "sequence")?, row.get("at_ms")?, &body);
    }
    Ok(hasher.finish())
}
