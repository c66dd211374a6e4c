//! One interface to every method: set up once, then displacements in, weights and a report out.

pub(crate) mod frame;
pub(crate) mod problem;
mod quadratic_frame;
pub(crate) mod report;
pub(crate) mod setup;
pub(crate) mod visible_markers;
pub(crate) mod window;

use crate::energy::operators::Operators;
use crate::fit::frame::FrameSolver;
use crate::fit::problem::{FitError, Problem};
use crate::fit::report::{FrameReport, FrameSolution, TakeSolution};
use crate::fit::setup::Engine;
use crate::fit::visible_markers::VisibleMarkers;
use crate::fit::window::solve_windows;
use crate::linear_algebra::dense::dot;
use crate::parameters::table::MethodSpec;

/// Frames that are solved one after the other, each from the last one's answer; the next chunk
/// starts cold. A constant, so that results do not depend on how many threads share a take.
pub const CHUNK_FRAMES: usize = 128;

/// A method set up for an avatar: solves frames.
#[derive(Debug, Clone)]
pub struct Fit {
    pub(crate) problem: Problem,
    /// What depends on which markers are seen, for all of them.
    pub(crate) all_visible: VisibleMarkers,
    /// The second method of a blend, and its share.
    second: Option<Box<(Fit, f64)>>,
}

impl Fit {
    /// Set up a method.
    ///
    /// # Errors
    /// [`FitError`] for a parameter out of range, a name that the avatar or the marker map does not
    /// have, operators built with other options, or a method that does not solve.
    pub fn new(operators: &Operators, spec: &MethodSpec) -> Result<Fit, FitError> {
        let problem = Problem::new(operators, spec)?;
        let all_visible = VisibleMarkers::new(&problem, vec![false; problem.marker_count]);
        let share = spec.blend.unwrap_or_default();
        let second = spec.second().map(|second| Fit::new(operators, &second)).transpose()?;
        let second = second.map(|second| Box::new((second, share)));
        Ok(Fit { problem, all_visible, second })
    }

    /// N, the weights of a frame.
    pub fn shape_count(&self) -> usize {
        self.problem.shape_count
    }

    /// P: a frame of displacements has 3P numbers.
    pub fn marker_count(&self) -> usize {
        self.problem.marker_count
    }

    /// Whether the shapes depend on each other at the markers, so that of the weights that fit equally
    /// well the least are chosen.
    pub fn chooses_least_norm(&self) -> bool {
        self.all_visible.least_norm
    }

    /// A solver of consecutive frames, of a blend by its first method alone. A method that solves windows sees one
    /// frame at a time here, without second differences.
    pub fn frames(&self) -> FrameSolver<'_> {
        FrameSolver::new(self)
    }

    /// Solve one frame from a cold start. `d`: 3P marker displacements in metres, NaN for a marker
    /// that is not seen.
    ///
    /// # Errors
    /// [`FitError::Displacements`] unless `d` has 3P numbers.
    pub fn solve_frame(&self, d: &[f64]) -> Result<FrameSolution, FitError> {
        let mut weights = vec![0.0; self.shape_count()];
        let mut report = self.frames().solve(d, &mut weights)?;
        if let Some((fit, share)) = self.second.as_deref() {
            let second = fit.solve_frame(d)?;
            mix(&mut weights, &second.weights, *share);
            report = report.of_blend(&second.report, self.residual(d, &weights));
        }
        Ok(FrameSolution { weights, report })
    }

    /// Solve a take: `d` is frames x 3P, metres, NaN for markers that are not seen.
    ///
    /// The frames of each chunk of [`CHUNK_FRAMES`] start from one another, the first one cold: the
    /// answer has the same bits however the chunks are shared out. With the feature `parallel` they
    /// are solved on all cores. Methods that hold to the last frame solve the whole take in order, and
    /// those with second differences window by window ([`crate::WINDOW_FRAMES`], [`crate::LOOK_AHEAD`]). Of
    /// a blend both methods solve the take, and their weights are mixed frame by frame.
    ///
    /// # Errors
    /// [`FitError::Displacements`] unless `d` is whole frames.
    pub fn solve_take(&self, d: &[f64]) -> Result<TakeSolution, FitError> {
        let mut solution = self.solve_alone(d)?;
        if let Some((fit, share)) = self.second.as_deref() {
            let second = fit.solve_alone(d)?;
            mix(&mut solution.weights, &second.weights, *share);
            let (width, n) = (3 * self.marker_count(), self.shape_count());
            let frames = d.chunks_exact(width).zip(solution.weights.chunks_exact(n));
            let reports = solution.reports.iter_mut().zip(&second.reports);
            for ((d, weights), (report, second)) in frames.zip(reports) {
                *report = report.of_blend(second, self.residual(d, weights));
            }
        }
        Ok(solution)
    }

    /// A take by the first method alone.
    fn solve_alone(&self, d: &[f64]) -> Result<TakeSolution, FitError> {
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
        if let Engine::Quadratic(quadratic) = &self.problem.engine
            && quadratic.roughness > 0.0
        {
            solve_windows(self, quadratic, d, &mut weights, &mut reports);
            return Ok(TakeSolution { weights, reports });
        }
        if self.follows_last_frame() {
            one(((d, &mut weights), &mut reports));
            return Ok(TakeSolution { weights, reports });
        }
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

    /// Root mean square distance of the markers of a frame (by importance, those that are seen) to where
    /// `weights`, N of them, put them, metres; 0 where none is seen.
    ///
    /// # Panics
    /// If `d` does not have 3P numbers, or `weights` N.
    pub fn residual(&self, d: &[f64], weights: &[f64]) -> f64 {
        let problem = &self.problem;
        assert_eq!((d.len(), weights.len()), (3 * problem.marker_count, problem.shape_count));
        let free: Vec<f64> = problem.free.iter().map(|&k| weights[k]).collect();
        let rows = self.all_visible.deltas.chunks_exact(3 * free.len());
        let (mut squares, mut total) = (0.0, 0.0);
        for ((d, rows), &importance) in d.chunks_exact(3).zip(rows).zip(&problem.importance) {
            if !d.iter().all(|x| x.is_finite()) {
                continue;
            }
            total += importance;
            for (d, row) in d.iter().zip(rows.chunks_exact(free.len())) {
                // The rows carry the root of the importance.
                let off = dot(row, &free) - importance.sqrt() * d;
                squares += off * off;
            }
        }
        if total > 0.0 { (squares / total).sqrt() } else { 0.0 }
    }

    /// Whether the answer of a frame depends on that of the one before.
    fn follows_last_frame(&self) -> bool {
        matches!(&self.problem.engine, Engine::Quadratic(quadratic) if quadratic.last_frame > 0.0)
    }

    pub(crate) fn wrong_size(&self, found: usize) -> FitError {
        FitError::Displacements { found, markers: self.marker_count() }
    }
}

/// Puts a share of other weights into the place of as much of these.
fn mix(weights: &mut [f64], other: &[f64], share: f64) {
    for (weight, other) in weights.iter_mut().zip(other) {
        *weight = (1.0 - share) * *weight + share * other;
    }
}
