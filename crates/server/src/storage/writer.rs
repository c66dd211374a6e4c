//! Group commit: changes wait in lanes; each lane commits all that wait in one transaction and
//! answers them after the commit.
//!
//! While one transaction is being brought to disk the next changes gather, so that the number of
//! disk flushes a second does not bound the number of changes. A session always has the same lane:
//! its changes are applied in the order of their arrival.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use sqlx::Pool;
use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;

use super::super::super::StorageError;
use super::appends::{Append, append_all};
use super::changes::{Change, Outcome, apply};
use super::{BEGIN_WRITE, Db, LANES};

/// Changes in one transaction at most: bounds how long the first of them waits.
const MOST_IN_A_BATCH: usize = 256;
/// Changes waiting in a lane at most; beyond it requests wait in their connections.
const MOST_WAITING: usize = 4096;

struct Job {
    change: Change,
    answer: oneshot::Sender<Result<Outcome, StorageError>>,
}

/// Takes changes to the lanes.
#[derive(Clone)]
pub(super) struct Writer {
    lanes: Arc<Mutex<Lanes>>,
}

struct Lanes {
    senders: Vec<mpsc::Sender<Job>>,
    tasks: Vec<JoinHandle<()>>,
}

impl Writer {
    pub fn spawn(pool: &Pool<Db>) -> Self {
        let (senders, tasks) = (0..LANES)
            .map(|_| {
                let (sender, receiver) = mpsc::channel(MOST_WAITING);
                (sender, tokio::spawn(run_lane(pool.clone(), receiver)))
            })
            .unzip();
        Self { lanes: Arc::new(Mutex::new(Lanes { senders, tasks })) }
    }

    /// Resolves after the change is committed, or with the reason why it was not made.
    pub async fn commit(&self, route: &str, change: Change) -> Result<Outcome, StorageError> {
        let sender = {
            let lanes = self.lanes.lock().unwrap_or_else(PoisonError::into_inner);
            let mut hasher = DefaultHasher::new();
            route.hash(&mut hasher);
            let lane = hasher.finish() as usize % lanes.senders.len().max(1);
            lanes.senders.get(lane).cloned().ok_or(StorageError::Stopping)?
        };
        let (answer, answered) = oneshot::channel();
        sender.send(Job { change, answer }).await.map_err(|_| StorageError::Stopping)?;
        answered.await.map_err(|_| StorageError::Stopping)?
    }

    /// Takes no more changes and waits until those taken are committed.
    pub async fn finish(&self) {
        let tasks = {
            let mut lanes = self.lanes.lock().unwrap_or_else(PoisonError::into_inner);
            lanes.senders.clear();
            std::mem::take(&mut lanes.tasks)
        };
        for task in tasks {
            if task.await.is_err() {
                tracing::error!("a writing task ended by a panic");
            }
        }
    }
}

async fn run_lane(pool: Pool<Db>, mut jobs: mpsc::Receiver<Job>) {
    let mut batch = Vec::with_capacity(MOST_IN_A_BATCH);
    while jobs.recv_many(&mut batch, MOST_IN_A_BATCH).await > 0 {
        match commit_together(&pool, &batch).await {
            Ok(outcomes) => {
                for (job, outcome) in batch.drain(..).zip(outcomes) {
                    // A page that has gone will ask again; its change is kept.
                    let _ = job.answer.send(outcome);
                }
            }
            // Without a database there is no use in trying each: the pages will send them again.
            Err(StorageError::Unavailable) => {
                for job in batch.drain(..) {
                    let _ = job.answer.send(Err(StorageError::Unavailable));
                }
            }
            // One change that the database refuses must not take the others with it.
            Err(_) if batch.len() > 1 => {
                for job in batch.drain(..) {
                    let outcome = commit_together(&pool, std::slice::from_ref(&job)).await;
                    let outcome = outcome.and_then(|mut outcomes| {
                        outcomes.pop().unwrap_or(Err(StorageError::Stopping))
                    });
                    let _ = job.answer.send(outcome);
                }
            }
            Err(error) => {
                if let Some(job) = batch.pop() {
                    let _ = job.answer.send(Err(error));
                }
            }
        }
    }
}

/// Applies the changes in one transaction. The outer error means that nothing was committed, or
/// that it is not known; every change may then be made again, since each is idempotent.
async fn commit_together(
    pool: &Pool<Db>,
    jobs: &[Job],
) -> Result<Vec<Result<Outcome, StorageError>>, StorageError> {
    let mut transaction = pool.begin_with(BEGIN_WRITE).await?;
    let mut outcomes = Vec::with_capacity(jobs.len());
    let mut rest = jobs;
    while let Some((first, later)) = rest.split_first() {
        // Appends in a row go together.
        let appends: Vec<&Append> = rest.iter().map_while(|job| job.change.append()).collect();
        if appends.is_empty() {
            outcomes.push(match apply(&mut transaction, &first.change).await {
                Err(error @ (StorageError::Database(_) | StorageError::Unavailable)) => {
                    return Err(error);
                }
                outcome => outcome,
            });
            rest = later;
        } else {
            let done = append_all(&mut transaction, &appends).await?;
            rest = &rest[appends.len()..];
            outcomes.extend(done.into_iter().map(|each| each.map(Outcome::Appended)));
        }
    }
    transaction.commit().await?;
    Ok(outcomes)
}
