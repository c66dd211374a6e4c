//! Appends: those that wait together are made together, by a handful of statements for all of them
//! instead of three for each. Each keeps its own answer.

use std::collections::{HashMap, HashSet};

use futures_util::stream::StreamExt as _;
use mimique_session::wire::Acknowledged;
use mimique_session::{Misfit, SessionLimits, Standing};
use sha2::{Digest, Sha256};

use super::gaps::{first_gap, missing_between};
use super::row::{
    COUNTED_WITHOUT_PLAYS, SESSION_COLUMNS, counted_event, record_of, session_record,
};
use crate::database::{Builder, Transaction, Value, query, signed};
use crate::error::StorageError;
use crate::records::{Appended, SessionRecord, WrittenEvent};

/// Rows in one statement: one of these numbers.
const LENGTHS: [usize; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96];
/// Rows in one statement at most.
const MOST_ROWS: usize = 96;

/// Events to append to one session.
pub(super) struct Append {
    pub token_hash: String,
    pub events: Vec<WrittenEvent>,
    /// How much of the session is kept; no bound where its study is not known.
    pub limits: Option<SessionLimits>,
    pub now_ms: i64,
}

impl Append {
    /// Whether it would be more than is kept of a session.
    fn is_beyond(&self, session: &SessionRecord) -> bool {
        let bytes: u64 = self.events.iter().map(|event| event.body.len() as u64).sum();
        self.limits.is_some_and(|limits| {
            session.event_count + self.events.len() as u64 > limits.events
                || session.stored_bytes + bytes > limits.bytes
        })
    }
}

/// Bodies kept beside those that are stored under their sequence, of one session.
const MOST_CONFLICTS: i64 = 100;

