//! Where answers are kept: one interface, SQLite or PostgreSQL behind it.
//!
//! The statements are the same text for both databases (`store.rs`, compiled once for each, since
//! the generic bounds of sqlx would be longer than the queries); `sqlite.rs` and `postgres.rs` hold
//! what differs. Every change goes through a writer that commits many of them in one transaction
//! and answers each only after the commit.

mod account_calls;
mod account_records;
mod backup;
mod migrations;
mod postgres;
mod records;
mod sqlite;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mimique_study::wire::Event;

pub use account_records::{
    Account, AccountLink, ApiToken, AuditEntry, Exclusion, LinkPurpose, Role, UploadedStudy,
};
pub use backup::{
    BackupError, BackupFacts, RestoreOptions, Restored, read_deletions, scrub_backup,
    write_deletions,
};
pub(crate) use records::WrittenEvent;
pub use records::{
    Appended, Completed, Deletion, NewSession, RecruitmentEntry, Registered, SessionRecord, Status,
    StudyVersion,
};

/// Why storage did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum StorageError {
    /// No session has this token.
    #[error("no session has this token; start the study again from its address")]
    UnknownSession,
    /// The participant has withdrawn: nothing more is taken.
    #[error("the participant has withdrawn; nothing more is stored")]
    Withdrawn,
    /// Events are missing, so the session cannot be completed.
    #[error("{} events are missing, first {first}; send them again", missing.len(), first = missing.first().copied().unwrap_or(0))]
    MissingEvents {
        /// Their sequences, at most [`MOST_SEQUENCES_REPORTED`].
        missing: Vec<u64>,
    },
    /// The person has taken part already, and the study takes each once.
    #[error("this person has already taken part; everybody can take part once")]
    AlreadyTookPart,
    /// As many participants as the study wants have finished or are on their way.
    #[error("the study has all the participants it wants; a place may become free later")]
    StudyFull,
    /// The withdrawal code is not this session's.
    #[error("the withdrawal code is not the one of this session; copy it as it was shown")]
    WrongWithdrawalCode,
    /// The database's address cannot be read.
    #[error("{url}: {problem}; use sqlite:FILE or postgres://USER@HOST/NAME")]
    Address {
        /// The address without its password.
        url: String,
        /// What is wrong with it.
        problem: String,
    },
    /// There is no database to read.
    #[error("no file {path}; give the database that `mimique serve` writes")]
    NoDatabase {
        /// The file.
        path: String,
    },
    /// The database was made by a later version of Mimique.
    #[error(
        "the database has schema version {found}, this binary knows up to {known}; use the newer binary"
    )]
    SchemaTooNew {
        /// Version found in the database.
        found: i64,
        /// Highest version that this binary knows.
        known: i64,
    },
    /// A stored value cannot be read back.
    #[error("table {table}: {problem}; restore the database from a backup")]
    Damaged {
        /// The table it stands in.
        table: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// The database failed.
    #[error("the database failed: {0}; see that it runs and that its disk has room")]
    Database(sqlx::Error),
    /// The database does not answer, or cannot write for now.
    #[error(
        "the database does not answer or cannot write; see that it runs and that its disk has room"
    )]
    Unavailable,
    /// The server is stopping.
    #[error("the server is stopping; send the request again in a moment")]
    Stopping,
}

impl From<sqlx::Error> for StorageError {
    fn from(error: sqlx::Error) -> Self {
        match error {
            sqlx::Error::Io(_) | sqlx::Error::PoolTimedOut | sqlx::Error::PoolClosed => {
                Self::Unavailable
            }
            sqlx::Error::Database(error) if is_passing(error.code().as_deref()) => {
                Self::Unavailable
            }
            error => Self::Database(error),
        }
    }
}

/// Whether the same request can succeed later: the disk is full or read-only, the database stops or
/// is busy.
fn is_passing(code: Option<&str>) -> bool {
    match code {
        // SQLSTATE: read-only, disk full, too many connections, shut down, crash, starting up.
        Some("25006" | "53100" | "53300" | "57P01" | "57P02" | "57P03") => true,
        // SQLite: 5 busy, 8 read-only, 10 disk, 13 full, 14 cannot open; the low byte of extended
        // codes.
        Some(code) => {
            code.len() < 5
                && code.parse::<u32>().is_ok_and(|c| matches!(c & 255, 5 | 8 | 10 | 13 | 14))
        }
        None => false,
    }
}

/// Tables with rows of a session (`session_key`) that are deleted with its answers.
pub(crate) const PERSONAL_TABLES: [&str; 4] =
    ["events", "event_conflicts", "recruitment", "repeat_marks"];

/// How many missing sequences are listed at most.
pub const MOST_SEQUENCES_REPORTED: usize = 1000;

