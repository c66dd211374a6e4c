//! One interface to every method: set up once, then displacements in, weights and a report out.

use crate::box_qp::{BoxState, Outcome, worse};
use crate::dense::{axpy, dot, mul, mul_transposed};
use crate::method_spec::MethodSpec;
use crate::newton::NewtonState;
use crate::objective::{Matrices, Objective, Target, Term};
use crate::operators::Operators;
use crate::problem::{Engine, FitError, Problem};
use crate::regression::RegressionScratch;
use crate::report::{FrameReport, FrameSolution, FrameWarning, TakeSolution};
use crate::seen::Seen;

/// Frames that are solved one after the other, each from the last one's answer; the next chunk
/// starts cold. A constant, so that results do not depend on how many threads share a take.
pub const CHUNK_FRAMES: usize = 128;

/// A method set up for an avatar: solves frames.
#[derive(Debug, Clone)]
pub struct Fit {
    problem: Problem,
    /// What depends on which markers are seen, for all of them.
    all_seen: Seen,
}

/// Solves frames one after the other, each started from the one before.
#[derive(Debug, Clone)]
pub struct FrameSolver<'a> {
    fit: &'a Fit,
    /// What depends on the markers seen, kept while the same ones are missing.
    some_seen: Option<Seen>,
    weights: Vec<f64>,
    displacements: Vec<f64>,
    right: Vec<f64>,
    scratch: Vec<f64>,
    qp: BoxState,
    newton: NewtonState,
    learnt: RegressionScratch,
}

impl Fit {
    /// Set up a method.
    ///
    /// # Errors
    /// [`FitError`] for a parameter out of range, a name that the avatar or the marker map does not
    /// have, operators built with other options, or a method that does not solve.
    pub fn new(operators: &Operators, spec: &MethodSpec) -> Result<Fit, FitError> {
        let problem = Problem::new(operators, spec)?;
        let all_seen = Seen::new(&problem, vec![false; problem.marker_count]);
        Ok(Fit { problem, all_seen })
    }

    /// N, the weights of a frame.
    pub fn shape_count(&self) -> usize {
        self.problem.shape_count
    }

    /// P: a frame of displacements has 3P numbers.
    pub fn marker_count(&self) -> usize {
        self.problem.marker_count
    }

    /// A solver of consecutive frames.
    pub fn frames(&self) -> FrameSolver<'_> {
        FrameSolver {
            fit: self,
            some_seen: None,
            weights: Vec::new(),
            displacements: Vec::new(),
            right: Vec::new(),
            scratch: Vec::new(),
            qp: BoxState::default(),
            newton: NewtonState::default(),
            learnt: RegressionScratch::default(),
        }
    }

    /// Solve one frame from a cold start. `d`: 3P marker displacements in metres, NaN for a marker
    /// that is not seen.
    ///
    /// # Errors
    /// [`FitError::Displacements`] unless `d` has 3P numbers.
    pub fn solve_frame(&self, d: &[f64]) -> Result<FrameSolution, FitError> {
        let mut weights = vec![0.0; self.shape_count()];
        let report = self.frames().solve(d, &mut weights)?;
        Ok(FrameSolution { weights, report })
    }

    /// Solve a take: `d` is frames x 3P, metres, NaN for markers that are not seen.
    ///
    /// The frames of each chunk of [`CHUNK_FRAMES`] start from one another, the first one cold: the
    /// answer has the same bits however the chunks are shared out. With the feature `parallel` they
    /// are solved on all cores.
    ///
    /// # Errors
    /// [`FitError::Displacements`] unless `d` is whole frames.
    pub fn solve_take(&self, d: &[f64]) -> Result<TakeSolution, FitError> {
        let width = 3 * self.marker_count();
        if width == 0 || !d.len().is_multiple_of(width) {
            return Err(self.wrong_size(d.len()));
        }
        let frames = d.len() / width;
        let n = self.shape_count();
        let mut weights = vec![0.0; frames * n];
        let mut reports = vec![FrameReport::default(); frames];
        let one = |((d, weights), reports): ((&[f64], &mut [f64]), &mut [FrameReport])| {
            let mut solver = self.frames();
            for ((d, weights), report) in
                d.chunks_exact(width).zip(weights.chunks_exact_mut(n)).zip(reports)
            {
                *report = solver.solve_checked(d, weights);
            }
        };
        #[cfg(feature = "parallel")]
        {
            use rayon::prelude::*;
            d.par_chunks(CHUNK_FRAMES * width)
                .zip(weights.par_chunks_mut(CHUNK_FRAMES * n))
                .zip(reports.par_chunks_mut(CHUNK_FRAMES))
                .for_each(one);
        }
        #[cfg(not(feature = "parallel"))]
        d.chunks(CHUNK_FRAMES * width)
            .zip(weights.chunks_mut(CHUNK_FRAMES * n))
            .zip(reports.chunks_mut(CHUNK_FRAMES))
            .for_each(one);
        Ok(TakeSolution { weights, reports })
    }

    fn wrong_size(&self, found: usize) -> FitError {
        FitError::Displacements { found, markers: self.marker_count() }
    }
}

