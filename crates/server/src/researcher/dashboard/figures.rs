//! Figures over all sessions of a study: where people leave, how long trials take, which frames come
//! late, which attention checks fail.

use std::collections::BTreeMap;
use std::sync::Arc;

use mimique_session::Standing;
use mimique_session::flow::{Plan, StepKind};
use mimique_storage::SessionRecord;

use super::session_view::SessionView;
use crate::export::sources::{Version, as_started};

/// A session and what is said of it.
pub(crate) type Viewed = (SessionRecord, Arc<SessionView>);

/// How a session stands at a time, milliseconds since 1970.
pub(super) fn standing_at((session, view): &Viewed, now_ms: i64) -> Standing {
    view.standing.at(now_ms, session.sign_of_life_due_ms())
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

/// Where people of a condition are and where they leave, in the order of the pages; sessions of other
/// versions and conditions are left out, since their pages may be others.
pub(crate) fn stops(
    version: &Version,
    sessions: &[Viewed],
    condition: Option<&str>,
    now_ms: i64,
) -> Vec<Stop> {
    let is_own = |session: &SessionRecord| {
        session.config_hash == version.config_hash && session.condition.as_deref() == condition
    };
    let own: Vec<_> = sessions.iter().filter(|(session, _)| is_own(session)).collect();
    let Some((first, _)) = own.first() else { return Vec::new() };
    let Ok(plan) = Plan::new(version.study.projection(), as_started(first)) else {
        return Vec::new();
    };
    let labels = plan.steps.iter().map(|step| match &step.kind {
        StepKind::Trial(trial) if trial.training => StopLabel::Practice(trial.number),
        StepKind::Trial(trial) => StopLabel::Trial(trial.number),
        _ => StopLabel::Page(step.id.clone()),
    });
    let labels = labels.chain([StopLabel::End]);
    let mut stops: Vec<Stop> =
        labels.map(|label| Stop { label, reached: 0, here: 0, left: 0 }).collect();
    for viewed in own {
        let view = &viewed.1;
        // Of deleted answers nobody knows where they ended.
        let (Some((done, _)), true) = (view.progress, !viewed.0.is_deleted()) else {
            continue;
        };
        let place = done.min(stops.len() - 1);
        for stop in &mut stops[..=place] {
            stop.reached += 1;
        }
        match standing_at(viewed, now_ms) {
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
    stops
}

/// How long trials took: all of them first, then each place.
pub(crate) fn trial_times<'a>(views: impl Iterator<Item = &'a SessionView>) -> Vec<Times> {
    let mut by_number: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    for trial in views.flat_map(|view| &view.trials) {
        if let Some(duration) = trial.duration_ms {
            by_number.entry(trial.number).or_default().push(duration / 1000.0);
            by_number.entry(0).or_default().push(duration / 1000.0);
        }
    }
    by_number
        .into_iter()
        .map(|(number, mut seconds)| {
            seconds.sort_by(f64::total_cmp);
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
pub(crate) fn frames<'a>(views: impl Iterator<Item = &'a SessionView>) -> Vec<Frames> {
    let mut by_device: BTreeMap<&str, Frames> = BTreeMap::new();
    for view in views.filter(|view| view.trials.iter().any(|trial| trial.frames > 0)) {
        let empty = Frames { device: view.device.clone(), people: 0, frames: 0, late: 0 };
        let row = by_device.entry(&view.device).or_insert(empty);
        row.people += 1;
        row.frames += view.trials.iter().map(|trial| trial.frames).sum::<u64>();
        row.late += view.trials.iter().map(|trial| trial.late).sum::<u64>();
    }
    by_device.into_values().collect()
}

/// How often each attention check was passed and failed.
pub(crate) fn checks<'a>(views: impl Iterator<Item = &'a SessionView>) -> Vec<(String, u64, u64)> {
    let mut by_question: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
    for (question, passed) in views.flat_map(|view| &view.checks) {
        let row = by_question.entry(question).or_default();
        row.0 += u64::from(*passed);
        row.1 += u64::from(!*passed);
    }
    by_question.into_iter().map(|(id, (passed, failed))| (id.to_owned(), passed, failed)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::session_view::TrialView;
    use super::*;

    fn view(device: &str, trials: &[(u64, f64, u64, u64)], checks: &[bool]) -> SessionView {
        SessionView {
            standing: Standing::Completed,
            progress: None,
            step: String::new(),
            answers: Vec::new(),
            levels: Vec::new(),
            trials: trials
                .iter()
                .map(|&(number, seconds, frames, late)| TrialView {
                    number,
                    duration_ms: Some(seconds * 1000.0),
                    frames,
                    late,
                })
                .collect(),
            checks: checks.iter().map(|passed| ("check".to_owned(), *passed)).collect(),
            device: device.to_owned(),
        }
    }

    #[test]
    fn trials_are_timed_by_place_and_in_all() {
        let views = [
            view("Linux", &[(1, 4.0, 100, 1), (2, 6.0, 100, 0)], &[true]),
            view("Linux", &[(1, 8.0, 50, 5)], &[false]),
            view("Android", &[(1, 5.0, 10, 10)], &[true]),
        ];
        let times = trial_times(views.iter());
        assert_eq!(times.len(), 3);
        assert_eq!((times[0].number, times[0].count, times[0].median_s), (0, 4, 6.0));
        assert_eq!((times[1].count, times[1].low_s, times[1].median_s), (3, 4.0, 5.0));
        assert_eq!(times[1].high_s, 8.0);
        let frames = frames(views.iter());
        let rows: Vec<_> =
            frames.iter().map(|f| (&*f.device, f.people, f.frames, f.late)).collect();
        assert_eq!(rows, [("Android", 1, 10, 10), ("Linux", 2, 250, 6)]);
        assert_eq!(checks(views.iter()), [("check".to_owned(), 2, 1)]);
    }
}
