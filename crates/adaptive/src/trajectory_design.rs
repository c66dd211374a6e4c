//! Trajectories of action units drawn at random: what a trial of dynamic reverse correlation shows.
//!
//! Yu, Garrod and Schyns (2012) and Jack, Garrod, Yu, Caldara and Schyns (*Facial expressions of emotion are not
//! culturally universal*, PNAS 109(19), 2012) show 1 to 6 units in a trial, 3 as a rule. Here their number is one
//! and a binomial number of further ones. The three times of a unit are uniform over all triples that leave a
//! least rise and a least fall.

use crate::Trajectory;

/// Trajectories cannot be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// Nothing is drawn from.
    #[error("there is no unit to draw from; name at least one")]
    NoUnit,
    /// The mean number of units of a trial cannot be reached.
    #[error(
        "{mean} units in a trial on average, at most {most}, of {units}: the mean must lie from 1 to the most, which must not be above the number of units"
    )]
    Units {
        /// On average.
        mean: f64,
        /// At most.
        most: usize,
        /// Units that are drawn from.
        units: usize,
    },
    /// The clip is too short for a rise and a fall.
    #[error(
        "a clip of {duration_s} s has no room for a rise and a fall of at least {least_s} s each; make it longer"
    )]
    Duration {
        /// Of the clip.
        duration_s: f64,
        /// Least rise and least fall.
        least_s: f64,
    },
    /// A range is none, or leaves its bounds.
    #[error("{what} from {low} to {high}: it must ascend and lie above 0 and {bound}")]
    Range {
        /// Of what.
        what: &'static str,
        /// Its lower end.
        low: f64,
        /// Its upper end.
        high: f64,
        /// What it must not leave: `up to 1`, `below 1`.
        bound: &'static str,
    },
}

/// What trajectories are drawn from.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectoryDesign {
    /// Number of units.
    pub units: usize,
    /// Duration of the clip, seconds.
    pub duration_s: f64,
    /// Units of a trial on average, from 1.
    pub mean_units: f64,
    /// Units of a trial at most.
    pub most_units: usize,
    /// Lowest and highest peak, above 0 to 1: uniform between them.
    pub amplitude: [f64; 2],
    /// Lowest and highest share at which half of the height is passed, of rises and of falls: uniform between them.
    pub bend: [f64; 2],
    /// Shortest rise and shortest fall, seconds.
    pub least_s: f64,
}

impl TrajectoryDesign {
    /// As in the literature: a clip of 1.25 s, 3 units on average and at most 6 (or all of fewer), any height
    /// from a tenth on, rises and falls of 0.1 s or more.
    pub fn of_units(units: usize) -> Self {
        Self {
            units,
            duration_s: 1.25,
            mean_units: units.min(3) as f64,
            most_units: units.min(6),
            amplitude: [0.1, 1.0],
            bend: [0.3, 0.7],
            least_s: 0.1,
        }
    }

    /// Whether trajectories can be drawn.
    ///
    /// # Errors
    /// [`TrajectoryError`]: what cannot be, with its values.
    pub fn check(&self) -> Result<(), TrajectoryError> {
        if self.units == 0 {
            return Err(TrajectoryError::NoUnit);
        }
        let reached = (1.0..=self.most_units as f64).contains(&self.mean_units);
        if !reached || self.most_units > self.units {
            let (mean, most) = (self.mean_units, self.most_units);
            return Err(TrajectoryError::Units { mean, most, units: self.units });
        }
        let room = self.duration_s - 2.0 * self.least_s;
        if !(room.is_finite() && room >= 0.0 && self.least_s > 0.0) {
            let (duration_s, least_s) = (self.duration_s, self.least_s);
            return Err(TrajectoryError::Duration { duration_s, least_s });
        }
        range("peaks", self.amplitude, "up to 1", |high| high <= 1.0)?;
        range("shares of half the height", self.bend, "below 1", |high| high < 1.0)
    }

