//! Mixtures of Gaussians with diagonal covariances: what a state of a hidden Markov model emits
//! (short paper, eq. 8).

use std::f64::consts::PI;

use mimique_solver::widest;
use serde::{Deserialize, Serialize};

use crate::error::as_many;
use crate::numbers::{BLOCK, LANES, log_sum, together};
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
        self.density().components(row, &mut components);
        Ok(log_sum(&mut components))
    }
}

/// A mixture ready to be evaluated: ln(weight / sqrt(|2 pi variance|)), means, 1 / (2 variance).
pub(crate) struct Density<'a> {
    constant: Vec<f64>,
    mean: &'a Rows,
    precision: Vec<f64>,
}

impl Density<'_> {
    /// ln of each component's part of the density at a block of frames, one after the other; the parts
    /// of a frame go to `components`, M numbers a frame. Fewer frames than a block are allowed.
    pub(crate) fn components(&self, frames: &[f64], components: &mut [f64]) {
        let width = self.mean.width();
        if frames.len() == BLOCK * width {
            block_of_components(
                frames,
                &self.constant,
                self.mean.values(),
                &self.precision,
                components,
            );
            return;
        }
        let each = frames.chunks_exact(width).zip(components.chunks_exact_mut(self.constant.len()));
        for (frame, components) in each {
            frame_of_components(
                frame,
                &self.constant,
                self.mean.values(),
                &self.precision,
                components,
            );
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.constant.len()
    }
}

/// constant - sum (x - mean)^2 precision, in the lanes of [`crate::numbers::dot`].
#[inline(always)]
fn component(frame: &[f64], constant: f64, mean: &[f64], precision: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (frame, frame_rest) = frame.as_chunks::<LANES>();
    let (mean, mean_rest) = mean.as_chunks::<LANES>();
    let (precision, precision_rest) = precision.as_chunks::<LANES>();
    for ((x, m), p) in frame.iter().zip(mean).zip(precision) {
        for lane in 0..LANES {
            let way = x[lane] - m[lane];
            sums[lane] += way * way * p[lane];
        }
    }
    let mut sum = together(sums);
    for ((x, m), p) in frame_rest.iter().zip(mean_rest).zip(precision_rest) {
        sum += (x - m) * (x - m) * p;
    }
    constant - sum
}

widest! {
    /// The components at one frame.
    fn frame_of_components(
        frame: &[f64],
        constants: &[f64],
        means: &[f64],
        precisions: &[f64],
        out: &mut [f64]
    ) {
        let width = frame.len();
        for m in 0..constants.len() {
            let own = m * width..(m + 1) * width;
            out[m] = component(frame, constants[m], &means[own.clone()], &precisions[own]);
        }
    }
}

widest! {
    /// The components at [`BLOCK`] frames.
    fn block_of_components(
        frames: &[f64],
        constants: &[f64],
        means: &[f64],
        precisions: &[f64],
        out: &mut [f64]
    ) {
        let (width, count) = (frames.len() / BLOCK, constants.len());
        for m in 0..count {
            let own = m * width..(m + 1) * width;
            let (mean, precision) = (&means[own.clone()], &precisions[own]);
            for f in 0..BLOCK {
                let frame = &frames[f * width..(f + 1) * width];
                out[f * count + m] = component(frame, constants[m], mean, precision);
            }
        }
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
