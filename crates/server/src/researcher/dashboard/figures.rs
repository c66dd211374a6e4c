//! Figures over all sessions of a study: where people leave, how long trials take, which frames come
//! late, which attention checks fail.

use std::collections::BTreeMap;
use std::sync::Arc;

use mimique_session::Standing;
use mimique_session::flow::{Plan, StepKind};
use mimique_storage::SessionState;

use super::session_sums::SessionSums;
use super::tally::Tally;

/// A session and what is counted of it; nothing of one that was deleted, or that nobody has counted yet.
pub(crate) type Counted = (SessionState, Option<Arc<SessionSums>>);

/// How a session stands at a time, milliseconds since 1970.
pub(crate) fn standing_at(session: &SessionState, now_ms: i64) -> Standing {
    session.standing.at(now_ms, session.sign_of_life_due_ms)
}

/// One step of the way through the study.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stop {
    pub label: StopLabel,
    /// How many came here.
    pub reached: u64,
    /// How many are here now.
    pub here: u64,
    /// How many came no further: declined, not taken by the study, or without a sign of life.
    pub left: u64,
}

/// What stands there.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum StopLabel {
    /// A page, by its identifier.
    Page(String),
    /// A practice trial.
    Practice(usize),
    /// A trial, by its place: which clip stands there differs.
    Trial(usize),
    /// Everything done.
    End,
}

/// Seconds that trials took.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Times {
    /// Place among the trials; 0 for all of them.
    pub number: u64,
    pub count: usize,
    pub low_s: f64,
    pub median_s: f64,
    pub high_s: f64,
}

/// Frames on one class of devices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frames {
    pub device: String,
    pub people: u64,
    pub frames: u64,
    pub late: u64,
}

/// Where those people are and where they leave, in the order of the pages of a plan: people of one version
/// and condition, since the pages of others may be others.
pub(crate) fn stops<'c>(
    plan: &Plan,
    sessions: impl Iterator<Item = &'c Counted>,
    now_ms: i64,
) -> Vec<Stop> {
    let labels = plan.steps.iter().map(|step| match &step.kind {
        StepKind::Trial(trial) if trial.training => StopLabel::Practice(trial.number),
        StepKind::Trial(trial) => StopLabel::Trial(trial.number),
        _ => StopLabel::Page(step.id.clone()),
    });
    let labels = labels.chain([StopLabel::End]);
    let mut stops: Vec<Stop> =
        labels.map(|label| Stop { label, reached: 0, here: 0, left: 0 }).collect();
    for (session, sums) in sessions {
        // Of deleted answers nobody knows where they ended.
        let progress = sums.as_ref().and_then(|sums| sums.progress);
        let (Some((done, _)), false) = (progress, session.is_deleted) else { continue };
        let place = done.min(stops.len() - 1);
        stops[place].reached += 1;
        match standing_at(session, now_ms) {
            Standing::InProgress => stops[place].here += 1,
            Standing::Completed | Standing::Withdrawn => {}
            Standing::Abandoned
            | Standing::Declined
            | Standing::DeviceRefused
            | Standing::ScreenedOut
            | Standing::PracticeFailed
            | Standing::ChecksFailed => stops[place].left += 1,
        }
    }
    // Whoever came to a page came to all before it.
    let mut beyond = 0;
    for stop in stops.iter_mut().rev() {
        stop.reached += beyond;
        beyond = stop.reached;
    }
    stops
}

/// How long trials took: all of them first, then each place.
pub(crate) fn trial_times<'a>(sums: impl Iterator<Item = &'a SessionSums>) -> Vec<Times> {
    let mut by_number: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    for (number, duration_ms) in sums.flat_map(|sums| &sums.trials) {
        if let Some(duration_ms) = duration_ms {
            by_number.entry(*number).or_default().push(duration_ms / 1000.0);
        }
    }
    let all: Vec<f64> = by_number.values().flatten().copied().collect();
    if !all.is_empty() {
        // No trial has this number.
        by_number.insert(0, all);
    }
    by_number
        .into_iter()
        .map(|(number, mut seconds)| {
            seconds.sort_unstable_by(f64::total_cmp);
            let at = |share: f64| seconds[(share * (seconds.len() - 1) as f64).round() as usize];
            Times {
                number,
                count: seconds.len(),
                low_s: at(0.1),
                median_s: at(0.5),
                high_s: at(0.9),
            }
        })
        .collect()
}

