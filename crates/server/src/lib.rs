//! The server: pages, packs, answers kept in SQLite or PostgreSQL, export.
//!
//! [`App`] joins studies ([`HostedStudy`]), their packs ([`PackStore`]), the pages ([`Assets`]) and
//! [`Storage`]; [`router`] is its HTTP interface (the bodies are `mimique_study::wire`), [`serve`]
//! runs it until it is told to stop, [`export`] writes what was answered.
//!
//! What it promises: an append is acknowledged only after its transaction is on disk; sending a
//! request again changes nothing; a participant number is never given twice; tokens, codes and keys
//! are kept as hashes; no address of a participant is stored and no answer is logged.

mod accounts;
mod app;
mod assets;
mod atomic_file;
mod catalogue;
mod clock;
mod compression;
mod error;
pub mod export;
mod folder;
mod hosted;
mod limits;
mod metrics;
mod packs;
mod receipt;
mod researcher;
mod retention;
mod routes;
mod secret;
mod serve;
mod settings;
mod static_file;
mod storage;
mod studio;
mod uploads;

pub use accounts::Access;
pub use app::{App, AppError};
pub use assets::{Assets, AssetsError};
pub use hosted::{HostedStudy, Stage};
pub use packs::{PackError, PackStore};
pub use retention::erase_overdue;
pub use routes::router;
pub use serve::{ServeError, serve};
pub use settings::Settings;
pub use storage::{
    Account, AccountLink, ApiToken, Appended, AuditEntry, BackupError, BackupFacts, Completed,
    Deletion, Exclusion, LinkPurpose, MOST_SEQUENCES_REPORTED, NewSession, RecruitmentEntry,
    Registered, RestoreOptions, Restored, Role, SessionRecord, Status, Storage, StorageError,
    StudyVersion, UploadedStudy, read_deletions, scrub_backup, write_deletions,
};
pub use studio::{StudioFile, StudioFiles, StudioRole, serve_studio, studio_router};

/// The public name of a participant: `p0007`.
pub fn participant_id(number: u64) -> String {
    format!("p{number:04}")
}
