//! Why the server cannot start.

use mimique_storage::StorageError;

/// The server cannot start.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// Two files have one identifier.
    #[error("study {id} is given twice; give each study file its own id")]
    StudyTwice {
        /// The identifier.
        id: String,
    },
    /// Nobody has this account.
    #[error("{email}: nobody has an account by this address; there are {known}")]
    NoAccount {
        /// The address asked for.
        email: String,
        /// Those there are.
        known: String,
    },
    /// Storage failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
    /// The operating system has no randomness to give.
    #[error("no random numbers: {0}; see the operating system's log")]
    Randomness(#[from] getrandom::Error),
}
