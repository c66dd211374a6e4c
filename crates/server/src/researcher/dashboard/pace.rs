//! How far a study is: how many have completed it of how many are wanted, how fast that goes, and when it will be full.

/// The pace is that of so many days, or of the study's own time if that is less.
const DAYS: f64 = 7.0;
const DAY_MS: f64 = 24.0 * 3600.0 * 1000.0;
/// Fewer than these tell of no pace, nor do they within less than a day: the first minutes of a study would promise
/// thousands.
const FEWEST: usize = 2;

/// How far a study is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pace {
    /// How many have completed it.
    pub done: usize,
    /// How many are wanted, where the study file says so.
    pub wanted: Option<usize>,
    /// How many complete it per day, lately; none where too few have to tell.
    pub per_day: Option<f64>,
    /// When it will be full at this pace, milliseconds since 1970; none where it is full, or nobody can know.
    pub full_ms: Option<i64>,
}

impl Pace {
    /// Of the times at which people completed the study, milliseconds since 1970.
    pub fn of(ended_ms: &[i64], wanted: Option<usize>, now_ms: i64) -> Self {
        let done = ended_ms.len();
        let first = ended_ms.iter().copied().min().unwrap_or(now_ms);
        let window = ((now_ms - first) as f64 / DAY_MS).clamp(f64::MIN_POSITIVE, DAYS);
        let since = now_ms - (window * DAY_MS) as i64;
        // The first one begins the time that is counted, where it is no longer than the study's own.
        let lately = ended_ms.iter().filter(|ended| **ended > since).count();
        let tells = done >= FEWEST && lately > 0 && window >= 1.0;
        let per_day = tells.then(|| lately as f64 / window);
        let left = wanted.map(|wanted| wanted.saturating_sub(done)).filter(|left| *left > 0);
        let full_ms = left
            .zip(per_day)
            .map(|(left, per_day)| now_ms + (left as f64 / per_day * DAY_MS) as i64);
        Self { done, wanted, per_day, full_ms }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY: i64 = 24 * 3600 * 1000;

    #[test]
    fn a_study_is_full_when_its_pace_says_so() {
        // One a day for ten days, the last one now: of the last seven days seven count.
        let ended: Vec<i64> = (0..11).map(|day| day * DAY).collect();
        let pace = Pace::of(&ended, Some(21), 10 * DAY);
        assert_eq!((pace.done, pace.wanted), (11, Some(21)));
        assert!((pace.per_day.unwrap() - 1.0).abs() < 1e-9);
        assert_eq!(pace.full_ms, Some(20 * DAY));
    }

    #[test]
    fn a_young_study_is_counted_since_its_first_participant() {
        let pace = Pace::of(&[0, DAY, 2 * DAY], Some(5), 2 * DAY);
        assert!((pace.per_day.unwrap() - 1.0).abs() < 1e-9);
        assert_eq!(pace.full_ms, Some(4 * DAY));
    }

    #[test]
    fn nobody_knows_what_nobody_can_know() {
        for (ended, wanted) in [(vec![], Some(5)), (vec![0], Some(5)), (vec![0, DAY], None)] {
            assert_eq!(Pace::of(&ended, wanted, 3 * DAY).full_ms, None);
        }
        // Two within minutes.
        let fresh = Pace::of(&[0, DAY / 500], Some(9), DAY / 400);
        assert_eq!((fresh.done, fresh.per_day, fresh.full_ms), (2, None, None));
        // Full, and nobody lately.
        assert_eq!(Pace::of(&[0, DAY], Some(2), 3 * DAY).full_ms, None);
        let idle = Pace::of(&[0, DAY], Some(9), 30 * DAY);
        assert_eq!((idle.per_day, idle.full_ms), (None, None));
    }
}
