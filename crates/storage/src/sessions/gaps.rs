//! Gaps among the stored events of a session: the first of them is a column of its row, and however many
//! there are, a request looks at a bounded part of what is stored behind it.

use std::ops::Range;

use crate::database::{Transaction, query, signed};
use crate::error::{MOST_SEQUENCES_REPORTED, StorageError};
use crate::records::SessionRecord;

/// Stored sequences that are looked at for gaps at one time: everybody waits for the writer meanwhile.
const MOST_LOOKED_AT: usize = 1000;

/// The lowest sequence that is not stored, from the one that was it until now and is stored. What is
/// passed over once is never read again.
pub(super) async fn first_gap(
    transaction: &mut Transaction,
    session: &SessionRecord,
) -> Result<u64, StorageError> {
    if session.event_count == session.next_sequence {
        return Ok(session.next_sequence);
    }
    let mut expected = session.first_gap;
    loop {
        let rows =
            stored_between(transaction, session.key, expected..session.next_sequence).await?;
        for sequence in &rows {
            if *sequence != expected {
                return Ok(expected);
            }
            expected += 1;
        }
        if rows.len() < MOST_LOOKED_AT {
            return Ok(expected);
        }
    }
}

/// The sequences of a range that are not stored, at most [`MOST_SEQUENCES_REPORTED`], and only those
/// below the last of the first [`MOST_LOOKED_AT`] that are: the page sends them and is told of more.
pub(super) async fn missing_between(
    transaction: &mut Transaction,
    session_key: i64,
    range: Range<u64>,
) -> Result<Vec<u64>, StorageError> {
    if range.is_empty() {
        return Ok(Vec::new());
    }
    let rows = stored_between(transaction, session_key, range.clone()).await?;
    let mut missing = Vec::new();
    let mut expected = range.start;
    for sequence in &rows {
        let room = MOST_SEQUENCES_REPORTED - missing.len();
        missing.extend((expected..*sequence).take(room));
        expected = sequence + 1;
    }
    if rows.len() < MOST_LOOKED_AT {
        let room = MOST_SEQUENCES_REPORTED - missing.len();
        missing.extend((expected..range.end).take(room));
    }
    Ok(missing)
}

/// Sequences of a range that are stored, the first [`MOST_LOOKED_AT`] of them.
async fn stored_between(
    transaction: &mut Transaction,
    session_key: i64,
    range: Range<u64>,
) -> Result<Vec<u64>, StorageError> {
    let rows = query(
        "SELECT sequence FROM events WHERE session_key = $1 AND sequence >= $2 AND sequence < $3 \
         ORDER BY sequence LIMIT $4",
    )
    .bind(session_key)
    .bind(signed(range.start))
    .bind(signed(range.end))
    .bind(MOST_LOOKED_AT as i64)
    .fetch_all(transaction)
    .await?;
    rows.iter().map(|row| row.unsigned("events", "sequence")).collect()
}
