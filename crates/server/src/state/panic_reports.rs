//! Which reports of panics in browsers reach the log: a page that panics in a loop, or a script that invents reports,
//! must not fill the disk.

use std::collections::HashMap;
use std::hash::{BuildHasher, Hash, RandomState};
use std::net::{IpAddr, Ipv4Addr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::rate_limit::Limits;

/// One more report from an address in so long a time, in the long run.
const ONE_REPORT_IN: Duration = Duration::from_secs(20);
/// Reports from one address at once.
const AT_ONCE: u32 = 5;
/// The same report is written once in so long a time.
const WRITTEN_AGAIN_AFTER: Duration = Duration::from_secs(60);
/// Different reports that are remembered; with more of them, those that are due are forgotten.
const MOST_REMEMBERED: usize = 1000;

/// Reports of panics since the start. They are remembered by a hash with a key of this process.
#[derive(Default)]
pub(crate) struct PanicReports {
    limits: Limits,
    key: RandomState,
    remembered: Mutex<HashMap<u64, Remembered>>,
}

struct Remembered {
    written: Instant,
    repeats: u64,
}

/// What becomes of a report.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The address has sent too many.
    TooMany,
    /// It was written within the last minute.
    Counted,
    /// It is to be written, with the number of its repeats that were not.
    Write { repeats: u64 },
}

impl PanicReports {
    /// Decides on a report from an address; requests without an address are one caller.
    pub fn verdict(&self, address: Option<IpAddr>, report: &impl Hash, now: Instant) -> Verdict {
        let address = address.unwrap_or(Ipv4Addr::UNSPECIFIED.into());
        if !self.limits.allow_every(address, ONE_REPORT_IN, AT_ONCE, now) {
            return Verdict::TooMany;
        }
        let is_due = |known: &Remembered| now >= known.written + WRITTEN_AGAIN_AFTER;
        let mut remembered = self.remembered.lock().unwrap_or_else(PoisonError::into_inner);
        if remembered.len() >= MOST_REMEMBERED {
            remembered.retain(|_, known| !is_due(known));
        }
        let report = self.key.hash_one(report);
        if let Some(known) = remembered.get_mut(&report)
            && !is_due(known)
        {
            known.repeats += 1;
            return Verdict::Counted;
        }
        if remembered.len() >= MOST_REMEMBERED && !remembered.contains_key(&report) {
            return Verdict::TooMany;
        }
        let before = remembered.insert(report, Remembered { written: now, repeats: 0 });
        Verdict::Write { repeats: before.map_or(0, |known| known.repeats) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_are_counted_and_written_once_a_minute() {
        let reports = PanicReports::default();
        let now = Instant::now();
        let from = |last: u8| Some(IpAddr::from([192, 0, 2, last]));
        assert_eq!(reports.verdict(from(1), &"a", now), Verdict::Write { repeats: 0 });
        for last in 2..100 {
            assert_eq!(reports.verdict(from(last), &"a", now), Verdict::Counted);
        }
        let later = now + WRITTEN_AGAIN_AFTER;
        assert_eq!(reports.verdict(from(1), &"a", later), Verdict::Write { repeats: 98 });
    }

    #[test]
    fn an_address_sends_a_few_reports_a_minute() {
        let reports = PanicReports::default();
        let now = Instant::now();
        for address in [None, Some(IpAddr::from([127, 0, 0, 1]))] {
            let taken = (0..1000).filter(|number| {
                reports.verdict(address, &(address, number), now) != Verdict::TooMany
            });
            assert_eq!(taken.count(), AT_ONCE as usize, "{address:?}");
        }
    }

    #[test]
    fn what_is_remembered_is_bounded() {
        let reports = PanicReports::default();
        let now = Instant::now();
        for number in 0..3000_u32 {
            let address = Some(Ipv4Addr::from(0x0a00_0000 + number).into());
            reports.verdict(address, &number, now);
        }
        assert_eq!(reports.remembered.lock().unwrap().len(), MOST_REMEMBERED);
        let later = now + WRITTEN_AGAIN_AFTER;
        assert_eq!(reports.verdict(None, &"new", later), Verdict::Write { repeats: 0 });
        assert_eq!(reports.remembered.lock().unwrap().len(), 1);
    }
}
