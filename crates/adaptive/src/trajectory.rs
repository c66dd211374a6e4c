//! The course of one action unit over a clip: it rises from 0 at its onset to its peak and falls to 0 at its
//! offset. Seven numbers describe it: which unit, three times, the height, and how rise and fall are bent.
//!
//! The parameters are those of dynamic reverse correlation (Yu, Garrod and Schyns, *Perception-driven facial
//! expression synthesis*, Computers & Graphics 36(3), 2012: onset latency, acceleration, peak amplitude, peak
//! latency, deceleration, offset latency). The curve is ours: each half is the minimum-jerk step
//! s(x) = x³ (10 - 15 x + 6 x²) (Flash and Hogan 1985) of a power of the time, s(x^γ), γ = ln ½ / ln h, so that
//! half of the height is passed at the share h of its duration.

/// The course of one action unit. Times are in seconds from the clip's first frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trajectory {
    /// Place of the unit among those that are drawn from.
    pub unit: usize,
    /// Until then it rests: onset latency.
    pub onset_s: f64,
    /// When it is highest: peak latency, after the onset.
    pub peak_s: f64,
    /// From then on it rests: offset latency, after the peak.
    pub offset_s: f64,
    /// How high it is there, above 0 to 1: peak amplitude.
    pub amplitude: f64,
    /// Share of the rise, inside 0 to 1, at which half of the height is passed: 0.5 rises evenly, less begins fast,
    /// more begins slowly.
    pub acceleration: f64,
    /// Share of the fall, inside 0 to 1, at which half of the height is passed: less falls fast at first.
    pub deceleration: f64,
}

impl Trajectory {
    /// Its height at a time, 0 to `amplitude`. It is exactly 0 up to the onset and from the offset on, and exactly
    /// `amplitude` at the peak.
    pub fn at(&self, time_s: f64) -> f64 {
        if time_s <= self.onset_s || time_s >= self.offset_s {
            return 0.0;
        }
        let share = if time_s <= self.peak_s {
            step((time_s - self.onset_s) / (self.peak_s - self.onset_s), self.acceleration)
        } else {
            1.0 - step((time_s - self.peak_s) / (self.offset_s - self.peak_s), self.deceleration)
        };
        self.amplitude * share
    }
}

/// A smooth step from 0 at 0 to 1 at 1 that passes one half at `half`.
fn step(x: f64, half: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    let y = if half == 0.5 { x } else { libm::pow(x, -std::f64::consts::LN_2 / libm::log(half)) };
    (y * y * y * (10.0 + y * (6.0 * y - 15.0))).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_rests_outside_is_highest_at_the_peak_and_passes_half_where_it_is_told(
            onset_s in 0.0..2.0, rise in 0.05..2.0, fall in 0.05..2.0, amplitude in 0.01..=1.0,
            acceleration in 0.1..0.9, deceleration in 0.1..0.9,
        ) {
            let (peak_s, offset_s) = (onset_s + rise, onset_s + rise + fall);
            let course =
                Trajectory { unit: 0, onset_s, peak_s, offset_s, amplitude, acceleration, deceleration };
            prop_assert_eq!(course.at(onset_s), 0.0);
            prop_assert_eq!(course.at(offset_s), 0.0);
            prop_assert_eq!(course.at(onset_s - 0.1), 0.0);
            prop_assert_eq!(course.at(offset_s + 0.1), 0.0);
            prop_assert_eq!(course.at(peak_s), amplitude);
            let half = course.at(onset_s + acceleration * (peak_s - onset_s));
            prop_assert!((half - amplitude / 2.0).abs() < 1e-9, "{}", half);
            let half = course.at(peak_s + deceleration * (offset_s - peak_s));
            prop_assert!((half - amplitude / 2.0).abs() < 1e-9, "{}", half);
            let times = (0..=200).map(|k| onset_s + (offset_s - onset_s) * f64::from(k) / 200.0);
            let values: Vec<(f64, f64)> = times.map(|time| (time, course.at(time))).collect();
            for pair in values.windows(2) {
                let ((before, a), (after, b)) = (pair[0], pair[1]);
                prop_assert!((0.0..=amplitude).contains(&b));
                // It rises to the peak and falls from there on; rounding may bend it by its last bits.
                prop_assert!(after > peak_s || b >= a - 1e-12);
                prop_assert!(before < peak_s || b <= a + 1e-12);
            }
        }
    }

    #[test]
    fn onset_and_offset_are_smooth() {
        for half in [0.25, 0.5, 0.75] {
            // At 1e-5 of the duration a corner would be 1e-5 high.
            assert!(step(1e-5, half) < 1e-6, "{half}: {}", step(1e-5, half));
            assert!(1.0 - step(1.0 - 1e-5, half) < 1e-6, "{half}");
        }
    }
}
