//! Appends: those that wait together are made together, by a handful of statements for all of them
//! instead of three for each. Each keeps its own answer.

use std::collections::{HashMap, HashSet};

use mimique_session::wire::Acknowledged;
use mimique_session::{Record, Standing};
use sha2::{Digest, Sha256};

use super::row::{SESSION_COLUMNS, event, session_record};
use crate::database::{Builder, Transaction, Value, query, signed};
use crate::error::{MOST_SEQUENCES_REPORTED, StorageError};
use crate::records::{Appended, SessionRecord, WrittenEvent};

/// Rows in one statement: one of these numbers.
const LENGTHS: [usize; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];
/// Rows in one statement at most.
const MOST_ROWS: usize = 96;

/// Events to append to one session.
pub(super) struct Append {
    pub token_hash: String,
    pub events: Vec<WrittenEvent>,
    pub now_ms: i64,
}

/// Makes the appends in their order; one answer each. The outer error means that none was made.
pub(super) async fn append_all(
    transaction: &mut Transaction,
    appends: &[&Append],
) -> Result<Vec<Result<Appended, StorageError>>, StorageError> {
    let mut sessions = lock_sessions(transaction, appends).await?;
    let mut inserted = insert(transaction, &sessions, appends).await?;
    let mut touched = Vec::new();
    let mut outcomes = Vec::with_capacity(appends.len());
    for append in appends {
        outcomes.push(match sessions.get_mut(&append.token_hash) {
            None => Err(StorageError::UnknownSession),
            Some(session) if session.is_deleted() => Err(StorageError::Withdrawn),
            Some(session) => {
                let before = session.event_count;
                let outcome = count_in(transaction, session, append, &mut inserted).await?;
                if session.event_count > before {
                    touched.push(&append.token_hash);
                    let ends = append.events.iter().any(|event| event.may_end);
                    if ends || !session.standing.is_open() {
                        stand(transaction, session).await?;
                    }
                }
                Ok(outcome)
            }
        });
    }
    touched.sort_unstable();
    touched.dedup();
    let touched: Vec<&SessionRecord> =
        touched.into_iter().filter_map(|token| sessions.get(token)).collect();
    update_sessions(transaction, &touched).await?;
    Ok(outcomes)
}

/// Lists cut into pieces of few different lengths, so that there are few statements to prepare. The
/// last piece is filled up with one of its items: what is done twice over must be as good as once.
fn pieces<T: Copy>(list: &[T], filler: impl Fn(&[T]) -> Option<T>) -> Vec<Vec<T>> {
    let fill = |piece: &[T]| {
        let length = LENGTHS.into_iter().find(|length| *length >= piece.len());
        let missing = length.unwrap_or(MOST_ROWS).saturating_sub(piece.len());
        let extra = filler(piece).into_iter().cycle().take(missing);
        piece.iter().copied().chain(extra).collect()
    };
    list.chunks(MOST_ROWS).map(fill).collect()
}

fn last<T: Copy>(piece: &[T]) -> Option<T> {
    piece.last().copied()
}

/// A row to insert: session key, event, time.
type NewRow<'a> = (i64, &'a WrittenEvent, i64);

/// Given twice, a row is inserted once: the same one, whichever the database takes first.
fn shortest<'a>(piece: &[NewRow<'a>]) -> Option<NewRow<'a>> {
    piece.iter().copied().min_by_key(|(_, event, _)| event.body.len())
}

/// The sessions by token hash, locked until the transaction ends. Always in the order of their keys,
/// so that two servers do not wait for each other.
async fn lock_sessions(
    transaction: &mut Transaction,
    appends: &[&Append],
) -> Result<HashMap<String, SessionRecord>, StorageError> {
    let mut tokens: Vec<&str> = appends.iter().map(|append| append.token_hash.as_str()).collect();
    tokens.sort_unstable();
    tokens.dedup();
    let mut sessions = HashMap::with_capacity(tokens.len());
    for piece in pieces(&tokens, last) {
        let mut select = Builder::new(format!(
            "SELECT token_hash, {SESSION_COLUMNS} FROM sessions WHERE token_hash IN ("
        ));
        select.push_list("{}", piece.into_iter().map(Value::from));
        select.push(") ORDER BY session_key");
        select.push(transaction.dialect().row_lock);
        for row in select.finish().fetch_all(&mut *transaction).await? {
            sessions.insert(row.get("token_hash")?, session_record(&row)?);
        }
    }
    Ok(sessions)
}

