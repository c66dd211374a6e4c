//! SQLite: one file, write-ahead log, every commit on disk before it is acknowledged.

use std::path::Path;
use std::time::Duration;

use sqlx::Connection as _;
use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};

use super::{Opened, Pool, READERS};
use crate::durable_file;
use crate::error::StorageError;

/// Connects to the file, made when absent: one connection that writes, six that read, and one that brings
/// the log into the file, which does not wait long for others.
pub(crate) async fn open(path: &Path) -> Result<Opened, StorageError> {
    close_to_others(path);
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
    let (writers, readers) = (pool(1).await?, pool(READERS).await?);
    let wiper = SqlitePoolOptions::new()
        .max_connections(1)
        .connect_with(options(path).busy_timeout(WIPER_PATIENCE))
        .await?;
    let [writers, readers, wiper] = [writers, readers, wiper].map(Pool::Sqlite);
    Ok(Opened { writers, readers, wiper: Some(wiper) })
}

/// Nobody can write while the log is brought into the file: readers are waited for so long.
const WIPER_PATIENCE: Duration = Duration::from_millis(200);

/// Connects once, for a restoration.
pub(crate) async fn open_once(path: &Path) -> Result<Pool, StorageError> {
    close_to_others(path);
    let pool = SqlitePoolOptions::new().max_connections(1).connect_with(options(path));
    Ok(Pool::Sqlite(pool.await?))
}

/// The database is its owner's alone; SQLite makes what lies beside it like it. Where no file can be made
/// SQLite says so itself.
fn close_to_others(path: &Path) {
    let _ = durable_file::keep_private(path);
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