    /// The trajectories of one trial, by ascending unit. `uniform` gives numbers in [0, 1), each equally likely;
    /// they are taken in this order: one for each unit that may be there beside the first, one for each unit
    /// that is there (which), then of each unit three for its times and one each for height, rise and fall.
    ///
    /// # Errors
    /// [`TrajectoryError`], as [`TrajectoryDesign::check`] says it.
    pub fn draw(
        &self,
        uniform: &mut impl FnMut() -> f64,
    ) -> Result<Vec<Trajectory>, TrajectoryError> {
        self.check()?;
        let further = self.most_units - 1;
        let share = if further == 0 { 0.0 } else { (self.mean_units - 1.0) / further as f64 };
        let count = 1 + (0..further).filter(|_| uniform() < share).count();
        let mut places: Vec<usize> = (0..self.units).collect();
        for taken in 0..count {
            let left = self.units - taken;
            let other = taken + ((uniform() * left as f64) as usize).min(left - 1);
            places.swap(taken, other);
        }
        places.truncate(count);
        places.sort_unstable();
        Ok(places.into_iter().map(|unit| self.course(unit, uniform)).collect())
    }

    fn course(&self, unit: usize, uniform: &mut impl FnMut() -> f64) -> Trajectory {
        let room = self.duration_s - 2.0 * self.least_s;
        let mut times = [(); 3].map(|()| uniform() * room);
        times.sort_by(f64::total_cmp);
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * uniform();
        Trajectory {
            unit,
            onset_s: times[0],
            peak_s: times[1] + self.least_s,
            offset_s: (times[2] + 2.0 * self.least_s).min(self.duration_s),
            amplitude: between(self.amplitude),
            acceleration: between(self.bend),
            deceleration: between(self.bend),
        }
    }

    /// Frames of a clip at a rate: the first at 0 s, the last no earlier than the end, where every unit rests.
    pub fn frames(&self, rate_hz: f64) -> usize {
        libm::ceil(self.duration_s * rate_hz) as usize + 1
    }

    /// Activations at every frame, frames x units, 0 to 1.
    pub fn activations(&self, trajectories: &[Trajectory], rate_hz: f64) -> Vec<f64> {
        let mut rows = vec![0.0; self.frames(rate_hz) * self.units];
        for (frame, row) in rows.chunks_exact_mut(self.units).enumerate() {
            let time_s = frame as f64 / rate_hz;
            for course in trajectories {
                row[course.unit] = course.at(time_s);
            }
        }
        rows
    }
}

/// Weights of an avatar's shapes, frames x shapes, from activations, frames x units, 0 to 1. `units` has, of each unit,
/// the places of the shapes that it moves, each with the weight of a whole activation. Where units share a shape it takes
/// their sum, at most 1.
///
/// # Panics
/// Where a unit is of another avatar, with more shapes.
pub fn weights_of_units<U: AsRef<[(usize, f64)]>>(
    units: &[U],
    activations: &[f64],
    shapes: usize,
) -> Vec<f64> {
    let mut weights = Vec::new();
    for row in activations.chunks_exact(units.len().max(1)) {
        let mut frame = vec![0.0_f64; shapes];
        for (unit, activation) in units.iter().zip(row) {
            for &(shape, share) in unit.as_ref() {
                frame[shape] = (frame[shape] + share * activation).min(1.0);
            }
        }
        weights.extend(frame);
    }
    weights
}

fn range(
    what: &'static str,
    [low, high]: [f64; 2],
    bound: &'static str,
    within: impl Fn(f64) -> bool,
) -> Result<(), TrajectoryError> {
    let fits = low > 0.0 && low <= high && within(high);
    if fits { Ok(()) } else { Err(TrajectoryError::Range { what, low, high, bound }) }
}

#[cfg(test)]
mod tests {
    use mimique_test_support::Random;
    use proptest::prelude::*;

    use super::*;

    fn drawn(design: &TrajectoryDesign, seed: u64) -> Vec<Trajectory> {
        let mut random = Random::new(seed);
        design.draw(&mut || random.uniform()).unwrap()
    }

