//! Answers whose time is over are deleted: `consent.retentionDays` of the version they were given
//! under, counted from the end of the session, or from its last sign of life.
//!
//! A wrong clock must not delete anything. So there are two witnesses of the time, the latest time that
//! was believed and the newest event; where the clock contradicts them by days nothing is deleted until an
//! owner says that it is right. And what is over its time is marked first and deleted a week later: until
//! then an owner can keep it, no backup is touched, and a clock that is put right takes the marks away.

use std::time::{Duration, Instant, SystemTime};

use mimique_storage::{Storage, StorageError, TimesSeen};
use serde_json::Value;

use crate::clock;
use crate::state::App;

const DAY_MS: i64 = 24 * 3600 * 1000;
/// From the mark to the deletion.
pub(crate) const GRACE_MS: i64 = 7 * DAY_MS;
/// How far the clock may have gone on since it was last believed: a weekend without power.
const LARGEST_STEP_MS: i64 = 4 * DAY_MS;
/// How far it may lie behind what it has shown before.
const LARGEST_STEP_BACK_MS: i64 = DAY_MS;
/// How often the server looks.
const INTERVAL: Duration = Duration::from_secs(3600);
/// How far the clock may have drifted from the machine's steady one before it is not believed.
const LARGEST_JUMP: Duration = Duration::from_secs(3600);

/// Why the clock is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClockDoubt {
    /// The time that was seen before, milliseconds since 1970.
    pub seen_ms: i64,
    /// The time that the clock shows.
    pub now_ms: i64,
}

/// What came of looking for answers whose time is over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Sweep {
    /// Nothing was looked at: the clock contradicts what the database knows.
    Doubted(ClockDoubt),
    /// What was found, study by study.
    Done(Vec<Swept>),
}

/// What was found of a study.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Swept {
    /// Its identifier.
    pub study: String,
    /// Sessions that were found to be over their time: deleted in a week.
    pub marked: u64,
    /// Sessions that were emptied, their week being over.
    pub erased: u64,
}

/// Why the clock is not believed, if it is not.
pub async fn clock_doubt(
    storage: &Storage,
    now_ms: i64,
) -> Result<Option<ClockDoubt>, StorageError> {
    Ok(doubt(storage.times_seen().await?, now_ms))
}

fn doubt(seen: TimesSeen, now_ms: i64) -> Option<ClockDoubt> {
    let newest_ms = seen.newest_ms.filter(|newest| Some(*newest) > seen.passed_over_ms);
    let ahead = |seen_ms: &i64| *seen_ms - now_ms > LARGEST_STEP_BACK_MS;
    if let Some(seen_ms) = seen.believed_ms.into_iter().chain(newest_ms).find(ahead) {
        return Some(ClockDoubt { seen_ms, now_ms });
    }
    let before = seen.believed_ms.or(newest_ms)?;
    (now_ms - before > LARGEST_STEP_MS).then_some(ClockDoubt { seen_ms: before, now_ms })
}

/// An owner says that the clock is right.
pub async fn confirm_clock(storage: &Storage, now_ms: i64) -> Result<(), StorageError> {
    if let Some(newest_ms) = storage.times_seen().await?.newest_ms {
        storage.pass_over_events_until(newest_ms).await?;
    }
    storage.believe_time(now_ms).await
}

/// Marks what is over its time, and deletes what has been marked for a week.
pub async fn sweep_overdue(storage: &Storage, now_ms: i64) -> Result<Sweep, StorageError> {
    if let Some(doubt) = clock_doubt(storage, now_ms).await? {
        return Ok(Sweep::Doubted(doubt));
    }
    storage.believe_time(now_ms).await?;
    let mut swept: Vec<Swept> = Vec::new();
    for version in storage.study_versions().await? {
        let file: Value = serde_json::from_str(&version.file).unwrap_or_default();
        let Some(days) = file["consent"]["retentionDays"].as_i64().filter(|days| *days > 0) else {
            continue;
        };
        let before = now_ms.saturating_sub(days.saturating_mul(DAY_MS));
        let (study, hash) = (&version.study_id, &version.config_hash);
        let marked = storage.mark_overdue(study, hash, before, now_ms).await?;
        let erased = storage.erase_marked(study, hash, now_ms - GRACE_MS, now_ms).await?;
        if swept.last().is_none_or(|last| last.study != *study) {
            swept.push(Swept { study: study.clone(), ..Swept::default() });
        }
        if let Some(own) = swept.last_mut() {
            own.marked += marked;
            own.erased += erased;
        }
    }
    Ok(Sweep::Done(swept))
}

/// Looks every hour until the server stops. A clock that has jumped since the start deletes nothing.
pub(crate) async fn watch(app: App) {
    let (steady, wall) = (Instant::now(), SystemTime::now());
    loop {
        let gone = SystemTime::now().duration_since(wall).unwrap_or_default();
        if gone.abs_diff(steady.elapsed()) > LARGEST_JUMP {
            tracing::warn!(
                "the clock has jumped: nothing is deleted for its age until the next start"
            );
        } else {
            match sweep_overdue(&app.storage, clock::now_ms()).await {
                Ok(sweep) => say(&sweep),
                Err(error) => tracing::warn!("looking for overdue answers: {error}"),
            }
        }
        tokio::time::sleep(INTERVAL).await;
    }
}

fn say(sweep: &Sweep) {
    let swept = match sweep {
        Sweep::Doubted(ClockDoubt { seen_ms, now_ms }) => {
            let days = (now_ms - seen_ms) / DAY_MS;
            return tracing::warn!(
                "the clock has gone {days} days since it was last seen: nothing is deleted for its \
                 age until an owner says on the page /researcher that the clock is right"
            );
        }
        Sweep::Done(swept) => swept,
    };
    for Swept { study, marked, erased } in swept {
        if *marked > 0 {
            tracing::info!(
                "study {study}: the answers of {marked} sessions are over their time and will be \
                 deleted in a week; an owner can keep them until then"
            );
        }
        if *erased > 0 {
            tracing::info!(
                "study {study}: the answers of {erased} sessions were deleted, their time being over"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_is_believed_that_no_witness_contradicts() {
        const NOW: i64 = 1_800_000_000_000;
        let seen = |newest: Option<i64>, believed: Option<i64>, passed_over: Option<i64>| {
            let at = |days: i64| NOW + days * DAY_MS;
            let (newest_ms, believed_ms) = (newest.map(at), believed.map(at));
            TimesSeen { newest_ms, believed_ms, passed_over_ms: passed_over.map(at) }
        };
        for (known, is_doubted) in [
            (seen(None, None, None), false),
            (seen(Some(-1), None, None), false),
            // The first start, years ahead of the newest event.
            (seen(Some(-3000), None, None), true),
            // Nobody takes part for months while the server runs: no doubt.
            (seen(Some(-90), Some(-1), None), false),
            (seen(Some(-90), Some(-30), None), true),
            // Ahead of what was believed, though wrong events have come in already.
            (seen(Some(0), Some(-3000), None), true),
            // Behind what was seen before.
            (seen(Some(-1), Some(30), None), true),
            (seen(Some(3000), Some(-1), None), true),
            // An owner has said that those events are wrong.
            (seen(Some(3000), Some(-1), Some(3000)), false),
        ] {
            assert_eq!(doubt(known, NOW).is_some(), is_doubted, "{known:?}");
        }
    }
}
