//! Newton's method with a line search, for the methods with soft bounds.
//!
//! Stops on the step, not on the gradient: a relative gradient of 1e-6 leaves 1.6e-4 in the weights.

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::dot;
use crate::newton::objective::{Evaluation, Matrices, Objective, Target};
use crate::quadratic::box_qp::{Outcome, worse};

/// A Newton step below this ends the search; as Newton converges quadratically, what is left is far
/// below.
pub(crate) const STEP_TOLERANCE: f64 = 1e-8;

/// A step with an older factor leaves up to a tenth of itself behind: it has to be smaller.
const REFINED_TOLERANCE: f64 = 1e-12;

/// Newton needs 4-8 steps from a cold start; the majorised steps of a poor start some tens.
const MOST_STEPS: u32 = 200;

/// Memory of a search.
#[derive(Debug, Clone, Default)]
pub(crate) struct NewtonState {
    here: Evaluation,
    there: Evaluation,
    factor: Cholesky,
    /// Whether `factor` is of an earlier search or step.
    factored: bool,
    diagonal: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
}

impl NewtonState {
    /// Forget the last search: the next one makes a factor of its own first.
    pub(crate) fn reset(&mut self) {
        self.factored = false;
    }

    /// |Dc - d|^2 at the last point.
    pub(crate) fn misfit(&self) -> f64 {
        self.here.misfit
    }

    /// Minimise from `c`, in place. The first step is made with the last search's factor, where
    /// there is one: consecutive frames curve alike, and a step costs a tenth of a factor.
    pub(crate) fn minimise(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        target: Target<'_>,
        c: &mut [f64],
    ) -> Outcome {
        objective.evaluate(m, target, c, &mut self.here);
        let mut iterations = 0;
        let mut converged = false;
        if self.factored {
            let size = self.step_downhill();
            if size > STEP_TOLERANCE && self.advance(objective, m, target, c, 1) {
                iterations = 1;
                converged = self.refine(objective, m, target, c, size);
            }
        }
        while !converged && iterations < MOST_STEPS {
            iterations += 1;
            self.factor_hessian(objective, m, false);
            let size = self.step_downhill();
            if size <= STEP_TOLERANCE {
                self.take_step(objective, m, target, c);
                converged = true;
            } else if self.advance(objective, m, target, c, 1) {
                converged = self.refine(objective, m, target, c, size);
            } else {
                // The full Newton step overshoots: take the step of the majorising quadratic.
                self.factor_hessian(objective, m, true);
                self.step_downhill();
                if !self.advance(objective, m, target, c, 40) {
                    break;
                }
            }
        }
        let kkt_error = (self.here.gradient.iter().zip(&self.diagonal))
            .fold(0.0, |worst: f64, (g, h)| worse(worst, (g / h).abs()));
        Outcome { iterations, kkt_error, converged: converged && kkt_error.is_finite() }
    }

    /// After a Newton step of the given size: further steps with the same factor, a tenth of the
    /// cost, as long as each is a tenth of the last. Whether the tolerance was reached.
    fn refine(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        target: Target<'_>,
        c: &mut [f64],
        mut size: f64,
    ) -> bool {
        loop {
            let next = self.step_downhill();
            // `!(<)` so that NaN ends the loop. Steps above a thousandth are left to the search.
            if !(next < 0.1 * size && next < 1e-3) {
                return false;
            }
            self.take_step(objective, m, target, c);
            if next <= REFINED_TOLERANCE {
                return true;
            }
            size = next;
        }
    }

    fn factor_hessian(&mut self, objective: &Objective, m: Matrices<'_>, majorised: bool) {
        objective.hessian(m, &self.here, majorised, &mut self.factor);
        self.diagonal.resize(self.here.gradient.len(), 0.0);
        for (i, h) in self.diagonal.iter_mut().enumerate() {
            *h = self.factor.row_mut(i)[0];
        }
        self.factor.factor();
        self.factored = true;
    }

    /// The step of the factor from here, and its largest entry.
    fn step_downhill(&mut self) -> f64 {
        self.step.clear();
        self.step.extend(self.here.gradient.iter().map(|g| -g));
        self.factor.solve(&mut self.step);
        self.step.iter().fold(0.0, |s: f64, x| if s >= x.abs() { s } else { x.abs() })
    }

    /// A small step, taken whole: the values on both sides differ by rounding only.
    fn take_step(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        target: Target<'_>,
        c: &mut [f64],
    ) {
        for (c, p) in c.iter_mut().zip(&self.step) {
            *c += p;
        }
        objective.evaluate(m, target, c, &mut self.here);
    }

    /// Go along the step, halved up to `tries` - 1 times until the value falls enough (Armijo).
    fn advance(
        &mut self,
        objective: &Objective,
        m: Matrices<'_>,
        target: Target<'_>,
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
            objective.evaluate(m, target, &self.trial, &mut self.there);
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
