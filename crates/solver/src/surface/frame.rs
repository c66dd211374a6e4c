//! A frame of the surface: where its markers go, from where they were seen.
//!
//! With the surface's stiffness K (P x P) each coordinate is a problem of P unknowns y:
//!
//! - hard (stiffness 0, eq. 2.17): y = d at the markers that are seen; where a marker is lost its
//!   vertex is free, K_ll y_l = -K_ls d_s;
//! - soft: minimise sum over m of i_m (y_m - d_m)^2 + stiffness y^T K y / tau, tau = tr(K) / P, i_m
//!   the marker's importance. It tends to the hard one as the stiffness vanishes.
//!
//! Both are linear in d, so that a set of seen markers has one P x P matrix.

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::{dot, mul};
use crate::quadratic::box_qp::{Outcome, worse};

/// How far a marker goes at weight 1 of its "shapes", metres: weights are in centimetres.
pub const METRES_PER_WEIGHT: f64 = 0.01;

/// K and the importances.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceProblem {
    /// P x P, without a unit.
    pub(crate) stiffness: Vec<f64>,
    /// `stiffness / tau` of the soft problem; 0 is the hard one.
    pub(crate) softness: f64,
}

impl SurfaceProblem {
    /// From H of the surface's operators (3P x 3P) and the stiffness that the method asks for.
    pub(crate) fn new(shell_gram: &[f64], markers: usize, stiffness: f64) -> SurfaceProblem {
        let n = 3 * markers;
        let unit = METRES_PER_WEIGHT * METRES_PER_WEIGHT;
        let k: Vec<f64> = (0..markers * markers)
            .map(|i| shell_gram[3 * (i / markers) * n + 3 * (i % markers)] / unit)
            .collect();
        let trace = (0..markers).fold(0.0, |sum, i| sum + k[i * markers + i]);
        SurfaceProblem { stiffness: k, softness: stiffness / (trace / markers as f64) }
    }

    /// The P x P matrix from d (each times the root of its importance) to y, metres to metres.
    /// Columns of markers that are not seen, or have no importance, are 0.
    pub(crate) fn matrix(&self, missing: &[bool], importance: &[f64]) -> Vec<f64> {
        let p = missing.len();
        let gone: Vec<bool> =
            missing.iter().zip(importance).map(|(&gone, &w)| gone || !(w > 0.0)).collect();
        let mut out = vec![0.0; p * p];
        let mut factor = Cholesky::default();
        if self.softness == 0.0 {
            let lost: Vec<usize> = (0..p).filter(|&m| gone[m]).collect();
            factor.reset(lost.len());
            for (i, &a) in lost.iter().enumerate() {
                let row = factor.row_mut(i).iter_mut();
                row.zip(&lost[i..]).for_each(|(x, &b)| *x = self.stiffness[a * p + b]);
            }
            factor.factor();
            let mut right = vec![0.0; lost.len()];
            for seen in (0..p).filter(|&m| !gone[m]) {
                let root = importance[seen].sqrt();
                out[seen * p + seen] = 1.0 / root;
                for (x, &a) in right.iter_mut().zip(&lost) {
                    *x = -self.stiffness[a * p + seen] / root;
                }
                if !lost.is_empty() {
                    factor.solve(&mut right);
                }
                right.iter().zip(&lost).for_each(|(x, &a)| out[a * p + seen] = *x);
            }
        } else {
            factor.reset(p);
            for i in 0..p {
                for (x, j) in factor.row_mut(i).iter_mut().zip(i..) {
                    *x = self.softness * self.stiffness[i * p + j];
                    if i == j && !gone[i] {
                        *x += importance[i];
                    }
                }
            }
            factor.factor();
            let mut column = vec![0.0; p];
            for seen in (0..p).filter(|&m| !gone[m]) {
                column.fill(0.0);
                column[seen] = importance[seen].sqrt();
                factor.solve(&mut column);
                (0..p).for_each(|i| out[i * p + seen] = column[i]);
            }
        }
        out
    }

    /// The 3P weights of a frame; `d` has the 3P displacements, each times the root of its marker's
    /// importance, 0 where a marker is not seen. Also says how far the equations are met, and the
    /// energy y^T K y of the three coordinates, m^2.
    pub(crate) fn solve(
        &self,
        matrix: &[f64],
        missing: &[bool],
        importance: &[f64],
        d: &[f64],
        weights: &mut [f64],
    ) -> (Outcome, f64) {
        let p = missing.len();
        let (mut seen, mut y, mut force) = (vec![0.0; p], vec![0.0; p], vec![0.0; p]);
        let (mut energy, mut kkt_error) = (0.0, 0.0_f64);
        for axis in 0..3 {
            for (m, x) in seen.iter_mut().enumerate() {
                *x = d[3 * m + axis];
            }
            mul(matrix, &seen, &mut y);
            mul(&self.stiffness, &y, &mut force);
            energy += dot(&y, &force);
            for m in 0..p {
                weights[3 * m + axis] = y[m] / METRES_PER_WEIGHT;
                let counts = !missing[m] && importance[m] > 0.0;
                let own = self.stiffness[m * p + m];
                let (gradient, curvature) = if self.softness > 0.0 {
                    let pull = if counts {
                        importance[m] * y[m] - importance[m].sqrt() * seen[m]
                    } else {
                        0.0
                    };
                    let weight = if counts { importance[m] } else { 0.0 };
                    (self.softness * force[m] + pull, self.softness * own + weight)
                } else if counts {
                    (y[m] - seen[m] / importance[m].sqrt(), 1.0)
                } else {
                    (force[m], own)
                };
                if curvature > 0.0 {
                    let error = gradient / curvature / METRES_PER_WEIGHT;
                    kkt_error = worse(kkt_error, error.abs());
                }
            }
        }
        (Outcome { iterations: 1, kkt_error, converged: kkt_error < 1e-6 }, energy)
    }
}
