//! The heart: its rate from work, second by second, or as it was recorded.

use crate::error::{ExertionError, as_many, from_zero, within};
use crate::person::{HEART_RATES, Person, VO2_REST};
use crate::samples::{at_whole_seconds, whole_seconds};

/// Work of a second above which a capture is at fault: it counts as this much here, J/kg.
pub const WORK_LIMIT: f64 = 120.0;
/// Uptake of oxygen for a joule of work in a second, ml/kg/min (E7, E13).
pub(crate) const VO2_PER_WORK: f64 = 2.0;
/// Time constants of the settling heart upwards and downwards, s (E7).
const TAU_UP_S: f64 = 35.0;
const TAU_DOWN_S: f64 = 60.0;

/// How the heart follows work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum HeartModel {
    /// E6, the law that is printed in the thesis (3.3.1): two leaves of a regression tree. It has no steady
    /// state: constant work above the threshold takes the heart to its maximum in the end.
    #[default]
    Thesis,
    /// E7, ours: towards the oxygen that the work needs, with a time constant.
    Steady,
}

impl HeartModel {
    /// The laws with their names; that of a recorded heart is `recorded`.
    pub const NAMES: [(Self, &'static str); 2] =
        [(Self::Thesis, "thesis"), (Self::Steady, "steady")];

    /// The name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(own, _)| *own == self).map_or("", |(_, name)| name)
    }

    /// The law of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, own)| *own == name).map(|(law, _)| *law)
    }
}

/// The numbers of E6 for a level of training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeartLaw {
    /// T: work of a second above which the heart goes faster, J/kg.
    pub threshold: f64,
    /// How fast it rises.
    pub rise: f64,
    /// How fast it falls.
    pub fall: f64,
}

impl HeartLaw {
    /// Of a level of training N: T = 7.13 + 0.42 N, rise 0.0056 - 0.00043 N, fall 0.0009 + 0.00025 N.
    pub fn of_level(level: f64) -> Self {
        Self {
            threshold: 7.13 + 0.42 * level,
            rise: 0.0056 - 0.00043 * level,
            fall: 0.0009 + 0.00025 * level,
        }
    }

    /// E6: rcn a second later.
    fn next(&self, rcn: f64, w: f64) -> f64 {
        let above = w - self.threshold;
        let next = if above > 0.0 {
            let room = 1.0 - rcn;
            rcn + self.rise * above * (room * room)
        } else {
            rcn + self.fall * above * (rcn * rcn)
        };
        next.clamp(0.0, 1.0)
    }
}

/// E7: towards 2.0 w / (VO2max - 3.5), at most 1.
#[derive(Debug, Clone, Copy)]
struct SteadyHeart {
    per_work: f64,
    /// Shares of the way that are gone in a second, upwards and downwards.
    up: f64,
    down: f64,
}

impl SteadyHeart {
    fn of(person: &Person) -> Self {
        let faster = 1.0 + 0.04 * (person.spec().level - 5.0);
        let share = |tau: f64| -libm::expm1(-faster / tau);
        Self {
            per_work: VO2_PER_WORK / (person.vo2_max() - VO2_REST),
            up: share(TAU_UP_S),
            down: share(TAU_DOWN_S),
        }
    }

    fn next(&self, rcn: f64, w: f64) -> f64 {
        let way = self.per_work * w - rcn;
        (rcn + way * if way > 0.0 { self.up } else { self.down }).clamp(0.0, 1.0)
    }
}

/// rcn, the share of the heart's reserve, at every second: `w[j]` is the work of the second that ends at
/// second j, `rcn0` the share at second 0.
///
/// # Errors
/// [`ExertionError`]: work that is none or below 0 (`w/j`), `rcn0` outside 0 to 1.
pub fn heart(
    person: &Person,
    model: HeartModel,
    w: &[f64],
    rcn0: f64,
) -> Result<Vec<f64>, ExertionError> {
    heart_with(person, model, w, rcn0, &[])
}

/// The same, with the share recorded in some of the seconds: there it is taken, and from there the law
/// goes on. `recorded` is empty or as long as `w`.
///
/// # Errors
/// As [`heart`]; a recorded share outside 0 to 1 (`rcn/j`).
pub fn heart_with(
    person: &Person,
    model: HeartModel,
    w: &[f64],
    rcn0: f64,
    recorded: &[Option<f64>],
) -> Result<Vec<f64>, ExertionError> {
    within("rcn0", rcn0, [0.0, 1.0], None)?;
    if !recorded.is_empty() {
        as_many("rcn", recorded.len(), w.len())?;
    }
    let law = HeartLaw::of_level(person.spec().level);
    let steady = SteadyHeart::of(person);
    let mut rcn = rcn0;
    let mut all = Vec::with_capacity(w.len());
    for (second, own) in w.iter().enumerate() {
        let own = from_zero(&format!("w/{second}"), *own)?.min(WORK_LIMIT);
        match recorded.get(second).copied().flatten() {
            Some(share) => rcn = within(&format!("rcn/{second}"), share, [0.0, 1.0], None)?,
            None if second == 0 => {}
            None => {
                rcn = match model {
                    HeartModel::Thesis => law.next(rcn, own),
                    HeartModel::Steady => steady.next(rcn, own),
                }
            }
        }
        all.push(rcn);
    }
    Ok(all)
}

/// A recorded heart rate at whole seconds after its first sample, beats per minute, and E1 of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedHeart {
    /// Beats per minute.
    pub heart_rate: Vec<f64>,
    /// The share of the reserve, kept in 0 to 1.
    pub rcn: Vec<f64>,
}

impl RecordedHeart {
    /// Of samples at uneven times, s and beats per minute.
    ///
    /// # Errors
    /// [`ExertionError`]: as [`at_whole_seconds`], and heart rates outside 25 to 250 (`heartRate/i`).
    pub fn of(person: &Person, time: &[f64], heart_rate: &[f64]) -> Result<Self, ExertionError> {
        whole_seconds(time)?;
        as_many("heartRate", heart_rate.len(), time.len())?;
        for (i, rate) in heart_rate.iter().enumerate() {
            within(&format!("heartRate/{i}"), *rate, HEART_RATES, Some("beats per minute"))?;
        }
        let heart_rate = at_whole_seconds(time, heart_rate, "heartRate")?;
        let rcn = heart_rate.iter().map(|rate| person.heart_share(*rate)).collect();
        Ok(Self { heart_rate, rcn })
    }
}
