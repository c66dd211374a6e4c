//! SQLite: one file, write-ahead log, every commit on disk before it is acknowledged.

use std::path::Path;
use std::time::Duration;

use sqlx::Connection as _;
use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};

use super::StorageError;
use super::backup::{BackupError, Reader, RestoreOptions, Restored};
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
/// Reads what is committed at its first statement, whatever is written meanwhile.
const BEGIN_SNAPSHOT: &str = "BEGIN";
/// Every table and column, in the order of their making.
const COLUMNS: &str = "SELECT m.name AS table_name, p.name AS column_name, p.type AS kind \
     FROM sqlite_schema m JOIN pragma_table_info(m.name) p WHERE m.type = 'table' \
     AND m.name NOT LIKE 'sqlite_%' ORDER BY m.rowid, p.cid";
/// Keys are given as they are.
const OVERRIDING: &str = "";
/// SQLite goes on after the highest key by itself.
const IDENTITIES: Option<&str> = None;
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
    let pool = |size| {
        SqlitePoolOptions::new()
            .max_connections(size)
            .acquire_timeout(Duration::from_secs(10))
            // Where the disk is full SQLite ends the transaction itself, and the driver goes on
            // believing in it: such a connection can begin no other and is replaced.
            .before_acquire(|connection, _| {
                Box::pin(async move { Ok(connection.begin_with("BEGIN").await.is_ok()) })
            })
            .connect_with(options(path))
    };
    let writers = pool(1).await?;
    let readers = pool(4).await?;
    Store::open(writers, readers).await
}

/// Fills a file that is not there yet; whole or absent.
pub(super) async fn restore(
    path: &Path,
    reader: &mut Reader,
    choice: RestoreOptions<'_>,
) -> Result<Restored, BackupError> {
    let place = path.display().to_string();
    if std::fs::metadata(path).is_ok_and(|file| file.len() > 0) {
        return Err(BackupError::NotEmpty { place });
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let outcome = async {
        let pool = SqlitePoolOptions::new().max_connections(1).connect_with(options(&temporary));
        let pool = pool.await.map_err(StorageError::from)?;
        let rows = store::restore(&pool, &place, reader, choice).await;
        // Closing brings the log into the file.
        pool.close().await;
        let restored = rows?;
        std::fs::File::open(&temporary)
            .and_then(|file| file.sync_all())
            .and_then(|()| std::fs::rename(&temporary, path))
            .map_err(|error| BackupError::File { path: place.clone(), error })?;
        Ok(restored)
    };
    let outcome = outcome.await;
    for suffix in ["", "-wal", "-shm"] {
        let mut left = temporary.clone().into_os_string();
        left.push(suffix);
        let _ = std::fs::remove_file(left);
    }
    outcome
}

fn options(path: &Path) -> SqliteConnectOptions {
    SqliteConnectOptions::new()
        .filename(path)
        .create_if_missing(true)
        .journal_mode(SqliteJournalMode::Wal)
        .synchronous(SqliteSynchronous::Full)
        .busy_timeout(Duration::from_secs(10))
        .foreign_keys(true)
        // What a participant has deleted is overwritten, not merely unlinked.
        .pragma("secure_delete", "ON")
}
