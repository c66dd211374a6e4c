//! Export.

use crate::storage::StorageError;

/// Export failed.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Storage failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
    /// No such study.
    #[error("study {id}: not in this database; it holds {known}")]
    UnknownStudy {
        /// The identifier.
        id: String,
        /// Those it holds.
        known: String,
    },
}
