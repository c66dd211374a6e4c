//! Borders by the rule as the thesis words it (4.4.2): peaks of the energy where its derivative in a
//! window about the peak passes a threshold.

use serde::{Deserialize, Serialize};

use super::peaks::nearest_quantile;

/// The rule, with the two numbers that the thesis leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Literal {
    /// Half width of the window about a peak, seconds.
    pub window_s: f64,
    /// Share of the 95 % order statistic of |dE/dt| that the highest |dE/dt| of a window reaches.
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
            let near =
                f.saturating_sub(window)..f.saturating_add(window).saturating_add(1).min(frames);
            slope[near].iter().copied().fold(0.0, f64::max)
        };
        (1..frames - 1)
            .filter(|&f| energy[f] > energy[f - 1] && energy[f] >= energy[f + 1])
            .filter(|&f| steepest(f) >= least)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steep_peak_is_kept_and_a_ripple_left() {
        let energy: Vec<f64> = (0..200)
            .map(|f| {
                let x = f as f64;
                10.0 * (-((x - 60.0) / 8.0).powi(2)).exp() + 0.01 * (x * 0.5).sin().max(0.0)
            })
            .collect();
        let found = Literal::default().borders(&energy, 100.0);
        assert!(found.iter().any(|f| f.abs_diff(60) <= 1), "{found:?}");
        assert!(found.iter().all(|f| f.abs_diff(60) < 45), "{found:?}");
        assert!(Literal::default().borders(&energy[..2], 100.0).is_empty());
    }
}
