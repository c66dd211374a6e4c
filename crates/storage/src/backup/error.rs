//! Why a backup cannot be written, read or restored.

use std::io;
use std::path::Path;

use crate::error::StorageError;

/// A backup cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum BackupError {
    /// The file cannot be read or written.
    #[error("{path}: {error}; see that the place can be read and written and has room")]
    File {
        /// The file.
        path: String,
        /// What went wrong.
        error: io::Error,
    },
    /// The file is no whole backup.
    #[error("{path}: line {line}: {problem}; take another backup")]
    Damaged {
        /// The file.
        path: String,
        /// Where, from 1.
        line: u64,
        /// What is wrong.
        problem: String,
    },
    /// The place to restore to holds something.
    #[error("{place}: it is not empty; give a database that does not exist yet, or an empty one")]
    NotEmpty {
        /// The database.
        place: String,
    },
    /// The database failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
}

pub(super) fn at(path: &Path, error: io::Error) -> BackupError {
    BackupError::File { path: path.display().to_string(), error }
}
