//! The sums of all sessions, kept: in the database beside the events, and in memory while somebody looks.
//!
//! They are made once for each state of a session. [`super::keeper`] makes those of sessions that have come to
//! rest; whoever looks at a dashboard before makes the others, as many as can be made at once.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use mimique_storage::{CountedSo, KeptSums, SessionRecord, SessionState, Storage, StorageError};
use tokio::runtime::Handle;
use tokio_stream::StreamExt as _;

use super::figures::Counted;
use super::session_sums::{Counter, FORM, SessionSums};
use crate::error::Error;
use crate::export::sources::Version;

/// Events of sessions that are counted while somebody waits for the dashboard: about a third of a second.
const EVENTS_AT_ONCE: u64 = 20_000;
/// From so many sessions on the kept sums of the whole study are read.
const FEW: usize = 200;
/// What nobody has looked at for so long is no longer held in memory.
const HELD: Duration = Duration::from_secs(15 * 60);

/// The sums that are in memory, and what makes them.
#[derive(Default)]
pub(crate) struct Sums {
    studies: Mutex<HashMap<String, Held>>,
    counters: Mutex<Counters>,
    /// Who looks second finds what the first has counted.
    turn: tokio::sync::Mutex<()>,
}

/// What counts the sessions of each version, by study and hash; none where it is not there any more.
type Counters = HashMap<(String, String), Option<Arc<Counter>>>;

/// The sums of a study's sessions, by key.
type Known = HashMap<i64, (CountedSo, Arc<SessionSums>)>;

struct Held {
    sessions: Known,
    looked_at: Instant,
}

/// The sessions of a study with what is counted of them.
pub(crate) struct AllCounted {
    pub sessions: Vec<Counted>,
    /// Sessions of which newer events are not counted yet.
    pub behind: usize,
}

/// A session, counted.
type Made = (KeptSums, Arc<SessionSums>);

impl Sums {
    /// Every session of a study with its sums.
    pub async fn of_study(
        self: &Arc<Self>,
        storage: &Storage,
        study_id: &str,
    ) -> Result<AllCounted, Error> {
        let _turn = self.turn.lock().await;
        let states = storage.session_states(study_id, FORM).await?;
        let mut known =
            lock(&self.studies).get(study_id).map_or_else(Known::new, |held| held.sessions.clone());
        load(storage, study_id, &states, &mut known).await?;
        let (now, behind) = to_count(&states, &known);
        let sessions = storage.sessions_of(study_id, &now).await?;
        let mut kept = Vec::new();
        for (made, sums) in self.count_in_thread(storage, sessions).await? {
            known.insert(made.session_key, (made.counted, sums));
            kept.push(made);
        }
        storage.keep_sums(FORM, &kept).await?;
        let mut held = Known::with_capacity(known.len());
        let mut sessions: Vec<Counted> = Vec::with_capacity(states.len());
        for state in states {
            // Nothing is held of who is deleted.
            let own = known.remove(&state.key).filter(|_| !state.is_deleted);
            sessions.push((state.clone(), own.as_ref().map(|(_, sums)| Arc::clone(sums))));
            held.extend(own.map(|own| (state.key, own)));
        }
        let held = Held { sessions: held, looked_at: Instant::now() };
        lock(&self.studies).insert(study_id.to_owned(), held);
        Ok(AllCounted { sessions, behind })
    }

    /// The sums of one session as it is now.
    pub async fn of_session(
        self: &Arc<Self>,
        storage: &Storage,
        session: &SessionRecord,
    ) -> Result<Option<Arc<SessionSums>>, Error> {
        if session.is_deleted() {
            return Ok(None);
        }
        let made = self.count_in_thread(storage, vec![session.clone()]).await?;
        Ok(made.into_iter().next().map(|(_, sums)| sums))
    }

