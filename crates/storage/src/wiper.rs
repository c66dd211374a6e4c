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
use std::time::{Duration, Instant};

use crate::database::{Pool, query};
use crate::error::StorageError;

/// How long is waited for what.
#[derive(Debug, Clone, Copy)]
struct Patience {
    /// Bytes of a file that is rewritten at once: it takes about a second.
    largest_at_once: i64,
    /// Who stands in the way is asked for again after this time.
    again_after: Duration,
    /// A larger file waits until nobody has answered for so long.
    quiet: Duration,
    /// And is rewritten after so long, whoever answers: what was deleted has to go.
    longest: Duration,
}

const PATIENCE: Patience = Patience {
    largest_at_once: 128 * 1024 * 1024,
    again_after: Duration::from_secs(1),
    quiet: Duration::from_secs(20),
    longest: Duration::from_secs(6 * 3600),
};
/// In `clock_marks`: that the file is still to be rewritten, for the next start if this one ends before.
const MARK: &str = "to rewrite";

/// Rewrites the file and cuts its log off; nothing to do for PostgreSQL.
#[derive(Clone)]
pub(crate) struct Wiper {
    pool: Option<Pool>,
    patience: Patience,
    /// Something was deleted since the last rewrite began.
    is_wanted: Arc<AtomicBool>,
    /// One rewrite at a time.
    turn: Arc<tokio::sync::Mutex<()>>,
}

impl Wiper {
    pub fn new(pool: Option<Pool>) -> Self {
        Self { pool, patience: PATIENCE, is_wanted: Arc::default(), turn: Arc::default() }
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
        if self.is_small(&pool).await && self.try_wiping(&pool).await {
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
            let since = Instant::now();
            loop {
                if !self.is_quiet(&pool).await && since.elapsed() < self.patience.longest {
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
                tokio::time::sleep(self.patience.again_after).await;
            }
        }
    }

    async fn is_small(&self, pool: &Pool) -> bool {
        bytes(pool).await.is_ok_and(|bytes| bytes <= self.patience.largest_at_once)
    }

    /// Waits a second where the file is small, longer where it is large; whether nobody answered meanwhile.
    async fn is_quiet(&self, pool: &Pool) -> bool {
        if self.is_small(pool).await {
            tokio::time::sleep(self.patience.again_after).await;
            return !pool.is_closed();
        }
        let before = answered(pool).await;
        tokio::time::sleep(self.patience.quiet).await;
        match (before, answered(pool).await) {
            (Ok(before), Ok(after)) => before == after,
            _ => false,
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

/// What changes when somebody begins, answers or comes to an end: not when somebody only asks whether the
/// database can be written.
async fn answered(pool: &Pool) -> Result<[i64; 3], StorageError> {
    let row = query(
        "SELECT COUNT(*) AS sessions, COALESCE(MAX(last_event_ms), 0) AS last, \
         COALESCE(MAX(ended_ms), 0) AS ended FROM sessions",
    )
    .fetch_one(pool)
    .await?;
    Ok([row.get("sessions")?, row.get("last")?, row.get("ended")?])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handle::Storage;

    const SHORT: Patience = Patience {
        largest_at_once: 0,
        again_after: Duration::from_millis(20),
        // A write that waits for a busy disk must not pass for quiet.
        quiet: Duration::from_secs(2),
        longest: Duration::from_secs(8),
    };

    /// How long a large file takes to be rewritten while this is written again and again.
    async fn rewritten_while(statement: &'static str) -> Duration {
        let folder = tempfile::tempdir().unwrap();
        let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
        let storage = Storage::open(&url).await.unwrap();
        query("INSERT INTO studies (study_id, config_hash, next_participant) VALUES ('s', 'c', 1)")
            .execute(&storage.writers)
            .await
            .unwrap();
        let wiper = Wiper { patience: SHORT, ..storage.wiper.clone() };
        let began = Instant::now();
        wiper.wipe().await;
        let mark = "SELECT 1 FROM clock_marks WHERE name = 'to rewrite'";
        while query(mark).fetch_optional(&storage.readers).await.unwrap().is_some() {
            query(statement).execute(&storage.writers).await.unwrap();
            tokio::time::sleep(Duration::from_millis(20)).await;
            assert!(began.elapsed() < Duration::from_secs(60), "it is never rewritten");
        }
        let took = began.elapsed();
        storage.close().await;
        took
    }

    #[tokio::test]
    async fn a_large_file_waits_for_people_and_for_nobody_else_and_not_for_ever() {
        // Who asks again and again whether the server is ready writes as well.
        let asked = "INSERT INTO clock_marks (name, at_ms) VALUES ('tried', 1) \
                     ON CONFLICT (name) DO UPDATE SET at_ms = clock_marks.at_ms + 1";
        let took = rewritten_while(asked).await;
        assert!(took >= SHORT.quiet && took < SHORT.longest, "{took:?}");
        let answering = "INSERT INTO sessions (token_hash, study_id, participant, config_hash, seed, \
             stage, language, client, withdrawal_hash, status, started_ms, event_count, next_sequence) \
             SELECT 't' || COUNT(*), 's', COUNT(*) + 1, 'c', 1, 'live', 'en', '{}', 'w', 'active', 1, \
             0, 0 FROM sessions";
        let took = rewritten_while(answering).await;
        assert!(took >= SHORT.longest, "{took:?}");
    }
}