/// Handle of the database; cheap to clone.
#[derive(Clone)]
pub struct Storage {
    store: Store,
}

#[derive(Clone)]
enum Store {
    Sqlite(sqlite::Store),
    Postgres(postgres::Store),
}

/// Calls the same method of whichever database is behind.
macro_rules! on_store {
    ($self:ident, $store:ident => $call:expr) => {
        match &$self.store {
            Store::Sqlite($store) => $call,
            Store::Postgres($store) => $call,
        }
    };
}

impl Storage {
    /// Opens `sqlite:FILE` (made when absent) or `postgres://…` and brings its schema up to date.
    ///
    /// Refuses what cannot be written: a server that could keep no answer must not start.
    pub async fn open(url: &str) -> Result<Self, StorageError> {
        let storage = Self::connect(url).await?;
        on_store!(storage, store => store.ensure_writable().await)?;
        Ok(storage)
    }

    async fn connect(url: &str) -> Result<Self, StorageError> {
        let store = if url.starts_with("postgres://") || url.starts_with("postgresql://") {
            Store::Postgres(postgres::open(url).await?)
        } else if let Some(path) = sqlite_path(url) {
            Store::Sqlite(sqlite::open(&path).await?)
        } else {
            return Err(unknown_kind(url));
        };
        Ok(Self { store })
    }

    /// Like [`Self::open`], but a SQLite file must be there already, and may be one that can only be
    /// read.
    pub async fn open_existing(url: &str) -> Result<Self, StorageError> {
        if let Some(path) = sqlite_path(url).filter(|path| !path.is_file()) {
            return Err(StorageError::NoDatabase { path: path.display().to_string() });
        }
        Self::connect(url).await
    }

    /// A database's address fit for a message.
    pub fn without_password(url: &str) -> String {
        without_password(url)
    }

