//! What a take falls into: stretches between the borders where its energy peaks (thesis 4.4.2).
//!
//! | thesis | here |
//! |---|---|
//! | E_VelBS (4.4), E_AccBS (4.5) | [`Activity::velocity`], [`Activity::acceleration`] |
//! | E = E_VelBS^2 + E_AccBS^2 | [`Activity::energy`], time in units of `time_unit_s` |
//! | peaks of E | [`mimique_stimulus::peaks`], as `mimique segment` has them |
//! | peaks where dE/dt in a window passes a threshold | [`Literal`] |

use std::ops::Range;

use mimique_stimulus::{Activity, ActivityOptions, Channels, nearest_quantile, peaks};

use crate::{AnnotateError, Take};

/// Velocity, acceleration and energy of a take, a number a frame.
///
/// # Errors
/// [`AnnotateError::Filter`] when the cut-off does not fit the rate.
pub fn activity(take: &Take, options: &ActivityOptions) -> Result<Activity, AnnotateError> {
    let weights = &take.weights;
    let channels =
        Channels { values: weights.values(), count: weights.width(), rate_hz: take.rate_hz };
    Ok(Activity::of(channels, options)?)
}

/// The square root of the energy, which the rule of `mimique segment` looks at.
pub fn root(activity: &Activity) -> Vec<f64> {
    activity.energy.iter().map(|e| e.sqrt()).collect()
}

/// Borders as `mimique segment` finds them, frames in ascending order.
pub fn borders(activity: &Activity, rate_hz: f64) -> Vec<usize> {
    peaks(&root(activity), rate_hz)
}

/// The rule as the thesis words it (4.4.2), with the two numbers that it leaves out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Literal {
    /// Half width of the window about a peak, seconds.
    pub window_s: f64,
    /// Share of the 95 % order statistic of |dE/dt| that a window's highest reaches.
    pub share: f64,
}

impl Default for Literal {
    fn default() -> Self {
        Self { window_s: 0.1, share: 0.15 }
    }
}

impl Literal {
    /// Local maxima of the energy (above the frame before, not below the one after) with a steep
    /// slope near by. Slopes are central differences, one-sided at the ends.
    pub fn borders(&self, energy: &[f64], rate_hz: f64) -> Vec<usize> {
        let frames = energy.len();
        if frames < 3 {
            return Vec::new();
        }
        let slope: Vec<f64> = (0..frames)
            .map(|f| {
                let (before, after) = (f.saturating_sub(1), (f + 1).min(frames - 1));
                ((energy[after] - energy[before]) * rate_hz / (after - before) as f64).abs()
            })
            .collect();
        let mut sorted = slope.clone();
        sorted.sort_by(f64::total_cmp);
        let least = self.share * nearest_quantile(&sorted, 0.95);
        let window = (self.window_s * rate_hz).round().max(0.0) as usize;
        let steepest = |f: usize| {
            let near = f.saturating_sub(window)..(f + window + 1).min(frames);
            slope[near].iter().copied().fold(0.0, f64::max)
        };
        (1..frames - 1)
            .filter(|&f| energy[f] > energy[f - 1] && energy[f] >= energy[f + 1])
            .filter(|&f| steepest(f) >= least)
            .collect()
    }
}

/// What lies between 0, the borders and the end; empty ones left out.
pub fn stretches(borders: &[usize], frames: usize) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut found = Vec::with_capacity(borders.len() + 1);
    for end in borders.iter().copied().filter(|&b| b < frames).chain([frames]) {
        if end > start {
            found.push(start..end);
            start = end;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_cover_the_take_once() {
        assert_eq!(stretches(&[3, 3, 7, 12], 10), [0..3, 3..7, 7..10]);
        assert_eq!(stretches(&[], 4), [Range { start: 0, end: 4 }]);
        assert!(stretches(&[], 0).is_empty());
    }

    #[test]
    fn energy_and_borders_do_not_depend_on_the_order_of_shapes() {
        let wave = |f: usize, c: usize| ((f * (c + 2)) as f64 * 0.01).sin();
        let frame = |order: [usize; 3]| -> Vec<f64> {
            (0..300).flat_map(|f| order.map(|c| wave(f, c))).collect()
        };
        let of = |order| {
            let take = Take::new(frame(order), 3, 60.0).unwrap();
            activity(&take, &ActivityOptions::default()).unwrap()
        };
        let (one, other) = (of([0, 1, 2]), of([2, 0, 1]));
        for (a, b) in one.energy.iter().zip(&other.energy) {
            assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0));
        }
        assert_eq!(borders(&one, 60.0), borders(&other, 60.0));
    }

    #[test]
    fn the_literal_rule_keeps_a_steep_peak_and_leaves_a_ripple() {
        let energy: Vec<f64> = (0..200)
            .map(|f| {
                let x = f as f64;
                10.0 * (-((x - 60.0) / 8.0).powi(2)).exp() + 0.01 * (x * 0.5).sin().max(0.0)
            })
            .collect();
        let found = Literal::default().borders(&energy, 100.0);
        assert!(found.iter().any(|f| f.abs_diff(60) <= 1), "{found:?}");
        assert!(found.iter().all(|f| f.abs_diff(60) < 45), "{found:?}");
    }
}
