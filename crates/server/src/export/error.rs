//! Why an export cannot be made.

use std::io;

use mimique_storage::StorageError;

/// Export failed.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Storage failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
    /// The database holds no study, or none of this name.
    #[error("study {id}: not in this database, which holds {known}; choose one of these")]
    UnknownStudy {
        /// The identifier asked for.
        id: String,
        /// Those it holds.
        known: String,
    },
    /// The database holds several studies and none was chosen.
    #[error("the database holds {known}; choose one by --study")]
    SeveralStudies {
        /// Those it holds.
        known: String,
    },
    /// A session's version of the study is not stored.
    #[error("study {id}: version {config_hash} is not in the database; restore it from a backup")]
    MissingVersion {
        /// The study.
        id: String,
        /// The version.
        config_hash: String,
    },
    /// A file cannot be written.
    #[error("{path}: {error}; choose another place by --out")]
    File {
        /// The file.
        path: String,
        /// What went wrong.
        error: io::Error,
    },
    /// A file cannot be put together.
    #[error("the export cannot be put together: {0}; this is a mistake of Mimique's")]
    Form(String),
}

impl ExportError {
    /// A session is of a version that is not stored.
    pub(super) fn missing(study_id: &str, config_hash: &str) -> Self {
        Self::MissingVersion { id: study_id.to_owned(), config_hash: config_hash.to_owned() }
    }
}
