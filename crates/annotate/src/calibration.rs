//! Whether a probability of 0.8 is right in eight cases of ten, and a temperature that mends it
//! (Guo, Pleiss, Sun and Weinberger, ICML 2017).

use serde::{Deserialize, Serialize};

use crate::error::{above_zero, as_many};
use crate::numbers::{log_sum, softmax};
use crate::{AnnotateError, Rows};

/// Bins of the calibration error.
pub const BINS: usize = 10;

/// Expected calibration error: over even bins (lo, hi] of the answers' probabilities, |share that
/// is right - mean probability|, weighted by the bins' sizes; 0 of no answers.
///
/// # Errors
/// [`AnnotateError::Count`]; [`AnnotateError::Setting`] for probabilities outside 0 to 1 and 0 bins.
pub fn expected_error(
    probability: &[f64],
    right: &[bool],
    bins: usize,
) -> Result<f64, AnnotateError> {
    check(probability, right)?;
    above_zero("bins", bins as f64)?;
    let mut sums = vec![(0.0, 0.0); bins];
    for (&p, &right) in probability.iter().zip(right) {
        // A probability on a border is in the lower bin; 0 in the lowest.
        let mut bin = ((p * bins as f64).ceil() as usize).clamp(1, bins) - 1;
        while bin > 0 && p <= bin as f64 / bins as f64 {
            bin -= 1;
        }
        while bin + 1 < bins && p > (bin + 1) as f64 / bins as f64 {
            bin += 1;
        }
        sums[bin].0 += p;
        sums[bin].1 += f64::from(u8::from(right));
    }
    let apart: f64 = sums.iter().map(|(p, right)| (p - right).abs()).sum();
    Ok(apart / probability.len().max(1) as f64)
}

/// Brier's score: mean of (probability - 1 where right, 0 elsewhere) squared; 0 of no answers.
///
/// # Errors
/// As [`expected_error`].
pub fn brier(probability: &[f64], right: &[bool]) -> Result<f64, AnnotateError> {
    check(probability, right)?;
    let square = |(p, right): (&f64, &bool)| (p - f64::from(u8::from(*right))).powi(2);
    let sum: f64 = probability.iter().zip(right).map(square).sum();
    Ok(sum / probability.len().max(1) as f64)
}

fn check(probability: &[f64], right: &[bool]) -> Result<(), AnnotateError> {
    as_many("answers", right.len(), probability.len())?;
    match probability.iter().copied().find(|p| !(0.0..=1.0).contains(p)) {
        Some(value) => {
            let range = "from 0 to 1";
            Err(AnnotateError::Setting { setting: "probability", value, range })
        }
        None => Ok(()),
    }
}

/// What scores are divided by before they become probabilities.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Temperature(f64);

impl Default for Temperature {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Lowest and highest temperature that is looked for: where all answers are right, ever lower ones
/// would be better.
const LOWEST: f64 = 1e-3;
const HIGHEST: f64 = 1e3;

impl Temperature {
    /// A temperature, above 0.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`].
    pub fn new(value: f64) -> Result<Self, AnnotateError> {
        above_zero("temperature", value)?;
        Ok(Self(value))
    }

    /// The temperature under which held-out answers have the least mean log loss; `scores` a frame
    /// a row, a label a column, `truth` the label of each row. From 0.001 to 1000.
    ///
    /// The loss is convex in 1 / T: its slope, mean of (mean score under softmax - score of the
    /// truth), rises through 0 at the minimum, which is found by bisection.
    ///
    /// # Errors
    /// [`AnnotateError::Count`], also without rows; [`AnnotateError::Label`].
    pub fn fit(scores: &Rows, truth: &[usize]) -> Result<Self, AnnotateError> {
        check_truth(scores, truth)?;
        let mut shares = vec![0.0; scores.width()];
        let mut slope = |inverse: f64| -> f64 {
            let mut sum = 0.0;
            for (row, &label) in scores.iter().zip(truth) {
                shares.iter_mut().zip(row).for_each(|(share, s)| *share = s * inverse);
                softmax(&mut shares);
                sum += crate::numbers::dot(&shares, row) - row[label];
            }
            sum
        };
        let (mut low, mut high) = (1.0 / HIGHEST, 1.0 / LOWEST);
        // Until no number lies between: 2^-60 of the interval.
        for _ in 0..80 {
            let middle = (low + high) / 2.0;
            if slope(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Self(2.0 / (low + high)))
    }

    /// The number.
    pub fn value(self) -> f64 {
        self.0
    }

    /// Scores to probabilities, in place: softmax(scores / T).
    pub fn apply(self, scores: &mut [f64]) {
        scores.iter_mut().for_each(|s| *s /= self.0);
        softmax(scores);
    }

    /// Mean log loss of softmax(scores / T).
    ///
    /// # Errors
    /// As [`Temperature::fit`].
    pub fn mean_log_loss(self, scores: &Rows, truth: &[usize]) -> Result<f64, AnnotateError> {
        check_truth(scores, truth)?;
        let mut cooled = vec![0.0; scores.width()];
        let mut sum = 0.0;
        for (row, &label) in scores.iter().zip(truth) {
            cooled.iter_mut().zip(row).for_each(|(c, s)| *c = s / self.0);
            sum += log_sum(&cooled) - cooled[label];
        }
        Ok(sum / truth.len() as f64)
    }
}

fn check_truth(scores: &Rows, truth: &[usize]) -> Result<(), AnnotateError> {
    as_many("labels of rows", truth.len(), scores.len())?;
    if truth.is_empty() {
        return Err(AnnotateError::Count { what: "rows", found: 0, expected: 1 });
    }
    let labels = scores.width();
    match truth.iter().position(|&label| label >= labels) {
        Some(row) => Err(AnnotateError::Label { row, label: truth[row], labels }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    #[test]
    fn a_planted_temperature_is_found_where_the_loss_is_level() {
        let mut random = Random::new(2);
        let (mut values, mut truth) = (Vec::new(), Vec::new());
        for _ in 0..20_000 {
            let scores: Vec<f64> = (0..3).map(|_| 2.0 * random.normal()).collect();
            let mut shares = scores.clone();
            softmax(&mut shares);
            let draw = random.uniform();
            truth.push(usize::from(draw > shares[0]) + usize::from(draw > shares[0] + shares[1]));
            // Over-confident by 2.5.
            values.extend(scores.iter().map(|s| 2.5 * s));
        }
        let scores = Rows::new(values, 3).unwrap();
        let found = Temperature::fit(&scores, &truth).unwrap();
        assert!((found.value() - 2.5).abs() < 0.1, "{found:?}");
        let loss = |t: f64| Temperature(t).mean_log_loss(&scores, &truth).unwrap();
        let slope = (loss(found.value() + 1e-4) - loss(found.value() - 1e-4)) / 2e-4;
        assert!(slope.abs() < 1e-6, "{slope}");
    }

    #[test]
    fn a_border_belongs_to_the_lower_bin() {
        // 0.3 in the bin to 0.3 with 0.25: |0.55 - 1| / 2.
        let found = expected_error(&[0.3, 0.25], &[true, false], 10).unwrap();
        assert!((found - 0.225).abs() < 1e-12);
        assert!((brier(&[1.0, 0.5], &[true, false]).unwrap() - 0.125).abs() < 1e-15);
        assert!(expected_error(&[1.5], &[true], 10).is_err());
        assert!(Temperature::new(0.0).is_err());
    }
}
