//! The maximum of the likelihood, and how far the coefficients are known.

use nalgebra::{Cholesky, DMatrix};
use rayon::prelude::*;

use super::laplace::Data;
use crate::numerics::minimise::{Stop, minimise};

/// Largest element of the gradient at a maximum.
pub(super) const GRADIENT: f64 = 1e-5;
/// What the search aims at.
const AIM: f64 = 1e-6;
/// Steps of the search.
const STEPS: usize = 400;
/// A standard deviation that is held against 0, and how little the likelihood may lose by that.
const SMALL_SD: f64 = 0.03;
const SAME: f64 = 1e-6;
/// Searches, at most: one that ends where a standard deviation of 0 is the worst, or short of the maximum, is
/// followed by another one from there.
const ROUNDS: usize = 4;
/// Step of the differences of gradients that give second derivatives.
const DIFFERENCE: f64 = 1e-4;

/// A fitted model.
#[derive(Clone)]
pub(super) struct Fit {
    /// The parameters.
    pub at: Vec<f64>,
    pub log_likelihood: f64,
    /// Largest element of the gradient.
    pub gradient: f64,
    pub thresholds: Vec<f64>,
    pub coefficients: Vec<f64>,
    /// Standard deviations by the model's terms.
    pub sds: Vec<f64>,
    modes: Vec<f64>,
}

impl Fit {
    pub(super) fn converged(&self) -> bool {
        self.gradient < GRADIENT
    }
}

/// Where minus a log likelihood is least.
pub(super) struct Least {
    pub at: Vec<f64>,
    pub value: f64,
    /// Largest element of the gradient.
    pub gradient: f64,
}

/// The least of minus a log likelihood whose parameters are standard deviations (of either sign) from `first_sd` on.
/// One that is 0 is exactly 0.
pub(super) fn least(
    start: Vec<f64>,
    first_sd: usize,
    mut objective: impl FnMut(&[f64], &mut [f64]) -> f64,
) -> Least {
    let mut start = start;
    let mut slopes = vec![0.0; start.len()];
    let mut rounds = 0;
    loop {
        rounds += 1;
        let stop = Stop { gradient: AIM, steps: STEPS };
        let mut found = minimise(start, &stop, &mut objective);
        let mut escaped = false;
        for place in first_sd..found.at.len() {
            if found.at[place].abs() > SMALL_SD {
                continue;
            }
            let mut probe = |sd: f64| {
                let mut at = found.at.clone();
                at[place] = sd;
                objective(&at, &mut slopes)
            };
            // At 0 the slope is 0 by symmetry, also where 0 is the worst of all.
            if rounds < ROUNDS && probe(3.0 * SMALL_SD) < found.value - SAME {
                found.at[place] = 3.0 * SMALL_SD;
                escaped = true;
            } else if probe(0.0) <= found.value + SAME {
                found.at[place] = 0.0;
            }
        }
        let value = objective(&found.at, &mut slopes);
        let gradient = slopes.iter().fold(0.0_f64, |most, slope| {
            if slope.is_nan() { f64::INFINITY } else { most.max(slope.abs()) }
        });
        // Beside a deviation that became 0 the others move a little further.
        if rounds < ROUNDS && (escaped || gradient > AIM) {
            start = found.at;
            continue;
        }
        return Least { at: found.at, value, gradient };
    }
}

/// The maximum of the likelihood.
pub(super) fn fit(data: &Data) -> Fit {
    let mut objective = data.objective();
    let first_sd = data.parameters() - data.layout.terms.len();
    let found = least(data.start(), first_sd, |at, gradient| objective.value(at, gradient));
    let own = data.split(&found.at);
    let mut sds = vec![0.0; data.layout.terms.len()];
    for (term, sd) in data.layout.terms.iter().zip(own.sds) {
        sds[*term] = sd.abs();
    }
    Fit {
        log_likelihood: -found.value,
        gradient: found.gradient,
        thresholds: own.thresholds.values().to_vec(),
        coefficients: own.coefficients.to_vec(),
        sds,
        modes: objective.modes,
        at: found.at,
    }
}

/// Covariance of the coefficients: the inverse of the second derivatives by all parameters but standard deviations of
/// 0, by differences of the exact gradient. None where these are not positive definite.
pub(super) fn covariance(data: &Data, fit: &Fit) -> Option<DMatrix<f64>> {
    let first_sd = data.parameters() - data.layout.terms.len();
    let free: Vec<usize> =
        (0..fit.at.len()).filter(|place| *place < first_sd || fit.at[*place] != 0.0).collect();
    let rows: Vec<Vec<f64>> = free
        .par_iter()
        .map(|place| {
            let mut objective = data.objective();
            objective.modes.clone_from(&fit.modes);
            let mut sides = [vec![0.0; fit.at.len()], vec![0.0; fit.at.len()]];
            for (side, by) in sides.iter_mut().zip([DIFFERENCE, -DIFFERENCE]) {
                let mut at = fit.at.clone();
                at[*place] += by;
                objective.value(&at, side);
            }
            let [above, below] = sides;
            free.iter().map(|other| (above[*other] - below[*other]) / (2.0 * DIFFERENCE)).collect()
        })
        .collect();
    let size = free.len();
    let second = DMatrix::from_fn(size, size, |i, j| (rows[i][j] + rows[j][i]) / 2.0);
    let inverse = Cholesky::new(second)?.inverse();
    let coefficients = data.categories - 1;
    Some(inverse.view((coefficients, coefficients), (data.columns, data.columns)).into_owned())
}
