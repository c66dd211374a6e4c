//! SQLite: one file, write-ahead log, every commit on disk before it is acknowledged.

use std::path::Path;
use std::time::Duration;

use sqlx::Connection as _;
use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};

use super::Pool;
use crate::error::StorageError;

/// Connects to the file, made when absent: one connection that writes and four that read.
pub(crate) async fn open(path: &Path) -> Result<[Pool; 2], StorageError> {
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
    Ok([Pool::Sqlite(pool(1).await?), Pool::Sqlite(pool(4).await?)])
}

/// Connects once, for a restoration.
pub(crate) async fn open_once(path: &Path) -> Result<Pool, StorageError> {
    let pool = SqlitePoolOptions::new().max_connections(1).connect_with(options(path));
    Ok(Pool::Sqlite(pool.await?))
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
