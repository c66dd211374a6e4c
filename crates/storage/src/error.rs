//! Why storage did not do what it was asked.

/// How many missing sequences are listed at most.
pub const MOST_SEQUENCES_REPORTED: usize = 1000;

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
    /// The session has as many events, or as much in them, as its study can give.
    #[error("the session has more events than its study can give; start the study again")]
    SessionFull,
    /// No session has this withdrawal code.
    #[error("no participant has this withdrawal code; copy it as it was shown")]
    UnknownWithdrawalCode,
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