/// Inserts what is not stored yet; the session key and sequence of each new row.
async fn insert(
    transaction: &mut Transaction,
    sessions: &HashMap<String, SessionRecord>,
    appends: &[&Append],
) -> Result<HashSet<(i64, u64)>, StorageError> {
    let mut seen = HashSet::new();
    let mut rows = Vec::new();
    for append in appends {
        let Some(session) = sessions.get(&append.token_hash) else { continue };
        if session.is_deleted() {
            continue;
        }
        // The first of two under one sequence is tried; the other one is compared with it.
        for event in &append.events {
            if seen.insert((session.key, event.sequence)) {
                rows.push((session.key, event, append.now_ms));
            }
        }
    }
    let mut inserted = HashSet::with_capacity(rows.len());
    for piece in pieces(&rows, shortest) {
        let mut insert =
            Builder::new("INSERT INTO events (session_key, sequence, at_ms, received_ms, body) ");
        let rows = piece.into_iter().map(|(key, event, now_ms)| -> [Value<'_>; 5] {
            let sequence = signed(event.sequence);
            [key.into(), sequence.into(), event.at_ms.into(), now_ms.into(), (&event.body).into()]
        });
        insert.push_rows("{}", rows);
        insert.push(
            " ON CONFLICT (session_key, sequence) DO NOTHING RETURNING session_key, sequence",
        );
        for row in insert.finish().fetch_all(&mut *transaction).await? {
            inserted.insert((row.get("session_key")?, row.unsigned("events", "sequence")?));
        }
    }
    Ok(inserted)
}

/// Counts what was inserted of one append, keeps apart what differs from what is stored.
async fn count_in(
    transaction: &mut Transaction,
    session: &mut SessionRecord,
    append: &Append,
    inserted: &mut HashSet<(i64, u64)>,
) -> Result<Appended, StorageError> {
    let mut conflicts = Vec::new();
    let before = session.event_count;
    for event in &append.events {
        if inserted.remove(&(session.key, event.sequence)) {
            session.event_count += 1;
            session.next_sequence = session.next_sequence.max(event.sequence + 1);
        } else if !is_stored(transaction, session.key, event).await? {
            keep_apart(transaction, session.key, event, append.now_ms).await?;
            conflicts.push(event.sequence);
        }
    }
    if session.event_count > before {
        session.last_event_ms = Some(append.now_ms);
        if let Some(expires_ms) = renewed(session, append.now_ms) {
            session.slot_expires_ms = Some(expires_ms);
        }
    }
    let gaps = if session.event_count == session.next_sequence {
        Vec::new()
    } else {
        missing_below(transaction, session.key, session.next_sequence).await?
    };
    let stored = gaps.first().copied().unwrap_or(session.next_sequence);
    Ok(Appended { acknowledged: Acknowledged { stored, gaps }, conflicts })
}

/// Finds out anew how a session stands, from all of its events: rare, since few events can change it.
/// Who completed keeps the slot for good; whose session ended otherwise gives it back.
async fn stand(
    transaction: &mut Transaction,
    session: &mut SessionRecord,
) -> Result<(), StorageError> {
    let rows =
        query("SELECT sequence, at_ms, body FROM events WHERE session_key = $1 ORDER BY sequence")
            .bind(session.key)
            .fetch_all(&mut *transaction)
            .await?;
    let events: Vec<_> =
        rows.iter().map(|row| event(session.key, row)).collect::<Result<_, _>>()?;
    session.standing = Record::of(None, &events).standing;
    if session.standing == Standing::Completed {
        session.slot_expires_ms = None;
    } else if !session.standing.is_open() {
        session.slot_expires_ms = session.slot_expires_ms.map(|_| 0);
    }
    query("UPDATE sessions SET status = $1 WHERE session_key = $2")
        .bind(session.standing.stored_word())
        .bind(session.key)
        .execute(transaction)
        .await?;
    Ok(())
}

/// The end of the slot's reservation after a sign of life, where it is worth writing: in its second
/// half. A reservation that has run out is not renewed: the slot may be somebody else's already.
fn renewed(session: &SessionRecord, now_ms: i64) -> Option<i64> {
    let left = session.slot_expires_ms?.saturating_sub(now_ms);
    (left > 0 && left < session.slot_lasts_ms / 2).then(|| now_ms + session.slot_lasts_ms)
}

