//! Mechanical work: from the energies of a body's parts to joules per kilogram over time.

use crate::body::Body;
use crate::energy::PartEnergy;
use crate::error::{ExertionError, as_many, from_zero};
use crate::person::Person;

/// How the work of a step follows from the changes of energy (E5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Convention {
    /// The sum of the sizes of every segment's change: what is gained by one is not lent by another.
    #[default]
    Segments,
    /// The size of the whole body's change.
    Body,
    /// The whole body's change with its sign: what goes up comes down.
    Signed,
    /// The sum of the segments' gains.
    Positive,
    /// The sum of the sizes of the changes of every kind of energy of every segment (Norman 1976).
    Pseudo,
}

impl Convention {
    /// All of them with their names.
    pub const NAMES: [(Self, &'static str); 5] = [
        (Self::Segments, "segments"),
        (Self::Body, "body"),
        (Self::Signed, "signed"),
        (Self::Positive, "positive"),
        (Self::Pseudo, "pseudo"),
    ];

    /// The name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(own, _)| *own == self).map_or("", |(_, name)| name)
    }

    /// The convention of a name.
    ///
    /// # Errors
    /// [`ExertionError::Unknown`].
    pub fn by_name(name: &str) -> Result<Self, ExertionError> {
        let found = Self::NAMES.iter().find(|(_, own)| *own == name);
        found.map(|(convention, _)| *convention).ok_or_else(|| ExertionError::Unknown {
            place: format!("convention/{name}"),
            known: Self::NAMES.map(|(_, name)| name).to_vec(),
        })
    }

    /// Adds what a segment does between each frame and the next, J.
    fn add_steps(self, part: &PartEnergy, steps: &mut [f64]) {
        let (potential, translational, rotational) =
            (part.potential.windows(2), part.translational.windows(2), part.rotational.windows(2));
        let changes = potential.zip(translational).zip(rotational);
        for (step, ((p, t), r)) in steps.iter_mut().zip(changes) {
            let [p, t, r] = [p, t, r].map(|pair| pair[1] - pair[0]);
            *step += match self {
                Self::Segments => (p + t + r).abs(),
                Self::Body | Self::Signed => p + t + r,
                Self::Positive => (p + t + r).max(0.0),
                Self::Pseudo => p.abs() + t.abs() + r.abs(),
            };
        }
    }
}

/// The work of a body in motion.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyWork {
    /// Work between each frame and the next, J. Of three and more the first and the last, whose speeds are
    /// one-sided, take their neighbours' values.
    pub steps: Vec<f64>,
    /// All of it over time, J/kg.
    pub accumulated: Accumulated,
}

impl BodyWork {
    /// Of a body; `repeated`: the motion begins anew when it ends, as often as is asked for. The work is
    /// then repeated, not the positions, whose jump from the end to the beginning would be work that nobody
    /// did.
    ///
    /// # Errors
    /// As [`Body::energies`].
    pub fn of(
        body: &Body,
        person: &Person,
        convention: Convention,
        repeated: bool,
    ) -> Result<Self, ExertionError> {
        let mut steps = vec![0.0; body.frames() - 1];
        body.each_part(person, |part| convention.add_steps(part, &mut steps))?;
        if convention == Convention::Body {
            steps.iter_mut().for_each(|step| *step = step.abs());
        }
        if let [first, second, .., before, last] = &mut steps[..] {
            (*first, *last) = (*second, *before);
        } else if let [first, middle, last] = &mut steps[..] {
            (*first, *last) = (*middle, *middle);
        }
        let mut sum = 0.0;
        let mut knots = Vec::with_capacity(steps.len() + 1);
        knots.push(0.0);
        for step in &steps {
            sum += step;
            knots.push(sum / person.spec().mass_kg);
        }
        Ok(Self { steps, accumulated: Accumulated::even(knots, body.rate_hz(), repeated) })
    }
}

/// Half the time over which power is taken, s.
const POWER_HALF_S: f64 = 0.125;
/// The time over which w is taken, s.
const WORK_WINDOW_S: f64 = 1.0;

/// Work C(t) since the beginning, J/kg: straight between knots, constant outside; repeated on request.
#[derive(Debug, Clone, PartialEq)]
pub struct Accumulated {
    knots: Knots,
    /// Work at every knot, J/kg; the first 0.
    work: Vec<f64>,
    repeated: bool,
}

/// The times of knots.
#[derive(Debug, Clone, PartialEq)]
enum Knots {
    /// So many per second, from 0.
    Even(f64),
    /// Increasing, s, from 0.
    At(Vec<f64>),
}

impl Accumulated {
    /// No work at all, of any time.
    pub fn none() -> Self {
        Self { knots: Knots::Even(1.0), work: vec![0.0], repeated: false }
    }

    fn even(work: Vec<f64>, rate_hz: f64, repeated: bool) -> Self {
        Self { knots: Knots::Even(rate_hz), work, repeated }
    }

