//! Newton's method with a line search, for the methods with soft bounds.
//!
//! Stops on the step, not on the gradient: a relative gradient of 1e-6 leaves 1.6e-4 in the weights.

use crate::box_qp::Outcome;
use crate::dense::{Cholesky, dot};
use crate::objective::{Evaluation, Matrices, Objective};

/// A Newton step below this ends the search; as Newton converges quadratically, what is left is far
/// below.
pub(crate) const STEP_TOLERANCE: f64 = 1e-8;

/// Newton needs 4-8 steps from a cold start; the majorised steps of a poor start some tens.
const MOST_STEPS: u32 = 200;

/// Memory of a search.
#[derive(Debug, Clone, Default)]
pub(crate) struct NewtonState {
    here: Evaluation,
    there: Evaluation,
    factor: Cholesky,
    diagonal: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
}

impl NewtonState {
    /// |Dc - d|^2 at the last point.
    pub(crate) fn misfit(&self) -> f64 {
        self.here.misfit
    }

    /// Minimise from `c`, in place.
    pub(crate) fn minimise(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        d: &[f64],
        c: &mut [f64],
    ) -> Outcome {
        objective.evaluate(m, d, c, &mut self.here);
        let mut iterations = 0;
        let mut converged = false;
        while !converged && iterations < MOST_STEPS {
            iterations += 1;
            let whole = self.newton_step(objective, m, false);
            converged = whole <= STEP_TOLERANCE;
            if converged || self.advance(objective, m, d, c, 1) {
                if converged {
                    self.take_step(objective, m, d, c);
                }
                continue;
            }
            // The full Newton step overshoots: take the step of the majorising quadratic.
            self.newton_step(objective, m, true);
            if !self.advance(objective, m, d, c, 40) {
                break;
            }
        }
        let kkt_error = (self.here.gradient.iter().zip(&self.diagonal))
            .fold(0.0, |worst: f64, (g, h)| worst.max((g / h).abs()));
        Outcome { iterations, kkt_error, converged: converged && kkt_error.is_finite() }
    }

    /// The step, and its largest entry.
    fn newton_step(&mut self, objective: &Objective, m: Matrices<'_>, majorised: bool) -> f64 {
        let n = self.here.gradient.len();
        self.factor.reset(n);
        self.diagonal.resize(n, 0.0);
        for i in 0..n {
            let row = self.factor.row_mut(i);
            objective.hessian_row(m, &self.here, majorised, i, row);
            self.diagonal[i] = row[0];
        }
        self.factor.factor();
        self.step.clear();
        self.step.extend(self.here.gradient.iter().map(|g| -g));
        self.factor.solve(&mut self.step);
        self.step.iter().fold(0.0, |s, x| s.max(x.abs()))
    }

    /// The last, tiny step: taken whole, without comparing values that differ by rounding.
    fn take_step(&mut self, objective: &Objective, m: Matrices<'_>, d: &[f64], c: &mut [f64]) {
        for (c, p) in c.iter_mut().zip(&self.step) {
            *c += p;
        }
        objective.evaluate(m, d, c, &mut self.here);
    }

    /// Go along the step, halved up to `tries` - 1 times until the value falls enough (Armijo).
    fn advance(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        d: &[f64],
        c: &mut [f64],
        tries: u32,
    ) -> bool {
        let slope = dot(&self.here.gradient, &self.step);
        // Values that differ by less are equal but for rounding.
        let noise = 1e-15 * self.here.value.abs();
        let mut t = 1.0;
        for _ in 0..tries {
            self.trial.clear();
            self.trial.extend(c.iter().zip(&self.step).map(|(c, p)| c + t * p));
            objective.evaluate(m, d, &self.trial, &mut self.there);
            if self.there.value <= self.here.value + 1e-4 * t * slope + noise {
                c.copy_from_slice(&self.trial);
                std::mem::swap(&mut self.here, &mut self.there);
                return true;
            }
            t *= 0.5;
        }
        false
    }
}
