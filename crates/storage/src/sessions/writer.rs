//! Group commit: changes wait in lanes; each lane commits all that wait in one transaction and
//! answers them after the commit.
//!
//! While one transaction is being brought to disk the next changes gather, so that the number of
//! disk flushes a second does not bound the number of changes. A session's appends always have the
//! same lane: they are applied in the order of their arrival.
//!
//! Starts, completions and withdrawals take many statements each, and a class of pupils makes sixty of
//! them in one moment: appends do not wait for them. Where there are several lanes the last one is
//! theirs; where there is one, appends go first and a transaction has few others. A page asks for
//! the end only after its last append was answered, and what comes in another order is counted from the
//! rows themselves, which are locked.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;

use super::append::{Append, append_all};
use super::change::{Change, Outcome, apply};
use crate::database::Pool;
use crate::error::StorageError;

/// Changes in one transaction at most: bounds how long the first of them waits.
const MOST_IN_A_BATCH: usize = 256;
/// Changes other than appends in one transaction at most: appends that come meanwhile wait so long.
const MOST_OTHERS_IN_A_BATCH: usize = 4;
/// Changes waiting in a lane at most; beyond it requests wait in their connections.
const MOST_WAITING: usize = 4096;

struct Job {
    change: Change,
    answer: oneshot::Sender<Result<Outcome, StorageError>>,
}

/// Takes changes to the lanes.
#[derive(Clone)]
pub(crate) struct Writer {
    lanes: Arc<Mutex<Lanes>>,
}

struct Lanes {
    senders: Vec<mpsc::Sender<Job>>,
    tasks: Vec<JoinHandle<()>>,
}

impl Writer {
    pub fn spawn(pool: &Pool) -> Self {
        let (senders, tasks) = (0..pool.dialect().lanes)
            .map(|_| {
                let (sender, receiver) = mpsc::channel(MOST_WAITING);
                (sender, tokio::spawn(run_lane(pool.clone(), receiver)))
            })
            .unzip();
        Self { lanes: Arc::new(Mutex::new(Lanes { senders, tasks })) }
    }

    /// Resolves after the change is committed, or with the reason why it was not made.
    pub(super) async fn commit(
        &self,
        route: &str,
        change: Change,
    ) -> Result<Outcome, StorageError> {
        let sender = {
            let lanes = self.lanes.lock().unwrap_or_else(PoisonError::into_inner);
            let lane = lane_of(route, &change, lanes.senders.len());
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

/// The lane of a change among so many.
fn lane_of(route: &str, change: &Change, lanes: usize) -> usize {
    let last = lanes.saturating_sub(1);
    if change.append().is_none() {
        return last;
    }
    let mut hasher = DefaultHasher::new();
    route.hash(&mut hasher);
    hasher.finish() as usize % last.max(1)
}

/// What one lane has taken and not committed yet.
#[derive(Default)]
struct Waiting {
    appends: Vec<Job>,
    others: VecDeque<Job>,
}

impl Waiting {
    /// Takes what has come; waits if there is nothing to do. Whether there is anything to do.
    async fn gather(&mut self, jobs: &mut mpsc::Receiver<Job>) -> bool {
        let mut fresh = Vec::new();
        if self.others.is_empty() {
            jobs.recv_many(&mut fresh, MOST_IN_A_BATCH).await;
        } else {
            fresh.extend(std::iter::from_fn(|| jobs.try_recv().ok()).take(MOST_IN_A_BATCH));
        }
        for job in fresh {
            match job.change.append() {
                Some(_) => self.appends.push(job),
                None => self.others.push_back(job),
            }
        }
        !self.appends.is_empty() || !self.others.is_empty()
    }

    /// All appends, then the first of the others; each in the order of their arrival.
    fn batch(&mut self) -> Vec<Job> {
        let others = self.others.len().min(MOST_OTHERS_IN_A_BATCH);
        self.appends.drain(..).chain(self.others.drain(..others)).collect()
    }
}

async fn run_lane(pool: Pool, mut jobs: mpsc::Receiver<Job>) {
    let mut waiting = Waiting::default();
    while waiting.gather(&mut jobs).await {
        let mut batch = waiting.batch();
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
    pool: &Pool,
    jobs: &[Job],
) -> Result<Vec<Result<Outcome, StorageError>>, StorageError> {
    let mut transaction = pool.begin_write().await?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn append(token: &str) -> Change {
        Change::Append(Append {
            token_hash: token.to_owned(),
            events: Vec::new(),
            limits: None,
            now_ms: 0,
        })
    }

    fn completion(token: &str) -> Change {
        let token_hash = token.to_owned();
        Change::Complete { token_hash, events: 0, receipt_key: Vec::new(), now_ms: 0 }
    }

    fn names(batch: &[Job]) -> Vec<String> {
        let name = |job: &Job| match &job.change {
            Change::Append(append) => append.token_hash.clone(),
            Change::Complete { token_hash, .. } => token_hash.clone(),
            _ => String::new(),
        };
        batch.iter().map(name).collect()
    }

    #[tokio::test]
    async fn appends_do_not_wait_for_those_who_end_together() {
        let (sender, mut jobs) = mpsc::channel(64);
        let send = |change| {
            let (answer, _) = oneshot::channel();
            assert!(sender.try_send(Job { change, answer }).is_ok());
        };
        let mut waiting = Waiting::default();
        (0..6).for_each(|n| send(completion(&format!("end {n}"))));
        send(append("a"));
        send(append("b"));
        assert!(waiting.gather(&mut jobs).await);
        assert_eq!(names(&waiting.batch()), ["a", "b", "end 0", "end 1", "end 2", "end 3"]);
        // What comes meanwhile goes before the rest.
        send(append("c"));
        send(completion("end 6"));
        assert!(waiting.gather(&mut jobs).await);
        assert_eq!(names(&waiting.batch()), ["c", "end 4", "end 5", "end 6"]);
        // Nothing is left behind when the server stops.
        (0..5).for_each(|n| send(completion(&format!("late {n}"))));
        drop(sender);
        assert!(waiting.gather(&mut jobs).await);
        assert_eq!(names(&waiting.batch()), ["late 0", "late 1", "late 2", "late 3"]);
        assert!(waiting.gather(&mut jobs).await);
        assert_eq!(names(&waiting.batch()), ["late 4"]);
        assert!(!waiting.gather(&mut jobs).await);
    }

    #[test]
    fn appends_of_a_session_share_a_lane_and_the_last_of_several_is_the_others_own() {
        for (lanes, own, shared) in [(1, 0, 1), (2, 1, 1), (3, 2, 2)] {
            let of = |n: u32| lane_of(&n.to_string(), &append("a"), lanes);
            let seen: std::collections::HashSet<usize> = (0..100).map(of).collect();
            assert_eq!(seen.len(), shared, "{lanes} lanes");
            assert!((0..100).all(|n| of(n) == of(n) && of(n) < shared));
            assert_eq!(lane_of("7", &completion("a"), lanes), own);
        }
    }
}
