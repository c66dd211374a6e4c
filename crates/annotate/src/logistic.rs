//! Multinomial logistic regression.
//!
//! minimise C sum_i s_i loss_i + 1/2 |W|^2 over W (K x D) and a free bias (K), where loss_i is minus
//! the log probability of row i's label under softmax(W x + b) and s_i the weight of its label.

use mimique_stats::{Stop, minimise};
use serde::{Deserialize, Serialize};

use crate::error::{above_zero, as_many, at_most};
use crate::numbers::{dot, softmax, softmax_and_log_sum};
use crate::{AnnotateError, ClassWeight, Examples, Rows};

/// What the user decides of a logistic regression.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LogisticOptions {
    /// Weight of the losses against that of the coefficients' squares.
    pub c: f64,
    /// How much the rows of each label count.
    pub class_weight: ClassWeight,
}

impl Default for LogisticOptions {
    fn default() -> Self {
        Self { c: 1.0, class_weight: ClassWeight::Even }
    }
}

/// A logistic regression that has learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Logistic {
    coefficients: Rows,
    bias: Vec<f64>,
}

/// Largest element of the gradient, as a share of the sum of all rows' weights times C.
const GRADIENT: f64 = 1e-8;
/// Steps after which the fit is given up.
const STEPS: usize = 5000;

/// The function that is minimised, parameters label by label: D coefficients and the bias.
struct Objective<'a> {
    examples: &'a Examples,
    /// C s of each label.
    price: Vec<f64>,
    present: Vec<bool>,
}

impl Objective<'_> {
    fn parameters(&self) -> usize {
        self.examples.count() * (self.examples.rows().width() + 1)
    }

    /// Value; the gradient goes to `gradient`.
    fn value(&self, at: &[f64], gradient: &mut [f64]) -> f64 {
        let width = self.examples.rows().width();
        let mut value = 0.0;
        for (own, slope) in at.chunks_exact(width + 1).zip(gradient.chunks_exact_mut(width + 1)) {
            value += 0.5 * dot(&own[..width], &own[..width]);
            slope[..width].copy_from_slice(&own[..width]);
            slope[width] = 0.0;
        }
        let mut probability = vec![0.0; self.examples.count()];
        for (row, &label) in self.examples.rows().iter().zip(self.examples.labels()) {
            scores(at, row, &self.present, &mut probability);
            let score = probability[label];
            let all = softmax_and_log_sum(&mut probability);
            let price = self.price[label];
            value += price * (all - score);
            for (k, slope) in gradient.chunks_exact_mut(width + 1).enumerate() {
                let share = probability[k] - f64::from(u8::from(k == label));
                let pull = price * share;
                slope[..width].iter_mut().zip(row).for_each(|(g, x)| *g += pull * x);
                slope[width] += pull;
            }
        }
        value
    }
}

/// W x + b of every label; minus infinity of labels that never had a row.
fn scores(at: &[f64], row: &[f64], present: &[bool], out: &mut [f64]) {
    let width = row.len();
    for ((own, out), present) in at.chunks_exact(width + 1).zip(out).zip(present) {
        *out = if *present { dot(&own[..width], row) + own[width] } else { f64::NEG_INFINITY };
    }
}

impl Logistic {
    /// Learn. A label without rows has no coefficients and probability 0.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`], [`AnnotateError::Limit`] above 200,000 rows,
    /// [`AnnotateError::NotConverged`].
    pub fn fit(examples: &Examples, options: &LogisticOptions) -> Result<Self, AnnotateError> {
        above_zero("C", options.c)?;
        at_most("training rows", examples.rows().len(), 200_000)?;
        let weights = options.class_weight.of(examples);
        let present: Vec<bool> = examples.sizes().iter().map(|&n| n > 0).collect();
        let price: Vec<f64> = weights.iter().map(|w| options.c * w).collect();
        let objective = Objective { examples, price, present };
        let total: f64 = examples.labels().iter().map(|&l| objective.price[l]).sum();
        let start = vec![0.0; objective.parameters()];
        let stop = Stop { gradient: GRADIENT * total.max(1.0), steps: STEPS };
        let found = minimise(start, &stop, |at, gradient| objective.value(at, gradient));
        if !found.converged {
            let (steps, residual) = (STEPS, found.gradient);
            return Err(AnnotateError::NotConverged { method: "logistic", steps, residual });
        }
        let width = examples.rows().width();
        let own = || found.at.chunks_exact(width + 1);
        let coefficients = Rows::new(own().flat_map(|c| c[..width].to_vec()).collect(), width)?;
        let bias: Vec<f64> = own().map(|c| c[width]).collect();
        Ok(Self { coefficients, bias: centred(bias, &objective.present) })
    }