impl FrameSolver<'_> {
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

    fn solve_checked(&mut self, d: &[f64], weights: &mut [f64]) -> FrameReport {
        assert_eq!(weights.len(), self.fit.shape_count(), "a frame has N weights");
        let missing_markers = self.take_in(d);
        let problem = &self.fit.problem;
        let seen = self.some_seen.as_ref().unwrap_or(&self.fit.all_seen);
        let n = problem.free.len();
        if self.weights.len() != n {
            self.weights.clear();
            self.weights.resize(n, 0.0);
        }
        self.right.clear();
        self.right.resize(n, 0.0);
        let d = &self.displacements;
        let (mut smoothed, mut far) = (false, false);
        let (mut energy, mut deviation) = (None, None);
        let outcome = match &problem.engine {
            Engine::Quadratic { data_weight, bounds, .. } => {
                mul_transposed(&seen.deltas, d, &mut self.right);
                for x in &mut self.right {
                    *x *= data_weight;
                }
                self.qp.solve(&seen.system, &self.right, bounds, &mut self.weights)
            }
            Engine::Linked { bounds } => {
                // The displacements carry the root of the importance, the sums need all of it.
                self.right.fill(0.0);
                if let Some(linked) = &problem.linked {
                    for (row, (sum, &d)) in linked.sums.chunks_exact(n).zip(d).enumerate() {
                        let root = problem.importance[row / 3].sqrt();
                        axpy(root * d, sum, &mut self.right);
                    }
                }
                self.qp.solve(&seen.system, &self.right, bounds, &mut self.weights)
            }
            Engine::Surface(surface) => {
                let (outcome, found) = surface.solve(
                    &seen.system,
                    &seen.missing,
                    &problem.importance,
                    d,
                    &mut self.weights,
                );
                energy = Some(found);
                outcome
            }
            Engine::Learnt { model, bounds } => {
                self.scratch.resize(problem.shape_count, 0.0);
                let (found, is_far) = model.predict(
                    d,
                    &seen.missing,
                    &seen.system,
                    &mut self.scratch,
                    &mut self.learnt,
                );
                (deviation, far) = (Some(found), is_far);
                for ((w, &k), [low, high]) in self.weights.iter_mut().zip(&problem.free).zip(bounds)
                {
                    *w = self.scratch[k].max(*low).min(*high);
                }
                // The nearest point of a box: nothing is left to improve.
                Outcome { iterations: 1, kkt_error: 0.0, converged: true }
            }
            Engine::PseudoInverse => {
                mul(&seen.system, d, &mut self.weights);
                pseudo_inverse_outcome(seen, d, &self.weights, &mut self.scratch)
            }
            Engine::Smooth { objective, fallback_eps } => {
                let rank = seen.triangle.len() / n;
                self.right.resize(rank, 0.0);
                mul(&seen.orthogonal, d, &mut self.right);
                self.scratch.resize(d.len(), 0.0);
                mul_transposed(&seen.orthogonal, &self.right, &mut self.scratch);
                for (r, d) in self.scratch.iter_mut().zip(d) {
                    *r -= d;
                }
                let target =
                    Target { inside: &self.right, outside: dot(&self.scratch, &self.scratch) };
                let (outcome, fell_back) = solve_smooth(
                    &mut self.newton,
                    objective,
                    *fallback_eps,
                    Matrices { triangle: &seen.triangle, gram: &seen.gram, shell: &problem.shell },
                    target,
                    &mut self.weights,
                );
                smoothed = fell_back;
                outcome
            }
        };
        weights.fill(0.0);
        // A search that ends nowhere shows the neutral face, and its frame is warned of.
        let somewhere = self.weights.iter().all(|c| c.is_finite());
        let converged = outcome.converged && somewhere;
        if somewhere {
            for (&k, &c) in problem.free.iter().zip(&self.weights) {
                weights[k] = c;
            }
        }
        let misfit = match &problem.engine {
            Engine::Smooth { .. } => self.newton.misfit(),
            _ => {
                self.scratch.resize(d.len(), 0.0);
                mul(&seen.deltas, &self.weights, &mut self.scratch);
                for (r, d) in self.scratch.iter_mut().zip(d) {
                    *r -= d;
                }
                dot(&self.scratch, &self.scratch)
            }
        };
        let importance = seen.importance;
        let no_markers = !(importance > 0.0);
        let warning = if !converged {
            // The next frame is better off with a fresh start.
            self.reset();
            Some(FrameWarning::NotConverged)
        } else if no_markers {
            Some(FrameWarning::NoMarkers)
        } else if far {
            Some(FrameWarning::FarFromTraining)
        } else {
            smoothed.then_some(FrameWarning::Smoothed)
        };
        FrameReport {
            residual: if no_markers { 0.0 } else { (misfit / importance).sqrt() },
            iterations: outcome.iterations,
            kkt_error: outcome.kkt_error,
            energy,
            deviation,
            missing_markers,
            warning,
        }
    }

    /// Weigh the rows, drop those of missing markers, and prepare what depends on them. Returns how
    /// many markers are missing.
    fn take_in(&mut self, d: &[f64]) -> u32 {
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
        let current = self.some_seen.as_ref().unwrap_or(&self.fit.all_seen);
        let same =
            d.chunks_exact(3).zip(&current.missing).all(|(row, &gone)| is_missing(row) == gone);
        if !same {
            self.qp.forget_factor();
            self.newton.reset();
            self.some_seen = (missing > 0)
                .then(|| Seen::new(problem, d.chunks_exact(3).map(is_missing).collect()));
        }
        missing
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
fn pseudo_inverse_outcome(seen: &Seen, d: &[f64], c: &[f64], scratch: &mut Vec<f64>) -> Outcome {
    let n = c.len();
    scratch.resize(d.len() + n, 0.0);
    let (residual, gradient) = scratch.split_at_mut(d.len());
    mul(&seen.deltas, c, residual);
    for (r, d) in residual.iter_mut().zip(d) {
        *r -= d;
    }
    mul_transposed(&seen.deltas, residual, gradient);
    let kkt_error = (0..n).fold(0.0, |worst: f64, i| {
        let h = seen.gram[i * n + i];
        if h > 0.0 { worse(worst, (gradient[i] / h).abs()) } else { worst }
    });
    Outcome { iterations: 1, kkt_error, converged: kkt_error < 1e-6 }
}
