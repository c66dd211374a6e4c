//! Backups: every row of a database in a file, and back into either kind of database.

pub(crate) mod deletions;
mod dump;
pub(crate) mod error;
pub(crate) mod file;
pub(crate) mod restore;
pub(crate) mod scrub;
mod tables;
