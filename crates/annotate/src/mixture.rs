//! Mixtures of Gaussians with diagonal covariances: what a state of a hidden Markov model emits
//! (short paper, eq. 8).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::error::as_many;
use crate::numbers::{log_sum, weighted_distance};
use crate::{AnnotateError, Rows};

/// A mixture of M Gaussians in D dimensions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Mixture {
    pub(crate) weight: Vec<f64>,
    pub(crate) mean: Rows,
    pub(crate) variance: Rows,
}

/// A mixture as a file has it.
#[derive(Deserialize)]
struct Unchecked {
    weight: Vec<f64>,
    mean: Rows,
    variance: Rows,
}

impl TryFrom<Unchecked> for Mixture {
    type Error = AnnotateError;

    fn try_from(Unchecked { weight, mean, variance }: Unchecked) -> Result<Self, AnnotateError> {
        Self::new(weight, mean, variance)
    }
}

/// How far probabilities may be from adding to 1: files round them.
const ADDED: f64 = 1e-3;

/// Refuses what is not a list of probabilities that add to 1.
pub(crate) fn probabilities(what: &'static str, values: &[f64]) -> Result<(), AnnotateError> {
    let range = "from 0 to 1, all together 1";
    let sum: f64 = values.iter().sum();
    let outside = values.iter().copied().find(|v| !(0.0..=1.0 + ADDED).contains(v));
    let together = (1.0 - ADDED..=1.0 + ADDED).contains(&sum);
    match outside.or((!together).then_some(sum)) {
        Some(value) => Err(AnnotateError::Setting { setting: what, value, range }),
        None => Ok(()),
    }
}

impl Mixture {
    /// M weights, M means and M variances (a component a row). A weight of 0 is a component that
    /// is not there.
    ///
    /// # Errors
    /// [`AnnotateError::Count`]; [`AnnotateError::Setting`] for weights that do not add to 1 and
    /// variances that are not above 0.
    pub fn new(weight: Vec<f64>, mean: Rows, variance: Rows) -> Result<Self, AnnotateError> {
        as_many("means of a mixture", mean.len(), weight.len())?;
        as_many("variances of a mixture", variance.len(), weight.len())?;
        as_many("columns of the variances", variance.width(), mean.width())?;
        probabilities("weights of a mixture", &weight)?;
        for &value in variance.values() {
            crate::error::above_zero("variance", value)?;
        }
        Ok(Self { weight, mean, variance })
    }

    /// Share of each component.
    pub fn weight(&self) -> &[f64] {
        &self.weight
    }

    /// Mean of each component, a component a row.
    pub fn mean(&self) -> &Rows {
        &self.mean
    }

    /// Variances of each component, a component a row.
    pub fn variance(&self) -> &Rows {
        &self.variance
    }

    /// What the density needs of every component, once.
    pub(crate) fn density(&self) -> Density<'_> {
        let constant = |(weight, variance): (&f64, &[f64])| {
            let logs: f64 = variance.iter().map(|v| libm::log(2.0 * PI * v)).sum();
            libm::log(*weight) - logs / 2.0
        };
        Density {
            constant: self.weight.iter().zip(self.variance.iter()).map(constant).collect(),
            mean: &self.mean,
            precision: self.variance.values().iter().map(|v| 0.5 / v).collect(),
        }
    }

    /// ln of the density at a row.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the row has another width.
    pub fn log_density(&self, row: &[f64]) -> Result<f64, AnnotateError> {
        as_many("columns", row.len(), self.mean.width())?;
        let mut components = vec![0.0; self.weight.len()];
        Ok(self.density().of(row, &mut components))
    }
}

/// A mixture ready to be evaluated: ln(weight / sqrt(|2 pi variance|)), means, 1 / (2 variance).
pub(crate) struct Density<'a> {
    constant: Vec<f64>,
    mean: &'a Rows,
    precision: Vec<f64>,
}

impl Density<'_> {
    /// ln of the density; that of each component goes to `components`.
    pub(crate) fn of(&self, row: &[f64], components: &mut [f64]) -> f64 {
        let own = self.mean.iter().zip(self.precision.chunks_exact(row.len()));
        for ((out, constant), (mean, precision)) in
            components.iter_mut().zip(&self.constant).zip(own)
        {
            if *constant == f64::NEG_INFINITY {
                *out = *constant;
                continue;
            }
            *out = constant - weighted_distance(row, mean, precision);
        }
        log_sum(components)
    }

    pub(crate) fn components(&self) -> usize {
        self.constant.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_adds_to_one() {
        let mean = Rows::new(vec![-1.0, 2.0], 1).unwrap();
        let variance = Rows::new(vec![0.25, 1.0], 1).unwrap();
        let mixture = Mixture::new(vec![0.3, 0.7], mean, variance).unwrap();
        let step = 0.01;
        let at = (-1000..1000).map(|i| f64::from(i) * step);
        let sum: f64 = at.map(|x| mixture.log_density(&[x]).unwrap().exp() * step).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn a_component_of_weight_0_is_not_there_and_nonsense_is_refused() {
        let rows = |v: &[f64]| Rows::new(v.to_vec(), 1).unwrap();
        let of = |w: &[f64], v: &[f64]| Mixture::new(w.to_vec(), rows(&[0.0, 5.0]), rows(v));
        let (one, other) = (of(&[1.0, 0.0], &[1.0, 1.0]), of(&[1.0, 0.0], &[1.0, 9.0]));
        let at = |m: Mixture| m.log_density(&[5.0]).unwrap();
        assert_eq!(at(one.unwrap()), at(other.unwrap()));
        assert!(of(&[0.5, 0.4], &[1.0, 1.0]).is_err());
        assert!(of(&[0.5, 0.5], &[1.0, 0.0]).is_err());
    }
}