/// Makes the appends in their order; one answer each. The outer error means that none was made.
pub(super) async fn append_all(
    transaction: &mut Transaction,
    appends: &[&Append],
) -> Result<Vec<Result<Appended, StorageError>>, StorageError> {
    let mut sessions = lock_sessions(transaction, appends).await?;
    // Found out before anything is counted, so that nothing is inserted that is not counted.
    let is_beyond = |append: &&Append| {
        sessions.get(&append.token_hash).is_some_and(|session| append.is_beyond(session))
    };
    let beyond: Vec<bool> = appends.iter().map(is_beyond).collect();
    let mut inserted = insert(transaction, &sessions, appends, &beyond).await?;
    let mut touched = Vec::new();
    let mut outcomes = Vec::with_capacity(appends.len());
    for (append, is_beyond) in appends.iter().zip(beyond) {
        outcomes.push(match sessions.get_mut(&append.token_hash) {
            None => Err(StorageError::UnknownSession),
            Some(session) if session.is_deleted() => Err(StorageError::Withdrawn),
            Some(_) if is_beyond => Err(StorageError::SessionFull),
            Some(session) => {
                let (before, bytes) = (session.event_count, session.stored_bytes);
                let outcome = count_in(transaction, session, append, &mut inserted).await?;
                if session.stored_bytes > bytes {
                    touched.push(&append.token_hash);
                }
                if session.event_count > before {
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
    beyond: &[bool],
) -> Result<HashSet<(i64, u64)>, StorageError> {
    let mut seen = HashSet::new();
    let mut rows = Vec::new();
    for (append, is_beyond) in appends.iter().zip(beyond) {
        let Some(session) = sessions.get(&append.token_hash) else { continue };
        if session.is_deleted() || *is_beyond {
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
        let mut insert = Builder::new(
            "INSERT INTO events (session_key, sequence, at_ms, received_ms, body, misfit) ",
        );
        let rows = piece.into_iter().map(|(key, event, now_ms)| -> [Value<'_>; 6] {
            let sequence = signed(event.sequence);
            let misfit = Value::Text(event.misfit.map(Misfit::word));
            let (at_ms, body) = (event.at_ms.into(), (&event.body).into());
            [key.into(), sequence.into(), at_ms, now_ms.into(), body, misfit]
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
    let (mut filled, mut is_first_sign) = (false, false);
    for event in &append.events {
        if inserted.remove(&(session.key, event.sequence)) {
            // Anybody can send anything: only what a page can send shows that one is there.
            is_first_sign |= session.last_event_ms.is_none() && event.misfit.is_none();
            session.event_count += 1;
            session.stored_bytes += event.body.len() as u64;
            session.next_sequence = session.next_sequence.max(event.sequence + 1);
            filled |= event.sequence == session.first_gap;
        } else if !is_stored(transaction, session.key, event).await? {
            if keep_apart(transaction, session.key, event, append.now_ms).await? {
                session.stored_bytes += event.body.len() as u64;
            }
            conflicts.push(event.sequence);
        }
    }
    if filled {
        session.first_gap = first_gap(transaction, session).await?;
    }
    if session.event_count > before && (is_first_sign || session.last_event_ms.is_some()) {
        session.last_event_ms = Some(append.now_ms);
        if let Some(expires_ms) = renewed(session, append.now_ms, is_first_sign) {
            session.slot_expires_ms = Some(expires_ms);
        }
    }
    let (first, end) = (session.first_gap, session.next_sequence);
    let gaps = missing_between(transaction, session.key, first..end).await?;
    let stored = session.first_gap;
    Ok(Appended { acknowledged: Acknowledged { stored, gaps }, conflicts })
}

/// Finds out anew how a session stands, from all of its events: rare, since few events can change it.
/// Who completed keeps the slot for good; whose session ended otherwise gives it back.
async fn stand(
    transaction: &mut Transaction,
    session: &mut SessionRecord,
) -> Result<(), StorageError> {
    let (key, end) = (session.key, signed(session.next_sequence));
    let rows = query(COUNTED_WITHOUT_PLAYS).bind(key).bind(end).stream(transaction);
    let record = record_of(rows.map(move |row| counted_event(key, &row?))).await?;
    session.standing = record.standing;
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
/// half. A reservation that has run out is not renewed: the slot may be somebody else's already. The first sign
/// of life begins it, however late it comes, unless somebody else has the slot.
fn renewed(session: &SessionRecord, now_ms: i64, is_first_sign: bool) -> Option<i64> {
    let left = session.slot_expires_ms?.saturating_sub(now_ms);
    let is_due = is_first_sign || (left > 0 && left < session.slot_lasts_ms / 2);
    is_due.then(|| now_ms + session.slot_lasts_ms)
}

/// Writes what [`count_in`] has changed. The rows are locked: nobody else has changed them.
async fn update_sessions(
    transaction: &mut Transaction,
    sessions: &[&SessionRecord],
) -> Result<(), StorageError> {
    for piece in pieces(sessions, last) {
        let mut update = Builder::new(
            "UPDATE sessions SET event_count = fresh.column2, next_sequence = fresh.column3, \
             last_event_ms = fresh.column4, slot_expires_ms = fresh.column5, \
             first_gap = fresh.column6, stored_bytes = fresh.column7 FROM (",
        );
        let rows = piece.into_iter().map(|session| -> [Value<'_>; 7] {
            [
                session.key.into(),
                signed(session.event_count).into(),
                signed(session.next_sequence).into(),
                session.last_event_ms.into(),
                session.slot_expires_ms.into(),
                signed(session.first_gap).into(),
                signed(session.stored_bytes).into(),
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

/// Keeps a second body of a stored sequence beside the responses; whether it is kept, since it was not
/// there and there are not too many yet.
async fn keep_apart(
    transaction: &mut Transaction,
    session_key: i64,
    event: &WrittenEvent,
    now_ms: i64,
) -> Result<bool, StorageError> {
    let digest = hex::encode(Sha256::digest(format!("{} {}", event.at_ms, event.body)));
    let kept = query(
        "INSERT INTO event_conflicts (session_key, sequence, digest, at_ms, received_ms, body) \
         SELECT CAST($1 AS BIGINT), CAST($2 AS BIGINT), $3, CAST($4 AS DOUBLE PRECISION), \
         CAST($5 AS BIGINT), $6 \
         WHERE (SELECT COUNT(*) FROM event_conflicts WHERE session_key = $1) < $7 \
         ON CONFLICT DO NOTHING",
    )
    .bind(session_key)
    .bind(signed(event.sequence))
    .bind(&digest)
    .bind(event.at_ms)
    .bind(now_ms)
    .bind(&event.body)
    .bind(MOST_CONFLICTS)
    .execute(transaction)
    .await?;
    Ok(kept > 0)
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
