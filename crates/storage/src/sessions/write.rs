//! Changes of a session: each resolves after its transaction is committed.

use mimique_session::wire::Event;

use super::append::Append;
use super::change::{Change, Outcome};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{Appended, Completed, NewSession, SessionRecord, WrittenEvent};

impl Storage {
    /// Starts a session, or finds the one started with the same token.
    pub async fn start(&self, session: NewSession) -> Result<SessionRecord, StorageError> {
        let route = session.token_hash.clone();
        match self.writer.commit(&route, Change::Start(Box::new(session))).await? {
            Outcome::Started(record) => Ok(*record),
            _ => Err(StorageError::Stopping),
        }
    }

    /// Appends events; resolves after they are committed.
    pub async fn append(
        &self,
        token_hash: &str,
        events: Vec<Event>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        let events = events.into_iter().map(WrittenEvent::from).collect();
        self.append_written(token_hash, events, now_ms).await
    }

    /// Appends events whose text is made already.
    pub async fn append_written(
        &self,
        token_hash: &str,
        events: Vec<WrittenEvent>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        let change = Change::Append(Append { token_hash: token_hash.to_owned(), events, now_ms });
        match self.writer.commit(token_hash, change).await? {
            Outcome::Appended(appended) => Ok(appended),
            _ => Err(StorageError::Stopping),
        }
    }

    /// Completes a session of which events `0..events` must all be stored; the receipt is keyed
    /// with `receipt_key`. Repeating it gives the first receipt again.
    pub async fn complete(
        &self,
        token_hash: &str,
        events: u64,
        receipt_key: &[u8],
        now_ms: i64,
    ) -> Result<Completed, StorageError> {
        let change = Change::Complete {
            token_hash: token_hash.to_owned(),
            events,
            receipt_key: receipt_key.to_owned(),
            now_ms,
        };
        match self.writer.commit(token_hash, change).await? {
            Outcome::Completed(completed) => Ok(completed),
            _ => Err(StorageError::Stopping),
        }
    }

    /// Deletes a session's events and identifiers and keeps its number; returns how many events
    /// were deleted.
    pub async fn withdraw(
        &self,
        token_hash: &str,
        withdrawal_hash: &str,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let change = Change::Withdraw {
            token_hash: token_hash.to_owned(),
            withdrawal_hash: withdrawal_hash.to_owned(),
            now_ms,
        };
        match self.writer.commit(token_hash, change).await? {
            Outcome::Withdrawn { deleted } => Ok(deleted),
            _ => Err(StorageError::Stopping),
        }
    }
}
