//! Where answers and accounts are kept: SQLite or PostgreSQL behind one handle, [`Storage`]. SQL stands
//! in this crate and nowhere else, and nothing in it knows HTTP.
//!
//! The statements are the same text for both databases; `database` holds what differs. Every change of
//! a session goes through a writer that commits many of them in one transaction and answers each only
//! after the commit. Times are milliseconds since 1970 by the clock of whoever calls.
//!
//! ```
//! use mimique_storage::{Storage, StudyVersion};
//!
//! # tokio::runtime::Runtime::new()?.block_on(async {
//! let folder = tempfile::tempdir()?;
//! let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
//! let storage = Storage::open(&url).await?;
//! let version = StudyVersion {
//!     study_id: "faces".into(),
//!     config_hash: "9f".repeat(32),
//!     file: "{}".into(),
//!     clips: "{}".into(),
//! };
//! let registered = storage.register_study(&version, 1_767_225_600_000).await?;
//! assert_eq!(registered.version, 1);
//! assert!(storage.sessions("faces").await?.is_empty());
//! storage.close().await;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! # })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accounts;
mod address;
mod backup;
mod database;
mod decisions;
pub mod durable_file;
mod error;
mod handle;
mod preparations;
mod records;
mod schema;
mod sessions;
mod studies;
mod wiper;

pub use accounts::records::{
    Account, AccountLink, ApiToken, AuditEntry, Exclusion, LinkPurpose, Role, StudyRole,
    UploadedStudy,
};
pub use backup::deletions::{read_deletions, write_deletions};
pub use backup::error::BackupError;
pub use backup::file::BackupFacts;
pub use backup::restore::{RestoreOptions, Restored};
pub use backup::scrub::scrub_backup;
pub use error::{MOST_SEQUENCES_REPORTED, StorageError};
pub use handle::Storage;
pub use records::{
    Appended, Completed, CountedEvent, CountedSo, Deletion, FIRST_SIGN_OF_LIFE_MS, KeptSums,
    NewSession, Overdue, RecruitmentEntry, Registered, SessionRecord, SessionState, StoredEvent,
    StudyVersion, TimesSeen, Withdrawal, WrittenEvent, participant_id,
};
