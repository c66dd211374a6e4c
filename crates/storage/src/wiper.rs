//! What was deleted is not left to be read in SQLite's files.
//!
//! A deletion overwrites its rows (`secure_delete`), but earlier copies of them lie elsewhere: in the
//! write-ahead log, until it is brought into the file and cut off; and in the free space of pages that were
//! divided when they were full, which only a rewrite of the file (`VACUUM`) takes away. Both are done after
//! each deletion. A large file is rewritten when nobody has written for a while, since everybody would
//! wait meanwhile; where somebody reads the old state, the log is cut off when that is over. PostgreSQL has
//! its own ways and times, which docs/guide/deployment.md names.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::database::{Pool, query};
use crate::error::StorageError;

/// Bytes of a file that is rewritten at once: it takes about a second.
const LARGEST_AT_ONCE: i64 = 128 * 1024 * 1024;
/// Who stands in the way is asked for again after this time.
const AGAIN_AFTER: Duration = Duration::from_secs(1);
/// A larger file waits until nothing was written for so long.
const QUIET: Duration = Duration::from_secs(20);
/// In `clock_marks`: that the file is still to be rewritten, for the next start if this one ends before.
const MARK: &str = "to rewrite";

/// Rewrites the file and cuts its log off; nothing to do for PostgreSQL.
#[derive(Clone)]
pub(crate) struct Wiper {
    pool: Option<Pool>,
    /// Something was deleted since the last rewrite began.
    is_wanted: Arc<AtomicBool>,
    /// One rewrite at a time.
    turn: Arc<tokio::sync::Mutex<()>>,
}

impl Wiper {
    pub fn new(pool: Option<Pool>) -> Self {
        Self { pool, is_wanted: Arc::default(), turn: Arc::default() }
    }

    /// Goes on with what an earlier process could not do.
    pub async fn go_on(&self) -> Result<(), StorageError> {
        let Some(pool) = &self.pool else { return Ok(()) };
        let row = query("SELECT 1 FROM clock_marks WHERE name = $1")
            .bind(MARK)
            .fetch_optional(pool)
            .await?;
        if row.is_some() {
            tokio::spawn(self.clone().wipe_patiently(pool.clone()));
        }
        Ok(())
    }

    /// Takes what was deleted out of the files: now, or as soon as it can be.
    pub async fn wipe(&self) {
        let Some(pool) = self.pool.clone() else { return };
        self.is_wanted.store(true, Ordering::Release);
        let is_small = bytes(&pool).await.is_ok_and(|bytes| bytes <= LARGEST_AT_ONCE);
        if is_small && self.try_wiping(&pool).await {
            return;
        }
        let marked =
            query("INSERT INTO clock_marks (name, at_ms) VALUES ($1, 0) ON CONFLICT DO NOTHING")
                .bind(MARK)
                .execute(&pool)
                .await;
        if let Err(error) = marked {
            tracing::warn!("the file cannot be marked to be rewritten: {error}");
        }
        tokio::spawn(self.clone().wipe_patiently(pool));
    }

    /// Whether the files are clean now, or somebody else is at it and will see that this is wanted.
    async fn try_wiping(&self, pool: &Pool) -> bool {
        let Ok(_turn) = self.turn.try_lock() else { return true };
        while self.is_wanted.swap(false, Ordering::AcqRel) {
            if rewrite(pool).await.is_err() {
                self.is_wanted.store(true, Ordering::Release);
                return false;
            }
        }
        matches!(cut_log_off(pool).await, Ok(true))
    }

    /// Tries until it is done or the database is closed.
    async fn wipe_patiently(self, pool: Pool) {
        self.is_wanted.store(true, Ordering::Release);
        let Ok(_turn) = Arc::clone(&self.turn).try_lock_owned() else { return };
        while self.is_wanted.swap(false, Ordering::AcqRel) {
            loop {
                if !is_quiet(&pool).await {
                    if pool.is_closed() {
                        return;
                    }
                    continue;
                }
                match rewrite(&pool).await {
                    Ok(()) => break,
                    Err(StorageError::Unavailable) if !pool.is_closed() => {}
                    Err(_) if pool.is_closed() => return,
                    Err(error) => tracing::warn!("the file cannot be rewritten: {error}"),
                }
            }
            let done = query("DELETE FROM clock_marks WHERE name = $1").bind(MARK);
            if let Err(error) = done.execute(&pool).await {
                tracing::warn!("the file is rewritten, and not marked so: {error}");
            }
            while matches!(cut_log_off(&pool).await, Ok(false)) {
                tokio::time::sleep(AGAIN_AFTER).await;
            }
        }
    }

    pub async fn close(&self) {
        if let Some(pool) = &self.pool {
            pool.close().await;
        }
    }
}

/// How large the file is.
async fn bytes(pool: &Pool) -> Result<i64, StorageError> {
    let row = query(
        "SELECT page_count * page_size AS bytes FROM pragma_page_count(), pragma_page_size()",
    )
    .fetch_one(pool)
    .await?;
    row.get("bytes")
}

/// Waits a second where the file is small, longer where it is large; whether nobody wrote meanwhile.
async fn is_quiet(pool: &Pool) -> bool {
    let is_small = bytes(pool).await.is_ok_and(|bytes| bytes <= LARGEST_AT_ONCE);
    let before = version(pool).await;
    tokio::time::sleep(if is_small { AGAIN_AFTER } else { QUIET }).await;
    match (before, version(pool).await) {
        (Ok(before), Ok(after)) => is_small || before == after,
        _ => false,
    }
}

/// A number that changes with whatever another connection commits.
async fn version(pool: &Pool) -> Result<i64, StorageError> {
    query("PRAGMA data_version").fetch_one(pool).await?.get(0)
}

async fn rewrite(pool: &Pool) -> Result<(), StorageError> {
    query("VACUUM").once().execute(pool).await?;
    Ok(())
}

/// Brings the log into the file; false where a reader of the old state stands in the way.
async fn cut_log_off(pool: &Pool) -> Result<bool, StorageError> {
    let row = query("PRAGMA wal_checkpoint(TRUNCATE)").fetch_one(pool).await?;
    Ok(row.get::<i64>("busy")? == 0)
}
