//! What the researcher's page shows of a study: its sessions, and all of them together.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

use super::distribution::{Distribution, distributions};
use super::figures::{self, Frames, Stop, Times, Viewed};
use super::session_view::{SessionView, Standing};
use crate::clock::now_ms;
use crate::error::Error;
use crate::export::Sources;
use crate::hosted::HostedStudy;
use crate::storage::{SessionRecord, Storage};

/// Views of sessions, made again only when a session has changed.
#[derive(Default)]
pub(crate) struct SessionViews {
    views: Mutex<HashMap<i64, (SessionRecord, Arc<SessionView>)>>,
}

/// What the page shows of a study.
pub(crate) struct Overview {
    pub sessions: Vec<Viewed>,
    /// Reason of each exclusion that counts now, by session.
    pub excluded: BTreeMap<i64, String>,
    /// Sessions by standing, all four named.
    pub standings: Vec<(Standing, usize)>,
    /// Finished trials of participants who completed, by factor and level; factors of
    /// one level are left out.
    pub balance: BTreeMap<String, BTreeMap<String, u64>>,
    pub distributions: Vec<Distribution>,
    /// Each condition between participants: how many have come to the end, how many are under way. Of
    /// this version; empty in a study without.
    pub conditions: Vec<(String, [usize; 2])>,
    /// Where people are and where they leave, by condition; empty where nobody is.
    pub stops: Vec<(Option<String>, Vec<Stop>)>,
    /// How long trials took.
    pub times: Vec<Times>,
    /// Late frames by class of device.
    pub frames: Vec<Frames>,
    /// Each attention check: how often passed, how often failed.
    pub checks: Vec<(String, u64, u64)>,
    /// Events that were sent with another body than is stored, by session.
    pub conflicts: HashMap<i64, u64>,
}

impl Overview {
    pub async fn load(
        storage: &Storage,
        study: &HostedStudy,
        views: &SessionViews,
        language: &str,
    ) -> Result<Self, Error> {
        let sources = Sources::load(storage, study.id(), false).await?;
        let mut sessions = Vec::with_capacity(sources.sessions.len());
        for session in &sources.sessions {
            let view = match views.known(session) {
                Some(view) => view,
                None => {
                    let version = sources.version(&session.config_hash)?;
                    let events = storage.events(session.key).await?;
                    views.keep(session, SessionView::new(version, session, &events))
                }
            };
            sessions.push((session.clone(), view));
        }
        let standings = Standing::ALL.map(|standing| {
            let count = sessions.iter().filter(|(_, view)| view.standing == standing).count();
            (standing, count)
        });
        let excluded = sources.excluded().clone();
        // Whoever is excluded counts in no figure but the number of participants.
        let used = || {
            let kept = sessions.iter().filter(|(session, _)| !excluded.contains_key(&session.key));
            kept.map(|(_, view)| &**view)
        };
        let mut balance: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
        let complete = used().filter(|view| view.standing == Standing::Completed);
        for (factor, level) in complete.flat_map(|view| &view.levels) {
            *balance.entry(factor.clone()).or_default().entry(level.clone()).or_default() += 1;
        }
        // A factor that has one level everywhere can only be in balance.
        balance.retain(|_, levels| levels.len() > 1);
        let distributions =
            distributions(study.study(), language, used().flat_map(|view| &view.answers));
        let names: Vec<String> =
            study.study().conditions().into_iter().map(str::to_owned).collect();
        let conditions = names
            .iter()
            .map(|name| {
                let own = || {
                    sessions.iter().filter(|(session, _)| {
                        session.config_hash == study.config_hash()
                            && session.condition.as_ref() == Some(name)
                    })
                };
                let finished = own().filter(|(session, _)| session.finished).count();
                let is_active = |session: &SessionRecord, view: &SessionView| {
                    !session.finished && view.standing == Standing::Active
                };
                let active = own().filter(|(session, view)| is_active(session, view)).count();
                (name.clone(), [finished, active])
            })
            .collect();
        let mut stops = Vec::new();
        if let Ok(version) = sources.version(study.config_hash()) {
            let mut groups: Vec<Option<String>> = names.iter().cloned().map(Some).collect();
            if groups.is_empty() {
                groups.push(None);
            }
            for group in groups {
                let own = figures::stops(version, &sessions, group.as_deref(), now_ms());
                if !own.is_empty() {
                    stops.push((group, own));
                }
            }
        }
        let times = figures::trial_times(used());
        let frames = figures::frames(used());
        let checks = figures::checks(used());
        let conflicts = storage.conflict_counts(study.id()).await?.into_iter().collect();
        Ok(Self {
            sessions,
            excluded,
            standings: standings.to_vec(),
            balance,
            distributions,
            conditions,
            stops,
            times,
            frames,
            checks,
            conflicts,
        })
    }
}

impl SessionViews {
    fn known(&self, session: &SessionRecord) -> Option<Arc<SessionView>> {
        let views = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        views.get(&session.key).filter(|(seen, _)| seen == session).map(|(_, view)| view.clone())
    }

    fn keep(&self, session: &SessionRecord, view: SessionView) -> Arc<SessionView> {
        let view = Arc::new(view);
        let mut views = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        views.insert(session.key, (session.clone(), view.clone()));
        view
    }
}