    /// Coefficients, a label a row.
    pub fn coefficients(&self) -> &Rows {
        &self.coefficients
    }

    /// Bias of each label, with mean 0; minus infinity of a label that never had a row.
    pub fn bias(&self) -> Vec<f64> {
        self.bias.iter().map(|&b| if b == NEVER { f64::NEG_INFINITY } else { b }).collect()
    }

    /// The probability of each label.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the row has another width.
    pub fn probabilities(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        as_many("columns", row.len(), self.coefficients.width())?;
        let scores = self.coefficients.iter().zip(&self.bias).map(|(w, b)| dot(w, row) + b);
        let mut scores: Vec<f64> = scores.collect();
        softmax(&mut scores);
        Ok(scores)
    }

    /// Whether what was read is a classifier of that many labels.
    pub(crate) fn fits(&self, labels: usize) -> bool {
        self.bias.len() == labels && self.coefficients.len() == labels
    }

    /// Columns of a row.
    pub fn width(&self) -> usize {
        self.coefficients.width()
    }
}

/// Bias of a label that never had a row: JSON has no infinity, and e^-1e300 is 0 all the same.
const NEVER: f64 = -1e300;

/// The biases with mean 0 over the labels that have rows.
fn centred(mut bias: Vec<f64>, present: &[bool]) -> Vec<f64> {
    let own = || bias.iter().zip(present).filter(|(_, present)| **present).map(|(b, _)| *b);
    let mean = own().sum::<f64>() / own().count().max(1) as f64;
    for (bias, present) in bias.iter_mut().zip(present) {
        *bias = if *present { *bias - mean } else { NEVER };
    }
    bias
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn random_examples() -> Examples {
        let mut random = Random::new(3);
        let labels: Vec<usize> = (0..60).map(|i| i % 3).collect();
        let values = labels.iter().flat_map(|&l| {
            let centre = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][l];
            [centre[0] + 0.5 * random.normal(), centre[1] + 0.5 * random.normal()]
        });
        Examples::new(Rows::new(values.collect(), 2).unwrap(), labels.clone(), 3).unwrap()
    }

    #[test]
    fn the_gradient_is_that_of_the_value() {
        let examples = random_examples();
        let objective =
            Objective { examples: &examples, price: vec![1.0, 2.0, 0.5], present: vec![true; 3] };
        let mut random = Random::new(8);
        let at: Vec<f64> = (0..9).map(|_| random.normal()).collect();
        let (mut gradient, mut unused) = (vec![0.0; 9], vec![0.0; 9]);
        objective.value(&at, &mut gradient);
        for p in 0..9 {
            let mut beside = |step: f64| {
                let mut moved = at.clone();
                moved[p] += step;
                objective.value(&moved, &mut unused)
            };
            let slope = (beside(1e-5) - beside(-1e-5)) / 2e-5;
            assert!((slope - gradient[p]).abs() < 1e-6 * slope.abs().max(1.0), "{p}");
        }
    }

    #[test]
    fn the_order_of_rows_and_columns_does_not_matter_and_an_absent_label_has_no_chance() {
        let examples = random_examples();
        let plain = Logistic::fit(&examples, &LogisticOptions::default()).unwrap();
        let n = examples.rows().len();
        let turned: Vec<f64> = (0..n)
            .rev()
            .flat_map(|r| [examples.rows().row(r)[1], examples.rows().row(r)[0]])
            .collect();
        let labels: Vec<usize> = examples.labels().iter().rev().copied().collect();
        let turned = Examples::new(Rows::new(turned, 2).unwrap(), labels, 4).unwrap();
        let turned = Logistic::fit(&turned, &LogisticOptions::default()).unwrap();
        let (one, other) =
            (plain.probabilities(&[0.3, 0.9]).unwrap(), turned.probabilities(&[0.9, 0.3]).unwrap());
        one.iter().zip(&other).for_each(|(a, b)| assert!((a - b).abs() < 1e-6));
        assert_eq!(other[3], 0.0);
        assert_eq!(turned.bias()[3], f64::NEG_INFINITY);
    }
}