    proptest! {
        #[test]
        fn what_is_drawn_stays_in_the_clip_and_in_its_ranges(
            seed in any::<u64>(), units in 1_usize..45, duration_s in 0.3..4.0, rate_hz in 10.0..120.0,
        ) {
            let design = TrajectoryDesign { duration_s, ..TrajectoryDesign::of_units(units) };
            let courses = drawn(&design, seed);
            prop_assert_eq!(&courses, &drawn(&design, seed));
            prop_assert!((1..=design.most_units).contains(&courses.len()));
            prop_assert!(courses.windows(2).all(|pair| pair[0].unit < pair[1].unit));
            for course in &courses {
                prop_assert!(course.unit < units && course.onset_s >= 0.0);
                prop_assert!(course.peak_s - course.onset_s >= design.least_s - 1e-12);
                prop_assert!(course.offset_s - course.peak_s >= design.least_s - 1e-12);
                prop_assert!(course.offset_s <= duration_s);
                prop_assert!((0.1..=1.0).contains(&course.amplitude));
            }
            let rows = design.activations(&courses, rate_hz);
            prop_assert_eq!(rows.len(), design.frames(rate_hz) * units);
            prop_assert!(rows.iter().all(|height| (0.0..=1.0).contains(height)));
            // The clip begins and ends at rest; a unit that was not drawn rests throughout.
            let last = rows.len() - units;
            prop_assert!(rows[..units].iter().chain(&rows[last..]).all(|height| *height == 0.0));
            for unit in (0..units).filter(|unit| courses.iter().all(|each| each.unit != *unit)) {
                prop_assert!(rows.iter().skip(unit).step_by(units).all(|height| *height == 0.0));
            }
        }
    }

    #[test]
    fn numbers_units_and_times_have_their_distributions() {
        let design = TrajectoryDesign::of_units(40);
        let mut random = Random::new(5);
        let trials: Vec<Vec<Trajectory>> =
            (0..20_000).map(|_| design.draw(&mut || random.uniform()).unwrap()).collect();
        let mut counts = [0_usize; 7];
        let mut units = [0_usize; 40];
        let mut peaks = 0.0;
        for trial in &trials {
            counts[trial.len()] += 1;
            trial.iter().for_each(|course| {
                units[course.unit] += 1;
                peaks += course.peak_s;
            });
        }
        // One and five more with a probability of 0.4: 3 is the median.
        let expected = [0.0, 0.077_76, 0.2592, 0.3456, 0.2304, 0.0768, 0.010_24];
        for (count, share) in counts.iter().zip(expected) {
            let found = *count as f64 / 20_000.0;
            assert!((found - share).abs() < 0.012, "{counts:?}");
        }
        // 60 000 draws of 40 units: 1500 each, standard deviation about 37.
        assert!(units.iter().all(|count| (1300..1700).contains(count)), "{units:?}");
        // By symmetry peaks lie around the middle of the clip.
        let all: usize = units.iter().sum();
        assert!((peaks / all as f64 - 0.625).abs() < 0.005);
    }

    #[test]
    fn weights_are_the_activations_by_shares_and_stay_within_one() {
        // A smile of both sides, one of the left, an open jaw, half of a brow.
        let units = [vec![(0, 1.0), (1, 1.0)], vec![(0, 1.0)], vec![(2, 1.0)], vec![(3, 0.5)]];
        let activations = [0.5, 0.25, 0.0, 1.0, 0.75, 0.75, 0.3, 0.0];
        let weights = weights_of_units(&units, &activations, 4);
        assert_eq!(weights, [0.75, 0.5, 0.0, 0.5, 1.0, 0.75, 0.3, 0.0]);
    }

    #[test]
    fn what_cannot_be_drawn_is_named() {
        let good = TrajectoryDesign::of_units(5);
        for (bad, says) in [
            (TrajectoryDesign::of_units(0), "no unit"),
            (TrajectoryDesign { mean_units: 0.5, ..good.clone() }, "0.5 units in a trial"),
            (TrajectoryDesign { mean_units: 6.0, ..good.clone() }, "6 units in a trial"),
            (TrajectoryDesign { most_units: 6, ..good.clone() }, "at most 6, of 5"),
            (TrajectoryDesign { duration_s: 0.15, ..good.clone() }, "0.15 s has no room"),
            (TrajectoryDesign { duration_s: f64::NAN, ..good.clone() }, "NaN s has no room"),
            (TrajectoryDesign { amplitude: [0.5, 1.2], ..good.clone() }, "peaks from 0.5 to 1.2"),
            (TrajectoryDesign { bend: [0.0, 0.5], ..good }, "half the height from 0 to 0.5"),
        ] {
            let error = bad.draw(&mut || 0.5).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
