//! Consecutive frames, each solved from the answer of the one before.

use crate::fit::Fit;
use crate::fit::problem::FitError;
use crate::fit::report::{FrameReport, FrameWarning, LARGEST_DISPLACEMENT, LARGEST_WEIGHT};
use crate::fit::setup::{Engine, FREE};
use crate::fit::visible_markers::VisibleMarkers;
use crate::gaussian_process::regression::{Regression, RegressionScratch};
use crate::linear_algebra::dense::{axpy, dot, mul, mul_transposed};
use crate::method::greedy::one_after_the_other;
use crate::newton::minimise::NewtonState;
use crate::newton::objective::{Matrices, Objective, Target, Term};
use crate::quadratic::box_qp::{BoxState, Outcome, worse};

/// Solves frames one after the other, each started from the one before.
#[derive(Debug, Clone)]
pub struct FrameSolver<'a> {
    pub(super) fit: &'a Fit,
    /// What depends on the markers seen, kept while the same ones are missing.
    pub(super) some_visible: Option<VisibleMarkers>,
    /// The free weights as they were solved: the next frame starts from them.
    pub(super) weights: Vec<f64>,
    /// The same times the gain.
    pub(super) amplified: Vec<f64>,
    pub(super) displacements: Vec<f64>,
    /// Bounds of a programme that holds weights at 0.
    pub(super) held: Vec<[f64; 2]>,
    pub(super) right: Vec<f64>,
    pub(super) scratch: Vec<f64>,
    pub(super) qp: BoxState,
    pub(super) newton: NewtonState,
    pub(super) learnt: RegressionScratch,
}

/// How a frame was solved.
pub(super) struct Answer {
    pub(super) outcome: Outcome,
    /// The thin shell's energy of a surface.
    energy: Option<f64>,
    /// Predictive standard deviation of a regression.
    deviation: Option<f64>,
    /// Whether the frame is like nothing that the regression has learnt from.
    is_far: bool,
    /// Whether the data norm had to be smoothed.
    smoothed: bool,
}

impl From<Outcome> for Answer {
    fn from(outcome: Outcome) -> Answer {
        Answer { outcome, energy: None, deviation: None, is_far: false, smoothed: false }
    }
}

