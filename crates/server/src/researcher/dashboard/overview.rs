//! What the researcher's page shows of a study: its sessions, and all of them together.

use mimique_storage::{SessionRecord, Storage};
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

use super::distribution::{Distribution, distributions};
use super::figures::{self, Frames, Stop, Times, Viewed, standing_at};
use super::session_view::SessionView;
use mimique_session::Standing;

use crate::clock::now_ms;
use crate::error::Error;
use crate::export::sources::{Sources, Version};
use crate::state::hosted_study::HostedStudy;

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
    /// When this was looked at, milliseconds since 1970: who gives no sign of life for long enough has
    /// left.
    now_ms: i64,
    /// Sessions by standing, every one named.
    pub standings: Vec<(Standing, usize)>,
    /// Finished trials of participants who completed, by factor and level; factors of
    /// one level are left out.
    pub balance: BTreeMap<String, BTreeMap<String, u64>>,
    pub distributions: Vec<Distribution>,
    /// Each condition between participants: how many have completed, how many are in progress. Of
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

/// Every session with what there is to see of it.
async fn viewed(
    storage: &Storage,
    sources: &Sources,
    views: &SessionViews,
) -> Result<Vec<Viewed>, Error> {
    let mut sessions = Vec::with_capacity(sources.sessions.len());
    for session in &sources.sessions {
        let view = match views.known(session) {
            Some(view) => view,
            None => {
                let version = sources.version(&session.config_hash)?;
                let events = storage.counted_events(session.key).await?;
                views.keep(session, SessionView::new(version, session, &events))
            }
        };
        sessions.push((session.clone(), view));
    }
    Ok(sessions)
}

/// Finished trials of those who completed, by factor and level. A factor that has one level everywhere can
/// only be in balance, and is left out.
fn balance<'v>(
    used: impl Iterator<Item = &'v SessionView>,
) -> BTreeMap<String, BTreeMap<String, u64>> {
    let mut balance: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
    let complete = used.filter(|view| view.standing == Standing::Completed);
    for (factor, level) in complete.flat_map(|view| &view.levels) {
        *balance.entry(factor.clone()).or_default().entry(level.clone()).or_default() += 1;
    }
    balance.retain(|_, levels| levels.len() > 1);
    balance
}

/// How many have completed this version in a condition, and how many are in progress.
fn of_condition(
    name: &str,
    study: &HostedStudy,
    sessions: &[Viewed],
    now_ms: i64,
) -> (String, [usize; 2]) {
    let standing_so = |standing: Standing| {
        let is_own = |viewed: &&Viewed| {
            viewed.0.config_hash == study.config_hash()
                && viewed.0.condition.as_deref() == Some(name)
                && standing_at(viewed, now_ms) == standing
        };
        sessions.iter().filter(is_own).count()
    };
    (name.to_owned(), [Standing::Completed, Standing::InProgress].map(standing_so))
}

/// Where people are and where they leave, by condition.
fn stops(
    version: &Version,
    sessions: &[Viewed],
    conditions: &[String],
    now_ms: i64,
) -> Vec<(Option<String>, Vec<Stop>)> {
    let mut groups: Vec<Option<String>> = conditions.iter().cloned().map(Some).collect();
    if groups.is_empty() {
        groups.push(None);
    }
    let of = |group: Option<String>| {
        let own = figures::stops(version, sessions, group.as_deref(), now_ms);
        (group, own)
    };
    groups.into_iter().map(of).filter(|(_, own)| !own.is_empty()).collect()
}

impl Overview {
    pub async fn load(
        storage: &Storage,
        study: &HostedStudy,
        views: &SessionViews,
        language: &str,
    ) -> Result<Self, Error> {
        let sources = Sources::load(storage, study.id(), false).await?;
        let sessions = viewed(storage, &sources, views).await?;
        let now_ms = now_ms();
        let standings = Standing::ALL.map(|standing| {
            let stands_so = |viewed: &&Viewed| standing_at(viewed, now_ms) == standing;
            (standing, sessions.iter().filter(stands_so).count())
        });
        let excluded = sources.excluded().clone();
        // Whoever is excluded counts in no figure but the number of participants.
        let used = || {
            let kept = sessions.iter().filter(|(session, _)| !excluded.contains_key(&session.key));
            kept.map(|(_, view)| &**view)
        };
        let balance = balance(used());
        let distributions =
            distributions(study.study(), language, used().flat_map(|view| &view.answers));
        let names: Vec<String> =
            study.study().conditions().into_iter().map(str::to_owned).collect();
        let conditions =
            names.iter().map(|name| of_condition(name, study, &sessions, now_ms)).collect();
        let stops = match sources.version(study.config_hash()) {
            Ok(version) => stops(version, &sessions, &names, now_ms),
            Err(_) => Vec::new(),
        };
        let times = figures::trial_times(used());
        let frames = figures::frames(used());
        let checks = figures::checks(used());
        let conflicts = storage.conflict_counts(study.id()).await?.into_iter().collect();
        Ok(Self {
            sessions,
            excluded,
            now_ms,
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

impl Overview {
    /// How a session stands now.
    pub fn standing(&self, session: &SessionRecord, view: &SessionView) -> Standing {
        view.standing.at(self.now_ms, session.sign_of_life_due_ms())
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
