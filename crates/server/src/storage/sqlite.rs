//! SQLite: one file, write-ahead log, every commit on disk before it is acknowledged.

use std::path::Path;
use std::time::Duration;

use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};

use super::StorageError;
use super::migrations::Migration;

// The same source is compiled for the other database.
#[allow(clippy::duplicate_mod)]
#[path = "store.rs"]
mod store;

pub(super) use store::Store;

type Db = sqlx::Sqlite;
type Connection = sqlx::SqliteConnection;

/// Takes the write lock at once, so that a transaction never fails half-way for want of it.
const BEGIN_WRITE: &str = "BEGIN IMMEDIATE";
/// The write lock is the whole file's: a row needs none.
const FOR_UPDATE: &str = "";
/// Held while migrating: the write lock does it.
const LOCK_SCHEMA: Option<&str> = None;
/// SQLite has one writer, so one lane commits for everybody.
const LANES: usize = 1;

fn migration_text(step: &Migration) -> &'static str {
    step.sqlite
}

/// Opens the file, made when absent, and migrates it.
pub(super) async fn open(path: &Path) -> Result<Store, StorageError> {
    let options = SqliteConnectOptions::new()
        .filename(path)
        .create_if_missing(true)
        .journal_mode(SqliteJournalMode::Wal)
        .synchronous(SqliteSynchronous::Full)
        .busy_timeout(Duration::from_secs(10))
        .foreign_keys(true)
        // What a participant has deleted is overwritten, not merely unlinked.
        .pragma("secure_delete", "ON");
    let pool = |size| {
        SqlitePoolOptions::new()
            .max_connections(size)
            .acquire_timeout(Duration::from_secs(10))
            .connect_with(options.clone())
    };
    let writers = pool(1).await?;
    let readers = pool(4).await?;
    Store::open(writers, readers).await
}