impl<'a> FrameSolver<'a> {
    pub(crate) fn new(fit: &'a Fit) -> FrameSolver<'a> {
        FrameSolver {
            fit,
            some_visible: None,
            weights: Vec::new(),
            amplified: Vec::new(),
            displacements: Vec::new(),
            held: Vec::new(),
            right: Vec::new(),
            scratch: Vec::new(),
            qp: BoxState::default(),
            newton: NewtonState::default(),
            learnt: RegressionScratch::default(),
        }
    }

    /// Solve the next frame; `d` as of [`Fit::solve_frame`], the N weights in `weights`.
    ///
    /// # Errors
    /// [`FitError::Displacements`] unless `d` has 3P numbers.
    ///
    /// # Panics
    /// If `weights` does not have N numbers.
    pub fn solve(&mut self, d: &[f64], weights: &mut [f64]) -> Result<FrameReport, FitError> {
        if d.len() != 3 * self.fit.marker_count() {
            return Err(self.fit.wrong_size(d.len()));
        }
        Ok(self.solve_checked(d, weights))
    }

    /// Forget the last frame: the next one starts cold.
    pub fn reset(&mut self) {
        self.weights.clear();
        self.qp.reset();
        self.newton.reset();
    }

    pub(crate) fn solve_checked(&mut self, d: &[f64], weights: &mut [f64]) -> FrameReport {
        assert_eq!(weights.len(), self.fit.shape_count(), "a frame has N weights");
        let (missing_markers, _) = self.take_in(d);
        let answer = self.answer();
        self.report(answer, missing_markers, weights)
    }

    /// What is said of the frame that was taken in, whose free weights are in `self.weights`; all N in
    /// `weights`.
    pub(super) fn report(
        &mut self,
        answer: Answer,
        missing_markers: u32,
        weights: &mut [f64],
    ) -> FrameReport {
        let visible = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        let importance = visible.importance;
        weights.fill(0.0);
        // A search that ends nowhere shows the neutral face, and its frame is warned of.
        self.amplify();
        let somewhere = self.weights.iter().all(|c| c.is_finite());
        let converged = answer.outcome.converged && somewhere;
        if somewhere {
            for (&k, &c) in self.fit.problem.free.iter().zip(&self.amplified) {
                weights[k] = c;
            }
        }
        let misfit = self.misfit();
        let no_markers = !(importance > 0.0);
        let warning = if !converged {
            // The next frame is better off with a fresh start.
            self.reset();
            Some(FrameWarning::NotConverged)
        } else if self.is_beyond_sense() {
            self.reset();
            Some(FrameWarning::BeyondSense)
        } else if no_markers {
            Some(FrameWarning::NoMarkers)
        } else if answer.is_far {
            Some(FrameWarning::FarFromTraining)
        } else {
            answer.smoothed.then_some(FrameWarning::Smoothed)
        };
        FrameReport {
            residual: if no_markers { 0.0 } else { (misfit / importance).sqrt() },
            iterations: answer.outcome.iterations,
            kkt_error: answer.outcome.kkt_error,
            energy: answer.energy,
            deviation: answer.deviation,
            missing_markers,
            warning,
        }
    }

    /// Solve for the displacements that were taken in: the weights of the free shapes are then in
    /// `self.weights`.
    pub(super) fn answer(&mut self) -> Answer {
        let fit = self.fit;
        let problem = &fit.problem;
        let visible = self.some_visible.as_ref().unwrap_or(&fit.all_visible);
        let n = problem.free.len();
        if self.weights.len() != n {
            self.weights.clear();
            self.weights.resize(n, 0.0);
        }
        self.right.clear();
        self.right.resize(n, 0.0);
        let d = &self.displacements;
        match &problem.engine {
            Engine::Quadratic(quadratic) => self.solve_quadratic(quadratic).into(),
            Engine::Greedy { order, bounds } => {
                let (left, weights) = (&mut self.scratch, &mut self.weights);
                one_after_the_other(order, bounds, visible, d, left, weights).into()
            }
            Engine::Linked { bounds } => {
                // The displacements carry the root of the importance, the sums need all of it.
                if let Some(associated) = &problem.associated {
                    for (row, (sum, &d)) in associated.sums.chunks_exact(n).zip(d).enumerate() {
                        let root = problem.importance[row / 3].sqrt();
                        axpy(root * d, sum, &mut self.right);
                    }
                }
                self.qp.solve(&visible.system, &self.right, bounds, &mut self.weights).into()
            }
            Engine::Surface(surface) => {
                let (missing, importance) = (&visible.missing, &problem.importance);
                let weights = &mut self.weights;
                let (outcome, energy) =
                    surface.solve(&visible.system, missing, importance, d, weights);
                Answer { energy: Some(energy), ..outcome.into() }
            }
            Engine::Learnt { model, bounds } => self.predict(model, bounds),
            Engine::PseudoInverse => {
                mul(&visible.system, d, &mut self.weights);
                pseudo_inverse_outcome(visible, d, &self.weights, &mut self.scratch).into()
            }
            Engine::Smooth { objective, fallback_eps } => self.minimise(objective, *fallback_eps),
        }
    }

    /// Newton's method on smooth energies.
    fn minimise(&mut self, objective: &Objective, fallback_eps: f64) -> Answer {
        let problem = &self.fit.problem;
        let visible = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        let d = &self.displacements;
        let rank = visible.triangle.len() / problem.free.len();
        self.right.resize(rank, 0.0);
        mul(&visible.orthogonal, d, &mut self.right);
        self.scratch.resize(d.len(), 0.0);
        mul_transposed(&visible.orthogonal, &self.right, &mut self.scratch);
        for (r, d) in self.scratch.iter_mut().zip(d) {
            *r -= d;
        }
        let outside = dot(&self.scratch, &self.scratch);
        let (outcome, smoothed) = solve_smooth(
            &mut self.newton,
            objective,
            fallback_eps,
            Matrices { triangle: &visible.triangle, gram: &visible.gram, shell: &problem.shell },
            Target { inside: &self.right, outside },
            &mut self.weights,
        );
        Answer { smoothed, ..outcome.into() }
    }

    /// What the regression says of the displacements, put within the bounds.
    fn predict(&mut self, model: &Regression, bounds: &[[f64; 2]]) -> Answer {
        let problem = &self.fit.problem;
        let visible = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        // The nearest point of a box: nothing is left to improve.
        let outcome = Outcome { iterations: 1, kkt_error: 0.0, converged: true };
        self.scratch.resize(problem.shape_count, 0.0);
        let (d, scratch) = (&self.displacements, &mut self.scratch);
        let (deviation, is_far) =
            model.predict(d, &visible.missing, &visible.system, scratch, &mut self.learnt);
        for ((w, &k), [low, high]) in self.weights.iter_mut().zip(&problem.free).zip(bounds) {
            *w = scratch[k].max(*low).min(*high);
        }
        Answer { deviation: Some(deviation), is_far, ..outcome.into() }
    }

    /// The weights times the gain. A bound stops them, unless the solve itself went beyond it.
    fn amplify(&mut self) {
        self.amplified.clear();
        self.amplified.extend_from_slice(&self.weights);
        let gain = self.fit.problem.gain;
        if gain == 1.0 {
            return;
        }
        let bounds = self.fit.problem.engine.bounds();
        for (i, c) in self.amplified.iter_mut().enumerate() {
            let [low, high] = bounds.map_or(FREE, |bounds| bounds[i]);
            *c = (gain * *c).max(low.min(*c)).min(high.max(*c));
        }
    }

    /// Whether the weights are none of a face: [`LARGEST_WEIGHT`], [`LARGEST_DISPLACEMENT`].
    fn is_beyond_sense(&mut self) -> bool {
        let problem = &self.fit.problem;
        // A surface's weights are where its markers go; that of the pseudo-inverse are compared with the
        // others' because nothing bounds them.
        if matches!(problem.engine, Engine::Surface(_) | Engine::PseudoInverse) {
            return false;
        }
        let (mut largest, mut furthest) = (0.0_f64, 0.0);
        for (&c, &reach) in self.amplified.iter().zip(&problem.reach) {
            largest = largest.max(c.abs());
            furthest += c.abs() * reach;
        }
        if largest > LARGEST_WEIGHT {
            return true;
        }
        // The sum of all shapes is as far as any marker can be.
        if furthest <= LARGEST_DISPLACEMENT {
            return false;
        }
        let deltas = &self.fit.all_visible.deltas;
        self.scratch.resize(self.displacements.len(), 0.0);
        mul(deltas, &self.amplified, &mut self.scratch);
        self.scratch.chunks_exact(3).zip(&problem.importance).any(|(moved, &importance)| {
            dot(moved, moved) > LARGEST_DISPLACEMENT * LARGEST_DISPLACEMENT * importance
        })
    }

    /// The squared distance, each row by its importance, from where the weights put the markers to where
    /// they are seen.
    fn misfit(&mut self) -> f64 {
        let problem = &self.fit.problem;
        if matches!(problem.engine, Engine::Smooth { .. }) && problem.gain == 1.0 {
            return self.newton.misfit();
        }
        let visible = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        let d = &self.displacements;
        self.scratch.resize(d.len(), 0.0);
        mul(&visible.deltas, &self.amplified, &mut self.scratch);
        for (r, d) in self.scratch.iter_mut().zip(d) {
            *r -= d;
        }
        dot(&self.scratch, &self.scratch)
    }

    /// Weigh the rows, drop those of missing markers, and prepare what depends on them. Returns how
    /// many markers are missing, and whether they are other ones than before.
    pub(super) fn take_in(&mut self, d: &[f64]) -> (u32, bool) {
        let problem = &self.fit.problem;
        self.displacements.resize(d.len(), 0.0);
        let is_missing = |m: &[f64]| !m.iter().all(|x| x.is_finite());
        let mut missing = 0;
        for ((row, out), importance) in
            d.chunks_exact(3).zip(self.displacements.chunks_exact_mut(3)).zip(&problem.importance)
        {
            if is_missing(row) {
                missing += 1;
                out.fill(0.0);
            } else {
                let root = importance.sqrt();
                for (out, x) in out.iter_mut().zip(row) {
                    *out = root * x;
                }
            }
        }
        let current = self.some_visible.as_ref().unwrap_or(&self.fit.all_visible);
        let same =
            d.chunks_exact(3).zip(&current.missing).all(|(row, &gone)| is_missing(row) == gone);
        if !same {
            self.qp.forget_factor();
            self.newton.reset();
            self.some_visible = (missing > 0)
                .then(|| VisibleMarkers::new(problem, d.chunks_exact(3).map(is_missing).collect()));
        }
        (missing, !same)
    }
}

/// Newton, and once more with a smoothed data norm where the residual vanishes.
fn solve_smooth(
    newton: &mut NewtonState,
    objective: &Objective,
    fallback_eps: f64,
    m: Matrices<'_>,
    target: Target<'_>,
    c: &mut [f64],
) -> (Outcome, bool) {
    let outcome = newton.minimise(objective, m, target, c);
    let Term::Norm { weight, eps } = objective.data else { return (outcome, false) };
    // Below a ten-thousandth of the fallback's eps a norm is a corner to Newton.
    let corner = newton.misfit().sqrt() < 1e-4 * fallback_eps;
    if eps >= fallback_eps || (outcome.converged && !corner) {
        return (outcome, false);
    }
    let mut smoothed = objective.clone();
    smoothed.data = Term::Norm { weight, eps: fallback_eps };
    if !c.iter().all(|x| x.is_finite()) {
        c.fill(0.0);
    }
    (newton.minimise(&smoothed, m, target, c), true)
}

/// The normal equations' error in units of weight.
fn pseudo_inverse_outcome(
    visible: &VisibleMarkers,
    d: &[f64],
    c: &[f64],
    scratch: &mut Vec<f64>,
) -> Outcome {
    let n = c.len();
    scratch.resize(d.len() + n, 0.0);
    let (residual, gradient) = scratch.split_at_mut(d.len());
    mul(&visible.deltas, c, residual);
    for (r, d) in residual.iter_mut().zip(d) {
        *r -= d;
    }
    mul_transposed(&visible.deltas, residual, gradient);
    let kkt_error = (0..n).fold(0.0, |worst: f64, i| {
        let h = visible.gram[i * n + i];
        if h > 0.0 { worse(worst, (gradient[i] / h).abs()) } else { worst }
    });
    Outcome { iterations: 1, kkt_error, converged: kkt_error < 1e-6 }
}
