//! What the researcher's page shows of a study: a page of its sessions, and all of them together.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use mimique_session::Standing;
use mimique_session::flow::Plan;
use mimique_storage::{SessionRecord, Storage};

use super::figures::{self, Counted, Frames, Stop, Times, standing_at};
use super::kept::{AllCounted, Sums};
use super::pace::Pace;
use super::session_sums::SessionSums;
use super::tally::{Distribution, distributions};
use crate::clock::now_ms;
use crate::error::Error;
use crate::export::exclusions;
use crate::export::sources::as_started;
use crate::state::hosted_study::HostedStudy;

/// Participants on a page of the list.
pub(crate) const ON_A_PAGE: usize = 100;

/// What the page shows of a study.
pub(crate) struct Overview {
    pub listed: Listed,
    /// How far the study is, in its stage.
    pub pace: Pace,
    /// How many participants are excluded.
    pub excluded: usize,
    /// Sessions of which newer events are not counted yet.
    pub behind: usize,
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
}

/// Which participants are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Wanted {
    /// Those who stand so alone.
    pub standing: Option<Standing>,
    /// Which page of them, from 0.
    pub page: usize,
}

/// A page of the list of participants, the newest first.
pub(crate) struct Listed {
    pub wanted: Wanted,
    /// How many there are on all pages.
    pub of: usize,
    pub people: Vec<Person>,
}

/// A participant in the list.
pub(crate) struct Person {
    pub session: SessionRecord,
    pub sums: Option<Arc<SessionSums>>,
    pub notice: Notice,
}

/// How a session stands now, and what is to be noticed of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Notice {
    pub standing: Standing,
    /// Events that were sent with another body than is stored.
    pub conflicts: u64,
    pub is_excluded: bool,
}

impl Overview {
    pub async fn load(
        storage: &Storage,
        study: &HostedStudy,
        sums: &Arc<Sums>,
        language: &str,
        wanted: Wanted,
    ) -> Result<Self, Error> {
        let AllCounted { sessions, behind } = sums.of_study(storage, study.id()).await?;
        let now_ms = now_ms();
        let standings = Standing::ALL.map(|standing| {
            let stands_so = |counted: &&Counted| standing_at(&counted.0, now_ms) == standing;
            (standing, sessions.iter().filter(stands_so).count())
        });
        let stage = study.stage().word();
        let done = sessions.iter().filter(|(session, _)| {
            session.standing == Standing::Completed && session.stage == stage
        });
        let ended: Vec<i64> = done.map(|(session, _)| session.ended_ms.unwrap_or(now_ms)).collect();
        let places = study.study().recruitment.participants;
        let places = places.and_then(|places| usize::try_from(places).ok());
        let pace = Pace::of(&ended, places, now_ms);
        let excluded = exclusions(storage, study.id()).await?;
        // Whoever is excluded counts in no figure but the number of participants.
        let kept = || sessions.iter().filter(|(session, _)| !excluded.contains_key(&session.key));
        let used = || kept().filter_map(|(_, sums)| sums.as_deref());
        let completed = kept().filter(|(session, _)| session.standing == Standing::Completed);
        let balance = figures::balance(completed.filter_map(|(_, sums)| sums.as_deref()));
        let distributions = distributions(study.study(), language, &figures::answers(used()));
        let names: Vec<String> =
            study.study().conditions().into_iter().map(str::to_owned).collect();
        let conditions =
            names.iter().map(|name| of_condition(name, study, &sessions, now_ms)).collect();
        let stops = stops(storage, study, sums, &sessions, &names, now_ms).await?;
        let (times, frames) = (figures::trial_times(used()), figures::frames(used()));
        let checks = figures::checks(used());
        let listed = listed(storage, study, &sessions, &excluded, wanted, now_ms).await?;
        Ok(Self {
            listed,
            pace,
            excluded: excluded.len(),
            behind,
            standings: standings.to_vec(),
            balance,
            distributions,
            conditions,
            stops,
            times,
            frames,
            checks,
        })
    }
}

