//! Frames whose method is a quadratic programme: solved one after the other, or for a window of frames.

use crate::fit::frame::FrameSolver;
use crate::fit::report::FrameReport;
use crate::fit::setup::Quadratic;
use crate::linear_algebra::dense::mul_transposed;
use crate::quadratic::box_qp::Outcome;

impl FrameSolver<'_> {
    /// A quadratic programme in a box, from the weights of the frame before, which are in
    /// `self.weights`.
    pub(super) fn solve_quadratic(&mut self, quadratic: &Quadratic) -> Outcome {
        let visible = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        let Quadratic { data_weight, linear, last_frame, cancelling, bounds, .. } = quadratic;
        mul_transposed(&visible.deltas, &self.displacements, &mut self.right);
        for (x, last) in self.right.iter_mut().zip(&self.weights) {
            *x = data_weight * *x - linear + last_frame * last;
        }
        let (system, right, c) = (&visible.system, &self.right, &mut self.weights);
        let first = self.qp.solve(system, right, bounds, c);
        self.held.clear();
        self.held.extend_from_slice(bounds);
        for &[i, j] in cancelling {
            let weaker = if c[i] >= c[j] { j } else { i };
            let [low, high] = bounds[weaker];
            self.held[weaker] = [0.0_f64.clamp(low, high); 2];
        }
        // Weights that are where they would be held change nothing.
        if c.iter().zip(&self.held).all(|(c, [low, high])| low <= c && c <= high) {
            return first;
        }
        let second = self.qp.solve(system, right, &self.held, c);
        let converged = first.converged && second.converged;
        Outcome { iterations: first.iterations + second.iterations, converged, ..second }
    }

    /// Solve a frame by itself; whether other markers are missing than before.
    pub(crate) fn solve_alone(&mut self, d: &[f64]) -> (Outcome, bool) {
        let (_, changed) = self.take_in(d);
        (self.answer().outcome, changed)
    }

    /// The matrix of the last frame's programme.
    pub(crate) fn system(&self) -> &[f64] {
        &self.some_visible.as_ref().unwrap_or(&self.fit.all_visible).system
    }

    /// The right side of the last frame's programme.
    pub(crate) fn right(&self) -> &[f64] {
        &self.right
    }

    /// The free weights of the last frame, as they were solved.
    pub(crate) fn own_weights(&self) -> &[f64] {
        &self.weights
    }

    /// What is said of a frame whose free weights were found elsewhere; all N in `weights`.
    pub(crate) fn report_given(
        &mut self,
        d: &[f64],
        free: &[f64],
        outcome: Outcome,
        weights: &mut [f64],
    ) -> FrameReport {
        let (missing_markers, _) = self.take_in(d);
        self.weights.clear();
        self.weights.extend_from_slice(free);
        self.report(outcome.into(), missing_markers, weights)
    }
}
