//! Makes the sums of sessions that have come to rest, as long as the server runs: half the time of one
//! processor at most.

use std::collections::{HashMap, HashSet};
use std::time::{Duration, Instant};

use mimique_storage::{KeptSums, SessionRecord, StorageError};

use super::session_sums::FORM;
use crate::clock::now_ms;
use crate::state::App;

/// Sessions without an event for so long have come to rest.
const REST_MS: i64 = 60_000;
/// They are looked for this often.
const EVERY: Duration = Duration::from_secs(5);
/// Sessions that are counted in one go.
const AT_ONCE: u32 = 32;

/// Where the looking is in each study, and what cannot be counted.
#[derive(Default)]
struct Keeper {
    /// Key of the last session that was looked at, by study.
    last: HashMap<String, i64>,
    told: HashSet<i64>,
}

/// Keeps the sums until the server stops.
pub(crate) async fn keep(app: App) {
    let mut keeper = Keeper::default();
    loop {
        let began = Instant::now();
        let found = match keeper.some(&app).await {
            Ok(found) => found,
            Err(error) => {
                tracing::warn!("the sums of the dashboard cannot be kept: {error}");
                0
            }
        };
        app.sums.forget_old();
        let pause = if found > 0 { began.elapsed() } else { EVERY };
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = app.pulse.stopped() => break,
        }
    }
}

impl Keeper {
    /// Keeps the sums of some sessions of each study; how many there were.
    async fn some(&mut self, app: &App) -> Result<usize, StorageError> {
        let mut found = 0;
        for study in app.catalogue.studies() {
            let last = self.last.entry(study.id().to_owned()).or_default();
            let before_ms = now_ms() - REST_MS;
            let sessions =
                app.storage.sessions_to_sum(study.id(), FORM, before_ms, *last, AT_ONCE).await?;
            // Behind the last one it begins anew.
            *last = sessions.last().map_or(0, |session| session.key);
            found += sessions.len();
            let mut kept = Vec::with_capacity(sessions.len());
            for session in sessions {
                kept.extend(self.one(app, session).await);
            }
            // One commit for all of them: participants' answers wait for the same disk.
            app.storage.keep_sums(FORM, &kept).await?;
        }
        Ok(found)
    }

    /// The sums of a session; none where they cannot be made.
    async fn one(&mut self, app: &App, session: SessionRecord) -> Option<KeptSums> {
        let key = session.key;
        match app.sums.count_in_thread(&app.storage, vec![session]).await {
            Ok(made) => made.into_iter().next().map(|(kept, _)| kept),
            // Whoever looks at the dashboard is told.
            Err(error) => {
                if self.told.insert(key) {
                    tracing::warn!("session key {key} cannot be counted: {error:?}");
                }
                None
            }
        }
    }
}