    /// What counts the sessions of a version.
    pub async fn counter(
        &self,
        storage: &Storage,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Option<Arc<Counter>>, StorageError> {
        let key = (study_id.to_owned(), config_hash.to_owned());
        if let Some(known) = lock(&self.counters).get(&key) {
            return Ok(known.clone());
        }
        let stored = storage.study_version(study_id, config_hash).await?;
        let version = stored.as_ref().map(Version::read).transpose()?;
        let counter = version.as_ref().and_then(Counter::new).map(Arc::new);
        lock(&self.counters).insert(key, counter.clone());
        Ok(counter)
    }

    /// Counts sessions on a thread of their own: participants' requests do not wait for it.
    pub(super) async fn count_in_thread(
        self: &Arc<Self>,
        storage: &Storage,
        sessions: Vec<SessionRecord>,
    ) -> Result<Vec<Made>, Error> {
        if sessions.is_empty() {
            return Ok(Vec::new());
        }
        let (sums, storage, runtime) = (Arc::clone(self), storage.clone(), Handle::current());
        let work = move || runtime.block_on(async move { sums.count(&storage, &sessions).await });
        Ok(tokio::task::spawn_blocking(work).await.map_err(Error::internal)??)
    }

    async fn count(
        &self,
        storage: &Storage,
        sessions: &[SessionRecord],
    ) -> Result<Vec<Made>, StorageError> {
        let mut made = Vec::with_capacity(sessions.len());
        for session in sessions {
            let (study, version) = (&session.study_id, &session.config_hash);
            let sums = match self.counter(storage, study, version).await? {
                Some(counter) => counter.count(storage, session).await?,
                None => SessionSums::default(),
            };
            let text = serde_json::to_string(&sums).unwrap_or_default();
            let (session_key, counted) = (session.key, session.counted());
            made.push((KeptSums { session_key, counted, sums: text }, Arc::new(sums)));
        }
        Ok(made)
    }

    /// Gives the memory back that holds what nobody looks at any more.
    pub(super) fn forget_old(&self) {
        let mut studies = lock(&self.studies);
        studies.retain(|_, held| held.looked_at.elapsed() < HELD);
        studies.shrink_to_fit();
    }
}

/// Reads what is kept in the database and not known yet. What cannot be read is made anew.
async fn load(
    storage: &Storage,
    study_id: &str,
    states: &[SessionState],
    known: &mut Known,
) -> Result<(), StorageError> {
    let is_wanted = |state: &&SessionState| {
        let own = known.get(&state.key).map(|(counted, _)| *counted);
        !state.is_deleted
            && own != Some(state.counted)
            && state.summed.is_some()
            && own != state.summed
    };
    let keys: Vec<i64> = states.iter().filter(is_wanted).map(|state| state.key).collect();
    let mut take = |kept: KeptSums| {
        if let Ok(sums) = serde_json::from_str(&kept.sums) {
            known.insert(kept.session_key, (kept.counted, Arc::new(sums)));
        }
    };
    if keys.len() > FEW {
        let mut kept = storage.kept_sums(study_id, FORM);
        while let Some(kept) = kept.next().await {
            take(kept?);
        }
    } else {
        storage.kept_sums_of(&keys, FORM).await?.into_iter().for_each(take);
    }
    Ok(())
}

/// Participants whose sessions are to be counted now, first those of whom most is missing; and how many there
/// are besides.
fn to_count(states: &[SessionState], known: &Known) -> (Vec<u64>, usize) {
    let mut stale: Vec<(u64, u64, u64)> = Vec::new();
    for state in states.iter().filter(|state| !state.is_deleted) {
        let own = known.get(&state.key).map(|(counted, _)| *counted);
        if own != Some(state.counted) {
            let events = state.counted.event_count;
            let missing = events.saturating_sub(own.map_or(0, |own| own.event_count));
            stale.push((missing, state.participant, events));
        }
    }
    stale.sort_unstable_by(|left, right| right.cmp(left));
    let (mut events, mut now) = (0, Vec::new());
    for (_, participant, of_session) in &stale {
        // One at least, however large it is.
        if now.is_empty() || events + of_session <= EVENTS_AT_ONCE {
            events += of_session;
            now.push(*participant);
        }
    }
    let behind = stale.len() - now.len();
    (now, behind)
}

fn lock<T>(shared: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