impl Notice {
    /// How a session stands now.
    pub async fn of(storage: &Storage, session: &SessionRecord) -> Result<Self, Error> {
        let conflicts = storage.conflict_count(session.key).await?;
        let excluded = exclusions(storage, &session.study_id).await?;
        Ok(Self {
            standing: session.standing.at(now_ms(), session.sign_of_life_due_ms()),
            conflicts,
            is_excluded: excluded.contains_key(&session.key),
        })
    }
}

/// The page of participants that is wanted; the last one where there are not so many.
async fn listed(
    storage: &Storage,
    study: &HostedStudy,
    sessions: &[Counted],
    excluded: &BTreeMap<i64, String>,
    wanted: Wanted,
    now_ms: i64,
) -> Result<Listed, Error> {
    let is_listed = |(session, _): &&Counted| {
        wanted.standing.is_none_or(|standing| standing_at(session, now_ms) == standing)
    };
    // The newest first: they are the ones to be watched.
    let all: Vec<&Counted> = sessions.iter().rev().filter(is_listed).collect();
    let page = wanted.page.min(all.len().saturating_sub(1) / ON_A_PAGE);
    let on_page = || all.iter().skip(page * ON_A_PAGE).take(ON_A_PAGE);
    let numbers: Vec<u64> = on_page().map(|(session, _)| session.participant).collect();
    let records = storage.sessions_of(study.id(), &numbers).await?;
    let mut records: HashMap<i64, SessionRecord> =
        records.into_iter().map(|record| (record.key, record)).collect();
    let conflicts: HashMap<i64, u64> =
        storage.conflict_counts(study.id()).await?.into_iter().collect();
    let people = on_page()
        .filter_map(|(state, sums)| {
            let notice = Notice {
                standing: standing_at(state, now_ms),
                conflicts: conflicts.get(&state.key).copied().unwrap_or(0),
                is_excluded: excluded.contains_key(&state.key),
            };
            Some(Person { session: records.remove(&state.key)?, sums: sums.clone(), notice })
        })
        .collect();
    Ok(Listed { wanted: Wanted { page, ..wanted }, of: all.len(), people })
}

/// How many have completed this version in a condition, and how many are in progress.
fn of_condition(
    name: &str,
    study: &HostedStudy,
    sessions: &[Counted],
    now_ms: i64,
) -> (String, [usize; 2]) {
    let standing_so = |standing: Standing| {
        let is_own = |counted: &&Counted| {
            counted.0.config_hash == study.config_hash()
                && counted.0.condition.as_deref() == Some(name)
                && standing_at(&counted.0, now_ms) == standing
        };
        sessions.iter().filter(is_own).count()
    };
    (name.to_owned(), [Standing::Completed, Standing::InProgress].map(standing_so))
}

/// Where people are and where they leave, by condition.
async fn stops(
    storage: &Storage,
    study: &HostedStudy,
    sums: &Sums,
    sessions: &[Counted],
    conditions: &[String],
    now_ms: i64,
) -> Result<Vec<(Option<String>, Vec<Stop>)>, Error> {
    let mut groups: Vec<Option<String>> = conditions.iter().cloned().map(Some).collect();
    if groups.is_empty() {
        groups.push(None);
    }
    let Some(counter) = sums.counter(storage, study.id(), study.config_hash()).await? else {
        return Ok(Vec::new());
    };
    let mut all = Vec::new();
    for group in groups {
        let is_own = |counted: &&Counted| {
            counted.0.config_hash == study.config_hash() && counted.0.condition == group
        };
        let mut own = sessions.iter().filter(is_own).peekable();
        let Some((first, _)) = own.peek() else { continue };
        let first = storage.participant_session(study.id(), first.participant).await?;
        let Ok(plan) = Plan::new(counter.projection.clone(), as_started(&first)) else { continue };
        let stops = figures::stops(&plan, own, now_ms);
        all.push((group, stops));
    }
    Ok(all)
}
