//! Whether a probability of 0.8 is right in eight cases of ten, and a temperature that mends it
//! (Guo, Pleiss, Sun and Weinberger, ICML 2017).

use serde::{Deserialize, Serialize};

use crate::error::{above_zero, as_many};
use crate::numbers::{log_sum, softmax};
use crate::{AnnotateError, Rows};

/// Bins of the calibration error.
pub const BINS: usize = 10;

/// How often answers are right by how probable they were held to be: counts of frames in even bins
/// (lo, hi] of probability, of one take or several.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reliability {
    bins: Vec<ReliabilityBin>,
    /// Sum of (probability - 1 where right, 0 elsewhere) squared.
    squares: f64,
}

/// Answers whose probability lies in a bin.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ReliabilityBin {
    /// Answers.
    pub n: u64,
    /// Sum of their probabilities.
    pub probability: f64,
    /// How many are right.
    pub right: u64,
}

impl Default for Reliability {
    fn default() -> Self {
        Self::new(BINS)
    }
}

impl Reliability {
    /// Nothing counted; one bin at least.
    pub fn new(bins: usize) -> Self {
        Self { bins: vec![ReliabilityBin::default(); bins.max(1)], squares: 0.0 }
    }

    /// Count an answer of a probability from 0 to 1. One on a border is in the lower bin, 0 in the
    /// lowest.
    pub fn count(&mut self, probability: f64, right: bool) {
        let bins = self.bins.len();
        let mut place = ((probability * bins as f64).ceil() as usize).clamp(1, bins) - 1;
        while place > 0 && probability <= place as f64 / bins as f64 {
            place -= 1;
        }
        while place + 1 < bins && probability > (place + 1) as f64 / bins as f64 {
            place += 1;
        }
        let bin = &mut self.bins[place];
        bin.n += 1;
        bin.probability += probability;
        bin.right += u64::from(right);
        let away = probability - f64::from(u8::from(right));
        self.squares += away * away;
    }

    /// Add another's counts, of as many bins.
    pub fn add(&mut self, other: &Self) {
        for (own, other) in self.bins.iter_mut().zip(&other.bins) {
            own.n += other.n;
            own.probability += other.probability;
            own.right += other.right;
        }
        self.squares += other.squares;
    }

    /// The bins, by rising probability.
    pub fn bins(&self) -> &[ReliabilityBin] {
        &self.bins
    }

    /// Answers counted.
    pub fn n(&self) -> u64 {
        self.bins.iter().map(|bin| bin.n).sum()
    }

    /// Expected calibration error: |share that is right - mean probability| of the bins, weighted by
    /// their sizes; none of no answers.
    pub fn expected_error(&self) -> Option<f64> {
        let apart = |bin: &ReliabilityBin| (bin.probability - bin.right as f64).abs();
        self.mean(self.bins.iter().map(apart).sum())
    }

    /// Brier's score: mean of (probability - 1 where right, 0 elsewhere) squared; none of no answers.
    pub fn brier(&self) -> Option<f64> {
        self.mean(self.squares)
    }

    fn mean(&self, sum: f64) -> Option<f64> {
        let n = self.n();
        (n > 0).then(|| sum / n as f64)
    }
}

/// The reliability of answers: their probabilities, and whether they are right.
///
/// # Errors
/// [`AnnotateError::Count`]; [`AnnotateError::Setting`] for probabilities outside 0 to 1 and 0 bins.
pub fn reliability(
    probability: &[f64],
    right: &[bool],
    bins: usize,
) -> Result<Reliability, AnnotateError> {
    check(probability, right)?;
    above_zero("bins", bins as f64)?;
    let mut counts = Reliability::new(bins);
    probability.iter().zip(right).for_each(|(&p, &right)| counts.count(p, right));
    Ok(counts)
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

    /// The score whose probability, beside others of the same kind, is `share`: T ln(share).
    pub(crate) fn score_of(self, share: f64) -> f64 {
        self.0 * libm::log(share.max(f64::MIN_POSITIVE))
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
            let own = cooled[label];
            sum += log_sum(&mut cooled) - own;
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
        let found = reliability(&[0.3, 0.25], &[true, false], 10).unwrap();
        assert!((found.expected_error().unwrap() - 0.225).abs() < 1e-12);
        assert_eq!((found.n(), found.bins()[2].n), (2, 2));
        let found = reliability(&[1.0, 0.5], &[true, false], 10).unwrap();
        assert!((found.brier().unwrap() - 0.125).abs() < 1e-15);
        assert_eq!(Reliability::default().expected_error(), None);
        assert!(reliability(&[1.5], &[true], 10).is_err());
        assert!(reliability(&[0.5], &[true], 0).is_err());
        assert!(Temperature::new(0.0).is_err());
    }
}