    /// Of the work of every second, J/kg: the j-th is done in the second that ends at second j, so that the
    /// first counts for nothing.
    ///
    /// # Errors
    /// [`ExertionError`] for work that is none or below 0, at `w/SECOND`.
    pub fn of_seconds(w: &[f64]) -> Result<Self, ExertionError> {
        let mut work = vec![0.0];
        let mut sum = 0.0;
        for (second, own) in w.iter().enumerate() {
            from_zero(&format!("w/{second}"), *own)?;
            if second > 0 {
                sum += own;
                work.push(sum);
            }
        }
        Ok(Self::even(work, 1.0, false))
    }

    /// Of phases of constant work: J/kg in every second, and seconds.
    ///
    /// # Errors
    /// [`ExertionError`] for numbers that are none or below 0, at `phases/PHASE`.
    pub fn of_phases(phases: &[(f64, f64)]) -> Result<Self, ExertionError> {
        let (mut times, mut work) = (vec![0.0], vec![0.0]);
        let (mut time, mut sum) = (0.0, 0.0);
        for (i, (own, seconds)) in phases.iter().enumerate() {
            let place = format!("phases/{i}");
            from_zero(&place, *own)?;
            from_zero(&place, *seconds)?;
            if *seconds > 0.0 {
                time += seconds;
                sum += own * seconds;
                times.push(time);
                work.push(sum);
            }
        }
        Ok(Self { knots: Knots::At(times), work, repeated: false })
    }

    /// Of times from 0 on, s, and the work until each, J/kg.
    ///
    /// # Errors
    /// [`ExertionError`] where they are not as many, or times do not increase.
    pub fn of_knots(times: Vec<f64>, work: Vec<f64>) -> Result<Self, ExertionError> {
        as_many("work", work.len(), times.len())?;
        for (i, pair) in times.windows(2).enumerate() {
            if !(pair[1] > pair[0]) {
                let place = format!("time/{}", i + 1);
                return Err(ExertionError::TimeOrder { place, time: pair[1], before: pair[0] });
            }
        }
        if times.is_empty() {
            return Ok(Self::none());
        }
        Ok(Self { knots: Knots::At(times), work, repeated: false })
    }

    /// How long it is, s; endless where it is repeated.
    pub fn span_s(&self) -> f64 {
        match &self.knots {
            Knots::Even(rate_hz) => (self.work.len() - 1) as f64 / rate_hz,
            Knots::At(times) => times.last().copied().unwrap_or(0.0),
        }
    }

    /// All of it once, J/kg.
    pub fn total(&self) -> f64 {
        self.work.last().copied().unwrap_or(0.0)
    }

    /// Whether it begins anew when it ends.
    pub fn is_repeated(&self) -> bool {
        self.repeated
    }

    /// The same, repeated or not.
    #[must_use]
    pub fn repeated(self, repeated: bool) -> Self {
        Self { repeated, ..self }
    }

    /// C(t), J/kg. Repeated, C(t + span) = C(t) + total.
    pub fn at(&self, t: f64) -> f64 {
        let span = self.span_s();
        if self.repeated && span > 0.0 && t > span {
            let turns = (t / span).floor();
            return turns * self.total() + self.once(t - turns * span);
        }
        self.once(t)
    }

    fn once(&self, t: f64) -> f64 {
        if !(t > 0.0) {
            return 0.0;
        }
        let last = self.work.len() - 1;
        let (low, part) = match &self.knots {
            Knots::Even(rate_hz) => {
                let place = t * rate_hz;
                (place.floor() as usize, place - place.floor())
            }
            Knots::At(times) => {
                let after = times.partition_point(|time| *time <= t);
                let low = after.saturating_sub(1);
                match times.get(after) {
                    Some(next) => (low, (t - times[low]) / (next - times[low])),
                    None => (last, 0.0),
                }
            }
        };
        if low >= last {
            return self.work[last];
        }
        self.work[low] + part * (self.work[low + 1] - self.work[low])
    }

    /// E5: w, the work of the last second, J/kg; before the first second is over, the work until then per
    /// second.
    pub fn w(&self, t: f64) -> f64 {
        w(|t| self.at(t), t)
    }

    /// E5: p, the power over a quarter of a second, W/kg.
    pub fn p(&self, t: f64) -> f64 {
        p(|t| self.at(t), t, (!self.repeated).then(|| self.span_s()))
    }
}

/// w of C(t).
pub(crate) fn w(accumulated: impl Fn(f64) -> f64, t: f64) -> f64 {
    let window = t.min(WORK_WINDOW_S);
    if !(window > 0.0) {
        return 0.0;
    }
    (accumulated(t) - accumulated(t - window)) / window
}

/// p of C(t), which ends at a span unless it is repeated.
pub(crate) fn p(accumulated: impl Fn(f64) -> f64, t: f64, span: Option<f64>) -> f64 {
    let (mut a, mut b) = ((t - POWER_HALF_S).max(0.0), t + POWER_HALF_S);
    if let Some(span) = span {
        (a, b) = (a.min(span), b.min(span));
    }
    if b > a { (accumulated(b) - accumulated(a)) / (b - a) } else { 0.0 }
}