    /// `SQLite` or `PostgreSQL`, for messages.
    pub fn kind(&self) -> &'static str {
        match self.store {
            Store::Sqlite(_) => "SQLite",
            Store::Postgres(_) => "PostgreSQL",
        }
    }

    /// Waits until every change accepted so far is committed, then closes.
    pub async fn close(&self) {
        on_store!(self, store => store.close().await)
    }

    /// Asks the database whether it answers.
    pub async fn ping(&self) -> Result<(), StorageError> {
        on_store!(self, store => store.ping().await)
    }

    /// Asks the database whether its schema is the one that this binary knows.
    pub async fn is_current(&self) -> Result<bool, StorageError> {
        on_store!(self, store => store.is_current().await)
    }

    /// How many sessions there are, by study, stage and status.
    pub async fn session_counts(&self) -> Result<Vec<([String; 3], u64)>, StorageError> {
        on_store!(self, store => store.session_counts().await)
    }

    /// The secret kept under this name, made by `make` at the first call.
    pub async fn server_key(
        &self,
        name: &str,
        make: impl FnOnce() -> String,
    ) -> Result<String, StorageError> {
        let fresh = make();
        on_store!(self, store => store.server_key(name, &fresh).await)
    }

    /// Makes this version the current one of its study, and says what that changes.
    pub async fn register_study(
        &self,
        version: &StudyVersion,
        now_ms: i64,
    ) -> Result<Registered, StorageError> {
        on_store!(self, store => store.register_study(version, now_ms).await)
    }

    /// Every version of every study ever served, in order of study and first service.
    pub async fn study_versions(&self) -> Result<Vec<StudyVersion>, StorageError> {
        on_store!(self, store => store.study_versions().await)
    }

    /// Starts a session, or finds the one started with the same token.
    pub async fn start(&self, session: NewSession) -> Result<SessionRecord, StorageError> {
        on_store!(self, store => store.start(session).await)
    }

    /// The session with this token's hash.
    pub async fn session(&self, token_hash: &str) -> Result<SessionRecord, StorageError> {
        on_store!(self, store => store.session(token_hash).await)
    }

    /// Every session of a study, by participant number.
    pub async fn sessions(&self, study_id: &str) -> Result<Vec<SessionRecord>, StorageError> {
        on_store!(self, store => store.sessions(study_id).await)
    }

    /// Every stored event of a session, by sequence.
    pub async fn events(&self, session_key: i64) -> Result<Vec<Event>, StorageError> {
        on_store!(self, store => store.events(session_key).await)
    }

    /// How many differing bodies were sent for stored sequences, by session key.
    pub async fn conflict_counts(&self, study_id: &str) -> Result<Vec<(i64, u64)>, StorageError> {
        on_store!(self, store => store.conflict_counts(study_id).await)
    }

    /// The recruitment identifiers of one session, by name.
    pub async fn session_recruitment(
        &self,
        session_key: i64,
    ) -> Result<BTreeMap<String, String>, StorageError> {
        on_store!(self, store => store.session_recruitment(session_key).await)
    }

    /// The recruitment identifiers of a study's participants, by participant and name.
    pub async fn recruitment(&self, study_id: &str) -> Result<Vec<RecruitmentEntry>, StorageError> {
        on_store!(self, store => store.recruitment(study_id).await)
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
    pub(crate) async fn append_written(
        &self,
        token_hash: &str,
        events: Vec<WrittenEvent>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        on_store!(self, store => store.append(token_hash, events, now_ms).await)
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
        on_store!(self, store => store.complete(token_hash, events, receipt_key, now_ms).await)
    }

    /// Deletes a session's events and identifiers and keeps its number; returns how many events
    /// were deleted.
    pub async fn withdraw(
        &self,
        token_hash: &str,
        withdrawal_hash: &str,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        on_store!(self, store => store.withdraw(token_hash, withdrawal_hash, now_ms).await)
    }

    /// Deletes a participant's answers and identifiers at their wish; returns how many events.
    pub async fn erase_participant(
        &self,
        study_id: &str,
        participant: u64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        on_store!(self, store => store.erase_participant(study_id, participant, now_ms).await)
    }

    /// Deletes recruitment identifiers and repeat marks, of one participant or of all of a study;
    /// returns how many.
    pub async fn erase_identifiers(
        &self,
        study_id: &str,
        participant: Option<u64>,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        on_store!(self, store => store.erase_identifiers(study_id, participant, now_ms).await)
    }

    /// Deletes the answers of the sessions of a version that ended (or showed their last sign of
    /// life) before `before_ms`; returns how many sessions.
    pub async fn erase_ended_before(
        &self,
        study_id: &str,
        config_hash: &str,
        before_ms: i64,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        on_store!(self, store => {
            store.erase_ended_before(study_id, config_hash, before_ms, now_ms).await
        })
    }

    /// Every deletion there was, in order of time: what a backup must not bring back.
    pub async fn deletions(&self) -> Result<Vec<Deletion>, StorageError> {
        on_store!(self, store => store.deletions().await)
    }

    /// Writes a backup, while everybody goes on.
    pub async fn backup(&self, path: &Path, now_ms: i64) -> Result<BackupFacts, BackupError> {
        on_store!(self, store => store.backup(path, now_ms).await)
    }

    /// Fills a new SQLite file, or an empty PostgreSQL database, from a backup of either; all or
    /// nothing.
    pub async fn restore(
        url: &str,
        path: &Path,
        options: RestoreOptions<'_>,
    ) -> Result<Restored, BackupError> {
        let mut reader = backup::Reader::open(path)?;
        if url.starts_with("postgres://") || url.starts_with("postgresql://") {
            postgres::restore(url, &mut reader, options).await
        } else if let Some(path) = sqlite_path(url) {
            sqlite::restore(&path, &mut reader, options).await
        } else {
            Err(unknown_kind(url).into())
        }
    }
}

fn unknown_kind(url: &str) -> StorageError {
    StorageError::Address { url: without_password(url), problem: "unknown kind of database".into() }
}

/// The file of a `sqlite:` address; a plain path is taken as one.
fn sqlite_path(url: &str) -> Option<PathBuf> {
    let path = match url.split_once(':') {
        Some(("sqlite", rest)) => rest.strip_prefix("//").unwrap_or(rest),
        // A drive letter is no scheme.
        Some((scheme, _)) if scheme.len() > 1 => return None,
        _ => url,
    };
    (!path.is_empty()).then(|| PathBuf::from(path))
}

/// An address fit for a message.
fn without_password(url: &str) -> String {
    match (url.find("://"), url.rfind('@')) {
        (Some(scheme), Some(at)) if scheme + 3 <= at => {
            format!("{}…{}", &url[..scheme + 3], &url[at..])
        }
        _ => url.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_name_a_file_or_nothing() {
        assert_eq!(sqlite_path("sqlite:a/b.sqlite"), Some(PathBuf::from("a/b.sqlite")));
        assert_eq!(sqlite_path("sqlite:///tmp/b"), Some(PathBuf::from("/tmp/b")));
        assert_eq!(sqlite_path("answers.sqlite"), Some(PathBuf::from("answers.sqlite")));
        assert_eq!(sqlite_path("mysql://x/y"), None);
        assert_eq!(sqlite_path("sqlite:"), None);
    }

    #[test]
    fn a_password_is_not_repeated_in_messages() {
        assert_eq!(without_password("mysql://me:secret@host/x"), "mysql://…@host/x");
    }
}