/// Writes what [`count_in`] has changed. The rows are locked: nobody else has changed them.
async fn update_sessions(
    transaction: &mut Transaction,
    sessions: &[&SessionRecord],
) -> Result<(), StorageError> {
    for piece in pieces(sessions, last) {
        let mut update = Builder::new(
            "UPDATE sessions SET event_count = fresh.column2, next_sequence = fresh.column3, \
             last_event_ms = fresh.column4, slot_expires_ms = fresh.column5 FROM (",
        );
        let rows = piece.into_iter().map(|session| -> [Value<'_>; 5] {
            [
                session.key.into(),
                signed(session.event_count).into(),
                signed(session.next_sequence).into(),
                session.last_event_ms.into(),
                session.slot_expires_ms.into(),
            ]
        });
        // PostgreSQL takes untyped parameters of a list for text.
        update.push_rows("CAST({} AS BIGINT)", rows);
        update.push(") AS fresh WHERE sessions.session_key = fresh.column1");
        update.finish().execute(&mut *transaction).await?;
    }
    Ok(())
}

/// Whether exactly this event is what is stored under its sequence.
async fn is_stored(
    transaction: &mut Transaction,
    session_key: i64,
    event: &WrittenEvent,
) -> Result<bool, StorageError> {
    let row = query("SELECT at_ms, body FROM events WHERE session_key = $1 AND sequence = $2")
        .bind(session_key)
        .bind(signed(event.sequence))
        .fetch_one(transaction)
        .await?;
    let stored_at: f64 = row.get("at_ms")?;
    let stored_body: String = row.get("body")?;
    Ok(stored_at == event.at_ms && stored_body == event.body)
}

/// Keeps a second body of a stored sequence beside the responses.
async fn keep_apart(
    transaction: &mut Transaction,
    session_key: i64,
    event: &WrittenEvent,
    now_ms: i64,
) -> Result<(), StorageError> {
    let digest = hex::encode(Sha256::digest(format!("{} {}", event.at_ms, event.body)));
    query(
        "INSERT INTO event_conflicts (session_key, sequence, digest, at_ms, received_ms, body) \
         VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT DO NOTHING",
    )
    .bind(session_key)
    .bind(signed(event.sequence))
    .bind(&digest)
    .bind(event.at_ms)
    .bind(now_ms)
    .bind(&event.body)
    .execute(transaction)
    .await?;
    Ok(())
}

/// The sequences in `0..end` that are not stored, at most [`MOST_SEQUENCES_REPORTED`].
pub(super) async fn missing_below(
    transaction: &mut Transaction,
    session_key: i64,
    end: u64,
) -> Result<Vec<u64>, StorageError> {
    let rows = query(
        "SELECT sequence FROM events WHERE session_key = $1 AND sequence < $2 ORDER BY sequence",
    )
    .bind(session_key)
    .bind(signed(end))
    .fetch_all(transaction)
    .await?;
    let mut missing = Vec::new();
    let mut expected = 0;
    for row in &rows {
        let sequence = row.unsigned("events", "sequence")?;
        let room = MOST_SEQUENCES_REPORTED - missing.len();
        missing.extend((expected..sequence).take(room));
        expected = sequence + 1;
    }
    let room = MOST_SEQUENCES_REPORTED - missing.len();
    missing.extend((expected..end).take(room));
    Ok(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_cut_into_few_lengths() {
        let list: Vec<u32> = (0..300).collect();
        let lengths = |n: usize| {
            let pieces = pieces(&list[..n], |piece| piece.iter().copied().min());
            pieces.iter().map(Vec::len).collect::<Vec<_>>()
        };
        assert!(lengths(0).is_empty());
        for (items, expected) in [
            (1, vec![1]),
            (5, vec![6]),
            (96, vec![96]),
            (97, vec![96, 1]),
            (300, vec![96, 96, 96, 12]),
        ] {
            assert_eq!(lengths(items), expected, "{items} items");
        }
        assert_eq!(
            pieces(&[7, 3, 5, 4, 9], |piece| piece.iter().copied().min()),
            [[7, 3, 5, 4, 9, 3]]
        );
        assert_eq!(LENGTHS.last(), Some(&MOST_ROWS));
    }
}