/// Frames shown and late, by class of device.
pub(crate) fn frames<'a>(sums: impl Iterator<Item = &'a SessionSums>) -> Vec<Frames> {
    let mut by_device: BTreeMap<&str, Frames> = BTreeMap::new();
    for session in sums.filter(|sums| sums.frames > 0) {
        let empty = Frames { device: session.device.clone(), people: 0, frames: 0, late: 0 };
        let row = by_device.entry(&session.device).or_insert(empty);
        row.people += 1;
        row.frames += session.frames;
        row.late += session.late;
    }
    by_device.into_values().collect()
}

/// How often each attention check was passed and failed.
pub(crate) fn checks<'a>(sums: impl Iterator<Item = &'a SessionSums>) -> Vec<(String, u64, u64)> {
    let mut by_question: BTreeMap<&str, [u64; 2]> = BTreeMap::new();
    for (question, [passed, failed]) in sums.flat_map(|sums| &sums.checks) {
        let row = by_question.entry(question).or_default();
        row[0] += passed;
        row[1] += failed;
    }
    let row = |(id, [passed, failed]): (&str, [u64; 2])| (id.to_owned(), passed, failed);
    by_question.into_iter().map(row).collect()
}

/// The answers to each response, added up.
pub(crate) fn answers<'a>(sums: impl Iterator<Item = &'a SessionSums>) -> BTreeMap<String, Tally> {
    let mut all: BTreeMap<String, Tally> = BTreeMap::new();
    for (response, tally) in sums.flat_map(|sums| &sums.answers) {
        match all.get_mut(response) {
            Some(known) => known.add(tally),
            None => drop(all.insert(response.clone(), tally.clone())),
        }
    }
    all
}

/// Finished trials by factor and level. A factor that has one level everywhere can only be in balance, and is
/// left out.
pub(crate) fn balance<'a>(
    sums: impl Iterator<Item = &'a SessionSums>,
) -> BTreeMap<String, BTreeMap<String, u64>> {
    let mut balance: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
    for (factor, levels) in sums.flat_map(|sums| &sums.levels) {
        let all = balance.entry(factor.clone()).or_default();
        for (level, count) in levels {
            *all.entry(level.clone()).or_default() += count;
        }
    }
    balance.retain(|_, levels| levels.len() > 1);
    balance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(device: &str, trials: &[(u64, f64)], frames: (u64, u64), passed: bool) -> SessionSums {
        let trials = trials.iter().map(|(number, seconds)| (*number, Some(seconds * 1000.0)));
        let check = if passed { [1, 0] } else { [0, 1] };
        SessionSums {
            trials: trials.collect(),
            frames: frames.0,
            late: frames.1,
            checks: BTreeMap::from([("check".to_owned(), check)]),
            device: device.to_owned(),
            ..SessionSums::default()
        }
    }

    #[test]
    fn trials_are_timed_by_place_and_in_all() {
        let people = [
            sums("Linux", &[(1, 4.0), (2, 6.0)], (200, 1), true),
            sums("Linux", &[(1, 8.0)], (50, 5), false),
            sums("Android", &[(1, 5.0)], (10, 10), true),
            sums("Windows", &[], (0, 0), true),
        ];
        let times = trial_times(people.iter());
        assert_eq!(times.len(), 3);
        assert_eq!((times[0].number, times[0].count, times[0].median_s), (0, 4, 6.0));
        assert_eq!((times[1].count, times[1].low_s, times[1].median_s), (3, 4.0, 5.0));
        assert_eq!(times[1].high_s, 8.0);
        let frames = frames(people.iter());
        let rows: Vec<_> =
            frames.iter().map(|f| (&*f.device, f.people, f.frames, f.late)).collect();
        assert_eq!(rows, [("Android", 1, 10, 10), ("Linux", 2, 250, 6)]);
        assert_eq!(checks(people.iter()), [("check".to_owned(), 3, 1)]);
    }
}
