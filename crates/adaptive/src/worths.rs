//! The worths of items under the answers so far: Bradley and Terry's model with a normal prior, its
//! posterior by Laplace's approximation.
//!
//! P(a is chosen over b) = logistic(w_a - w_b); each w ~ N(0, sd²) before the first answer; a tie counts half
//! a win to each. Nothing here needs the answers to connect the items: the prior does.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::psychometric::logistic;

/// How often of two items the first was chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// One item.
    pub a: usize,
    /// The other.
    pub b: usize,
    /// Choices of `a`; a tie is half a choice.
    pub wins: f64,
    /// Answers in all, from `wins` up.
    pub answers: f64,
}

impl Comparison {
    /// One answer: `share` is 1 where `a` was chosen, 0 where `b` was, one half for a tie.
    pub fn one(a: usize, b: usize, share: f64) -> Self {
        Self { a, b, wins: share, answers: 1.0 }
    }
}

/// A normal posterior of the worths.
#[derive(Debug, Clone, PartialEq)]
pub struct Worths {
    /// Its mode, an item each.
    pub mean: Vec<f64>,
    /// Its covariance, row by row.
    pub covariance: Vec<f64>,
}

/// Newton's steps, at most. From 0 the posterior's mode is reached in a few; halving keeps each a step up.
const STEPS: usize = 100;
/// A step below this is rounding.
const SETTLED: f64 = 1e-13;

impl Worths {
    /// The posterior of `items` items under comparisons of them, with a prior standard deviation above 0.
    ///
    /// # Panics
    /// For an item of a comparison that is not below `items`.
    pub fn of(items: usize, comparisons: &[Comparison], prior_sd: f64) -> Self {
        let precision = 1.0 / (prior_sd * prior_sd);
        let mut mean = DVector::zeros(items);
        let mut height = log_posterior(&mean, comparisons, precision);
        for _ in 0..STEPS {
            let (score, information) = derivatives(&mean, comparisons, precision);
            let Some(factor) = Cholesky::new(information) else { break };
            let step = factor.solve(&score);
            let mut share = 1.0;
            let (next, next_height) = loop {
                let next = &mean + share * &step;
                let next_height = log_posterior(&next, comparisons, precision);
                if next_height >= height || share < 1e-9 {
                    break (next, next_height);
                }
                share /= 2.0;
            };
            let way = (&next - &mean).amax();
            // Near the mode a step changes the height by less than rounding: it is taken all the same.
            (mean, height) = (next, next_height.max(height));
            if way <= SETTLED * (1.0 + mean.amax()) {
                break;
            }
        }
        let (_, information) = derivatives(&mean, comparisons, precision);
        // The prior keeps it positive definite; answers beyond counting (1e15) would make it so no more.
        let covariance = Cholesky::new(information).map_or_else(
            || DMatrix::from_diagonal_element(items, items, 1.0 / precision),
            |f| f.inverse(),
        );
        Self { mean: mean.as_slice().to_vec(), covariance: covariance.as_slice().to_vec() }
    }

    /// Variance of the difference of two worths.
    pub fn variance_of_difference(&self, a: usize, b: usize) -> f64 {
        let items = self.mean.len();
        let at = |i: usize, j: usize| self.covariance[i * items + j];
        at(a, a) + at(b, b) - 2.0 * at(a, b)
    }
}

fn log_posterior(worths: &DVector<f64>, comparisons: &[Comparison], precision: f64) -> f64 {
    // ln logistic(x), without overflow.
    let ln =
        |x: f64| if x > 0.0 { -libm::log1p(libm::exp(-x)) } else { x - libm::log1p(libm::exp(x)) };
    let likelihood: f64 = comparisons
        .iter()
        .map(|c| {
            let difference = worths[c.a] - worths[c.b];
            c.wins * ln(difference) + (c.answers - c.wins) * ln(-difference)
        })
        .sum();
    likelihood - 0.5 * precision * worths.norm_squared()
}

/// The score, and minus the second derivatives.
fn derivatives(
    worths: &DVector<f64>,
    comparisons: &[Comparison],
    precision: f64,
) -> (DVector<f64>, DMatrix<f64>) {
    let items = worths.len();
    let mut score = worths * -precision;
    let mut information = DMatrix::from_diagonal_element(items, items, precision);
    for c in comparisons {
        let p = logistic(worths[c.a] - worths[c.b]);
        let surprise = c.wins - c.answers * p;
        score[c.a] += surprise;
        score[c.b] -= surprise;
        let weight = c.answers * p * (1.0 - p);
        information[(c.a, c.a)] += weight;
        information[(c.b, c.b)] += weight;
        information[(c.a, c.b)] -= weight;
        information[(c.b, c.a)] -= weight;
    }
    (score, information)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers() -> Vec<Comparison> {
        vec![
            Comparison::one(0, 1, 1.0),
            Comparison { a: 1, b: 2, wins: 3.0, answers: 7.0 },
            Comparison::one(2, 0, 0.5),
            Comparison { a: 3, b: 0, wins: 4.0, answers: 4.0 },
        ]
    }

    #[test]
    fn at_the_mode_the_score_is_nothing_and_the_covariance_is_the_inverse_information() {
        let worths = Worths::of(5, &answers(), 1.5);
        let mean = DVector::from_vec(worths.mean.clone());
        let precision = 1.0 / 2.25;
        let (score, information) = derivatives(&mean, &answers(), precision);
        assert!(score.amax() < 1e-12, "{score}");
        let covariance = DMatrix::from_column_slice(5, 5, &worths.covariance);
        let identity = information * covariance;
        assert!((identity - DMatrix::identity(5, 5)).amax() < 1e-12);
        // The score is the slope of the log posterior.
        for item in 0..5 {
            let mut off = mean.clone();
            off[item] += 0.4;
            let step = |by: f64| {
                let mut at = off.clone();
                at[item] += by;
                log_posterior(&at, &answers(), precision)
            };
            let slope = (step(1e-5) - step(-1e-5)) / 2e-5;
            let (score, _) = derivatives(&off, &answers(), precision);
            assert!((slope - score[item]).abs() < 1e-8, "{slope} {score}");
        }
    }

    #[test]
    fn an_item_without_answers_keeps_its_prior() {
        let worths = Worths::of(5, &answers(), 1.5);
        assert!(worths.mean[4].abs() < 1e-15);
        assert!((worths.covariance[24] - 2.25).abs() < 1e-12);
        let none = Worths::of(2, &[], 1.0);
        assert_eq!(none.mean, [0.0, 0.0]);
        assert!((none.variance_of_difference(0, 1) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn one_item_that_always_wins_has_a_finite_worth() {
        let many = [Comparison { a: 0, b: 1, wins: 1e6, answers: 1e6 }];
        let worths = Worths::of(2, &many, 1.0);
        assert!(worths.mean[0] > 3.0 && worths.mean[0] < 10.0, "{:?}", worths.mean);
        assert!((worths.mean[0] + worths.mean[1]).abs() < 1e-12);
    }
}
