//! What a change does inside the writer's transaction. A change that is refused has written nothing.

use super::append::{Append, append_all};
use super::complete::complete;
use super::erase::{Holder, withdraw};
use super::start::start;
use crate::database::Transaction;
use crate::error::StorageError;
use crate::records::{Appended, Completed, NewSession, SessionRecord, Withdrawal};

/// A change to make.
pub(super) enum Change {
    Start(Box<NewSession>),
    Append(Append),
    Complete { token_hash: String, events: u64, receipt_key: Vec<u8>, now_ms: i64 },
    Withdraw { holder: Holder, withdrawal_hash: String, now_ms: i64 },
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
    Withdrawn(Withdrawal),
}

pub(super) async fn apply(
    transaction: &mut Transaction,
    change: &Change,
) -> Result<Outcome, StorageError> {
    match change {
        Change::Start(session) => {
            start(transaction, session).await.map(Box::new).map(Outcome::Started)
        }
        Change::Append(append) => {
            let mut outcomes = append_all(transaction, &[append]).await?;
            outcomes.pop().unwrap_or(Err(StorageError::Stopping)).map(Outcome::Appended)
        }
        Change::Complete { token_hash, events, receipt_key, now_ms } => {
            complete(transaction, token_hash, *events, receipt_key, *now_ms)
                .await
                .map(Outcome::Completed)
        }
        Change::Withdraw { holder, withdrawal_hash, now_ms } => {
            withdraw(transaction, holder, withdrawal_hash, *now_ms).await.map(Outcome::Withdrawn)
        }
    }
}
