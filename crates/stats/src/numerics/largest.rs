//! Corrected p values by permutation: how the largest of many statistics is distributed where nothing is there.

use crate::refusal::Refusal;

/// Fewest draws that can give p <= 0.05.
pub const FEWEST_PERMUTATIONS: usize = 19;
/// What is called significant.
pub(crate) const LEVEL: f64 = 0.05;
/// Rounding that may part two sums of the same numbers in another order.
const ROUNDING: f64 = 1e-9;

/// Refuses fewer draws than can give p <= 0.05.
pub(crate) fn require_permutations(permutations: usize) -> Result<(), Refusal> {
    if permutations < FEWEST_PERMUTATIONS {
        return Err(Refusal::OptionNotWithin {
            option: "permutations",
            word: permutations.to_string(),
            least: FEWEST_PERMUTATIONS as f64,
            most: f64::INFINITY,
        });
    }
    Ok(())
}

/// The largest size of a statistic in every draw, ascending.
pub(crate) struct Largest(Vec<f64>);

impl Largest {
    pub(crate) fn of(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self(values)
    }

    /// (1 + draws that reach the statistic's size) / (1 + draws).
    pub(crate) fn p(&self, statistic: f64) -> f64 {
        let below = self.0.partition_point(|largest| *largest < statistic.abs() - ROUNDING);
        (1 + self.0.len() - below) as f64 / (1 + self.0.len()) as f64
    }

    /// The value above which p is at most 0.05.
    pub(crate) fn critical(&self) -> f64 {
        // The floor is of a whole number that rounding may have put just below itself.
        let reached = (LEVEL * (self.0.len() + 1) as f64 + ROUNDING).floor() as usize;
        self.0[self.0.len() - reached.clamp(1, self.0.len())] + ROUNDING
    }
}
