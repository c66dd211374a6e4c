//! Changes of a session: each resolves after its transaction is committed.

use mimique_session::SessionLimits;
use mimique_session::wire::Event;

use super::append::Append;
use super::change::{Change, Outcome};
use super::erase::Holder;
use super::start::may_start;
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{Appended, Completed, NewSession, SessionRecord, Withdrawal, WrittenEvent};

impl Storage {
    /// Starts a session, or finds the one started with the same token.
    pub async fn start(&self, session: NewSession) -> Result<SessionRecord, StorageError> {
        let route = session.token_hash.clone();
        match self.writer.commit(&route, Change::Start(Box::new(session))).await? {
            Outcome::Started(record) => Ok(*record),
            _ => Err(StorageError::Stopping),
        }
    }

    /// Whether a session could be started now; nothing is written.
    pub async fn may_start(&self, session: &NewSession) -> Result<(), StorageError> {
        let mut transaction = self.readers.begin_snapshot().await?;
        let answer = may_start(&mut transaction, session).await;
        transaction.rollback().await?;
        answer
    }

    /// Appends events; resolves after they are committed.
    pub async fn append(
        &self,
        token_hash: &str,
        events: Vec<Event>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        let events = events.into_iter().map(WrittenEvent::from).collect();
        self.append_written(token_hash, events, None, now_ms).await
    }

    /// Appends events whose text is made already, to a session of which so much is kept.
    pub async fn append_written(
        &self,
        token_hash: &str,
        events: Vec<WrittenEvent>,
        limits: Option<SessionLimits>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        let append = Append { token_hash: token_hash.to_owned(), events, limits, now_ms };
        let change = Change::Append(append);
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

    /// Deletes a session's events and identifiers and keeps its number: at the wish of its page.
    pub async fn withdraw(
        &self,
        token_hash: &str,
        withdrawal_hash: &str,
        now_ms: i64,
    ) -> Result<Withdrawal, StorageError> {
        let holder = Holder::Page { token_hash: token_hash.to_owned() };
        self.withdraw_as(token_hash, holder, withdrawal_hash, now_ms).await
    }

    /// The same by the code alone, of one study or of any. `who` has brought it, for the log.
    pub async fn withdraw_by_code(
        &self,
        study_id: Option<&str>,
        withdrawal_hash: &str,
        who: &str,
        now_ms: i64,
    ) -> Result<Withdrawal, StorageError> {
        let holder = Holder::Code { study_id: study_id.map(str::to_owned), who: who.to_owned() };
        self.withdraw_as(withdrawal_hash, holder, withdrawal_hash, now_ms).await
    }

    async fn withdraw_as(
        &self,
        route: &str,
        holder: Holder,
        withdrawal_hash: &str,
        now_ms: i64,
    ) -> Result<Withdrawal, StorageError> {
        let withdrawal_hash = withdrawal_hash.to_owned();
        let change = Change::Withdraw { holder, withdrawal_hash, now_ms };
        match self.writer.commit(route, change).await? {
            Outcome::Withdrawn(withdrawal) => {
                self.wiper.wipe().await;
                Ok(withdrawal)
            }
            _ => Err(StorageError::Stopping),
        }
    }
}
