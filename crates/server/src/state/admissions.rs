//! What each session's plan admits, kept for the sessions that are under way.
//!
//! A plan is drawn once a session and server; two generations of sessions are held, so that what is used
//! stays and what is not is dropped.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use mimique_session::Admission;
use mimique_session::flow::Plan;
use mimique_storage::{SessionRecord, Storage, StorageError};
use mimique_study::StudyProjection;

use crate::export::sources::{Version, as_started};

/// Sessions in a generation.
const MOST_SESSIONS: usize = 1024;

/// None where no plan can be drawn any more: nothing is known then of what cannot be.
type Known = Option<Arc<Admission>>;

/// What the plans of sessions admit, by the hash of the session's token.
#[derive(Default)]
pub(crate) struct Admissions {
    sessions: Mutex<Generations>,
    /// Versions of studies, by study and hash.
    studies: Mutex<HashMap<(String, String), Arc<StudyProjection>>>,
}

#[derive(Default)]
struct Generations {
    young: HashMap<String, Known>,
    old: HashMap<String, Known>,
}

impl Generations {
    fn get(&mut self, token_hash: &str) -> Option<Known> {
        if let Some(known) = self.young.get(token_hash) {
            return Some(known.clone());
        }
        let known = self.old.remove(token_hash)?;
        self.put(token_hash, known.clone());
        Some(known)
    }

    fn put(&mut self, token_hash: &str, known: Known) {
        if self.young.len() >= MOST_SESSIONS {
            self.old = std::mem::take(&mut self.young);
        }
        self.young.insert(token_hash.to_owned(), known);
    }
}

impl Admissions {
    /// What the plan of the session with this token's hash admits.
    pub async fn of(&self, storage: &Storage, token_hash: &str) -> Result<Known, StorageError> {
        if let Some(known) = lock(&self.sessions).get(token_hash) {
            return Ok(known);
        }
        let session = storage.session(token_hash).await?;
        let known = match self.projection(storage, &session).await? {
            Some(study) => {
                let plan = Plan::new(StudyProjection::clone(&study), as_started(&session));
                plan.ok().map(|plan| Arc::new(Admission::of(&plan)))
            }
            None => None,
        };
        lock(&self.sessions).put(token_hash, known.clone());
        Ok(known)
    }

    async fn projection(
        &self,
        storage: &Storage,
        session: &SessionRecord,
    ) -> Result<Option<Arc<StudyProjection>>, StorageError> {
        let key = (session.study_id.clone(), session.config_hash.clone());
        if let Some(study) = lock(&self.studies).get(&key) {
            return Ok(Some(Arc::clone(study)));
        }
        let version = storage.study_version(&session.study_id, &session.config_hash).await?;
        let Some(Ok(version)) = version.as_ref().map(Version::read) else { return Ok(None) };
        let study = Arc::new(version.study.projection());
        lock(&self.studies).insert(key, Arc::clone(&study));
        Ok(Some(study))
    }
}

fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_used_stays_and_what_is_not_is_dropped() {
        let mut kept = Generations::default();
        for number in 0..10 * MOST_SESSIONS {
            kept.put(&number.to_string(), None);
            assert!(kept.get("0").is_some(), "used at {number}");
            assert!(kept.young.len() + kept.old.len() <= 2 * MOST_SESSIONS);
        }
        assert!(kept.get("1").is_none());
    }
}
