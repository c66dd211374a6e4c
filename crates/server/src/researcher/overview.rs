//! What the researcher's page shows of a study: its sessions, and all of them together.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

use super::distribution::{Distribution, distributions};
use super::session_view::{SessionView, Standing};
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
    pub sessions: Vec<(SessionRecord, Arc<SessionView>)>,
    /// Sessions by standing, all four named.
    pub standings: Vec<(Standing, usize)>,
    /// Finished trials of participants who completed, by factor and level; factors of
    /// one level are left out.
    pub balance: BTreeMap<String, BTreeMap<String, u64>>,
    pub distributions: Vec<Distribution>,
    /// Events that were sent with another body than is stored, by session.
    pub conflicts: HashMap<i64, u64>,
}

impl Overview {
    pub async fn load(
        storage: &Storage,
        study: &HostedStudy,
        views: &SessionViews,
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
        let mut balance: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
        let complete = sessions.iter().filter(|(_, view)| view.standing == Standing::Completed);
        for (factor, level) in complete.flat_map(|(_, view)| &view.levels) {
            *balance.entry(factor.clone()).or_default().entry(level.clone()).or_default() += 1;
        }
        // A factor that has one level everywhere can only be in balance.
        balance.retain(|_, levels| levels.len() > 1);
        let language = study.study().default_language();
        let answers = sessions.iter().flat_map(|(_, view)| &view.answers);
        let distributions = distributions(study.study(), language, answers);
        let conflicts = storage.conflict_counts(study.id()).await?.into_iter().collect();
        Ok(Self { sessions, standings: standings.to_vec(), balance, distributions, conflicts })
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
