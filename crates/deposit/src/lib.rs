//! Deposits: what a repository of research data takes of a study. An export, the study file, the clips as they were
//! prepared and the report in; every file of the deposit out: the answers as Psych-DS and as BIDS events, stimuli by their
//! hashes, metadata as an RO-Crate, `CITATION.cff`, licences, the software's bill of materials, SHA-256 of everything.
//!
//! What is personal is found first ([`personal`]) and answered ([`Answers`]); nothing is put together of what nobody has
//! answered. Pure: no network, no clock, nothing is read or written here; the day is an argument.
//!
//! ```text
//! export --Responses::read--> personal() --Answers::judge--> Judged --apply--> deposit_files() --> files
//! ```
//!
//! ```
//! use mimique_deposit::{Pattern, patterns};
//!
//! assert_eq!(patterns("write to jo@example.org"), [Pattern::EmailAddress]);
//! assert_eq!(patterns("5923.6"), []);
//! ```

mod about;
mod author;
pub mod bids;
mod citation;
mod deposit;
mod described;
mod dictionary;
mod file;
mod licence;
mod manifest;
mod personal;
mod preview;
pub mod psych_ds;
mod readme;
mod repository;
mod responses;
mod ro_crate;
mod software;
mod stimuli;
mod study_files;

pub use about::{About, is_day};
pub use author::{Author, Name};
pub use deposit::{Parts, deposit_files};
pub use described::REPORT;
pub use dictionary::known_columns;
pub use file::{Content, DepositFile, NotWritten};
pub use licence::{CODE_LICENCES, DATA_LICENCES, Licence, licence_named};
pub use personal::{
    Answers, Finding, Judged, Kind, NotAnswered, Pattern, Rare, Texts, addresses_in_study,
    patterns, personal, rare,
};
pub use repository::{dataverse_dataset, zenodo_metadata};
pub use responses::{NotResponses, Responses};
pub use stimuli::{Pack, StimulusRow, pack_hashes, stimulus_rows};
pub use study_files::{Changed, StudySource, StudyVersion, place_of};
