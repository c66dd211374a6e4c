//! Tells open dashboards that something has changed: the database is asked once a second, for all of
//! them together and only while there is one, so that changes by other servers are seen too.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::watch;

use mimique_storage::Storage;

/// How often the database is asked.
const BEAT: Duration = Duration::from_secs(1);

/// Streams of one account at once: browsers open six to one server at most.
const MOST_STREAMS: usize = 24;

/// What differs after every change, by study.
pub(crate) type Beats = BTreeMap<String, String>;

/// Source of beats; cheap to clone.
#[derive(Clone)]
pub(crate) struct Pulse {
    storage: Storage,
    sender: Arc<Mutex<Option<watch::Sender<Beats>>>>,
    stopping: Arc<watch::Sender<bool>>,
    streams: Arc<Mutex<BTreeMap<i64, usize>>>,
}

/// A stream's place among those of its account; free again when dropped.
pub(crate) struct Place {
    streams: Arc<Mutex<BTreeMap<i64, usize>>>,
    account: i64,
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut streams = self.streams.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(open) = streams.get_mut(&self.account) {
            *open -= 1;
            if *open == 0 {
                streams.remove(&self.account);
            }
        }
    }
}

impl Pulse {
    pub fn new(storage: Storage) -> Self {
        let stopping = Arc::new(watch::Sender::new(false));
        Self { storage, sender: Arc::default(), stopping, streams: Arc::default() }
    }

    /// A place for one more stream of this account, unless it has as many as it may.
    pub fn place(&self, account: i64) -> Option<Place> {
        let mut streams = self.streams.lock().unwrap_or_else(PoisonError::into_inner);
        let open = streams.entry(account).or_default();
        if *open >= MOST_STREAMS {
            return None;
        }
        *open += 1;
        Some(Place { streams: Arc::clone(&self.streams), account })
    }

    /// Beats from now on.
    pub fn listen(&self) -> watch::Receiver<Beats> {
        let mut place = self.sender.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(sender) = &*place {
            return sender.subscribe();
        }
        let (sender, receiver) = watch::channel(Beats::new());
        *place = Some(sender.clone());
        tokio::spawn(self.clone().beat(sender));
        receiver
    }

    /// Ends every open dashboard's stream, so that the server can stop.
    pub fn stop(&self) {
        self.stopping.send_replace(true);
    }

    /// Resolves when the server stops.
    pub async fn stopped(&self) {
        // The sender lives as long as this.
        let _ = self.stopping.subscribe().wait_for(|stopping| *stopping).await;
    }

    async fn beat(self, sender: watch::Sender<Beats>) {
        loop {
            // A database that does not answer is asked again at the next beat.
            if let Ok(beats) = self.storage.pulse().await {
                let beats: Beats = beats.into_iter().collect();
                sender.send_if_modified(|now| {
                    let changed = *now != beats;
                    *now = beats;
                    changed
                });
            }
            tokio::select! {
                () = tokio::time::sleep(BEAT) => {}
                () = self.stopped() => break,
            }
            let mut place = self.sender.lock().unwrap_or_else(PoisonError::into_inner);
            if sender.receiver_count() == 0 {
                *place = None;
                break;
            }
        }
    }
}
