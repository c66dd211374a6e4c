//! Windows of frames whose weights are solved together (`smooth-sparse`).
//!
//! Block coordinate descent: the course of each shape over the window is put where it is best while the
//! other shapes stay (a pentadiagonal programme in a box), until no weight moves. It begins at the frames'
//! own answers without second differences. The objective is convex, and strictly so along each shape that a
//! marker sees, so that what ends the descent is the minimum; each frame reports its own KKT error.
//!
//! **Continuity.** A take of up to [`WINDOW_FRAMES`] + [`LOOK_AHEAD`] frames is one window. A longer one is
//! cut: each window is solved with [`LOOK_AHEAD`] more frames, which are solved again with the next one, and
//! with the last two frames before it held as they are, so that no second difference of the take is left
//! out at a seam. What is kept differs from the whole take's minimum only by what lies further ahead.

use std::ops::Range;

use crate::fit::Fit;
use crate::fit::frame::FrameSolver;
use crate::fit::report::FrameReport;
use crate::fit::setup::Quadratic;
use crate::linear_algebra::dense::dot;
use crate::quadratic::box_qp::{Outcome, Place, worse};
use crate::quadratic::pentadiagonal::{CourseSolver, second_differences};

/// Frames of a window that are kept.
pub const WINDOW_FRAMES: usize = 256;
/// Frames after them that are solved with them.
pub const LOOK_AHEAD: usize = 64;

/// A sweep that moves no weight further ends the descent.
const STEP_TOLERANCE: f64 = 1e-13;
/// The largest KKT error, in units of weight, of a frame that is solved.
const KKT_TOLERANCE: f64 = 1e-10;
/// Banks of 53 shapes need some tens of sweeps; shapes that nearly depend on each other thousands.
const MOST_SWEEPS: u32 = 20_000;

/// The frames that are solved together, those that are held before them among them.
struct Window {
    /// n, the free shapes.
    n: usize,
    /// Frames that are held.
    held: usize,
    /// The matrices of the frames' own programmes, n x n, one for each set of visible markers in turn.
    systems: Vec<Vec<f64>>,
    /// Which of them each frame has.
    system_of: Vec<usize>,
    /// frames x n.
    right: Vec<f64>,
    /// frames x n.
    weights: Vec<f64>,
    /// Frames whose displacements make no finite sums: they count for nothing.
    absurd: Vec<bool>,
}

/// Solves a take window by window; `d` is frames x 3P, `weights` frames x N.
pub(crate) fn solve_windows(
    fit: &Fit,
    quadratic: &Quadratic,
    d: &[f64],
    weights: &mut [f64],
    reports: &mut [FrameReport],
) {
    let (width, n_all, n) = (3 * fit.marker_count(), fit.shape_count(), fit.problem.free.len());
    let mut solver = fit.frames();
    let mut solved: Vec<f64> = Vec::with_capacity(reports.len() * n);
    while solved.len() < reports.len() * n {
        let start = solved.len() / n;
        let left = reports.len() - start;
        let kept = if left <= WINDOW_FRAMES + LOOK_AHEAD { left } else { WINDOW_FRAMES };
        let frames = start..(start + kept + LOOK_AHEAD).min(reports.len());
        let before = &solved[start.saturating_sub(2) * n..];
        let mut window = Window::new(&mut solver, before, n);
        for frame in frames {
            window.take_in(&mut solver, &d[frame * width..(frame + 1) * width]);
        }
        let sweeps = window.descend(quadratic);
        for frame in start..start + kept {
            let at = window.held + frame - start;
            let kkt_error = window.kkt_error(quadratic, at);
            let converged = !window.absurd[at] && kkt_error <= KKT_TOLERANCE;
            let own = &window.weights[at * n..(at + 1) * n];
            reports[frame] = solver.report_given(
                &d[frame * width..(frame + 1) * width],
                own,
                Outcome { iterations: sweeps, kkt_error, converged },
                &mut weights[frame * n_all..(frame + 1) * n_all],
            );
            solved.extend_from_slice(own);
        }
    }
}

impl Window {
    /// A window after the frames `before`, of which there are two at most.
    fn new(solver: &mut FrameSolver<'_>, before: &[f64], n: usize) -> Window {
        solver.reset();
        let held = before.len() / n;
        Window {
            n,
            held,
            systems: vec![vec![0.0; n * n]],
            system_of: vec![0; held],
            right: vec![0.0; before.len()],
            weights: before.to_vec(),
            absurd: vec![false; held],
        }
    }

    /// One more frame.
    fn take_in(&mut self, solver: &mut FrameSolver<'_>, d: &[f64]) {
        let (outcome, changed) = solver.solve_alone(d);
        if changed || self.systems.len() == 1 {
            self.systems.push(solver.system().to_vec());
        }
        let absurd = !outcome.converged || solver.right().iter().any(|x| !x.is_finite());
        self.absurd.push(absurd);
        if absurd {
            self.system_of.push(0);
            self.right.resize(self.right.len() + self.n, 0.0);
            self.weights.resize(self.weights.len() + self.n, 0.0);
            solver.reset();
        } else {
            self.system_of.push(self.systems.len() - 1);
            self.right.extend_from_slice(solver.right());
            self.weights.extend_from_slice(solver.own_weights());
        }
    }

    fn frames(&self) -> Range<usize> {
        0..self.absurd.len()
    }

    /// Row k of a frame's own matrix.
    fn row(&self, frame: usize, k: usize) -> &[f64] {
        &self.systems[self.system_of[frame]][k * self.n..(k + 1) * self.n]
    }

    /// Goes from shape to shape until no weight moves; the sweeps.
    fn descend(&mut self, quadratic: &Quadratic) -> u32 {
        let (n, frames) = (self.n, self.frames().len());
        let mut solver = CourseSolver::default();
        let (mut diagonal, mut right) = (vec![0.0; frames], vec![0.0; frames]);
        let (mut course, mut bounds) = (vec![0.0; frames], vec![[0.0; 2]; frames]);
        let mut places = vec![Place::Free; frames * n];
        for sweep in 1..=MOST_SWEEPS {
            let mut furthest = 0.0;
            for k in 0..n {
                for t in 0..frames {
                    let (row, x) = (self.row(t, k), &self.weights[t * n..(t + 1) * n]);
                    course[t] = x[k];
                    diagonal[t] = row[k];
                    right[t] = self.right[t * n + k] - (dot(row, x) - row[k] * x[k]);
                    bounds[t] = if t < self.held { [x[k]; 2] } else { quadratic.bounds[k] };
                }
                let places = &mut places[k * frames..(k + 1) * frames];
                places[..self.held].fill(Place::Lower);
                // What does not converge shows in the frames' KKT errors.
                let roughness = 2.0 * quadratic.roughness;
                solver.solve(&diagonal, roughness, &right, &bounds, places, &mut course);
                for (t, &x) in course.iter().enumerate() {
                    let old = &mut self.weights[t * n + k];
                    furthest = worse(furthest, (x - *old).abs());
                    *old = x;
                }
            }
            if !(furthest > STEP_TOLERANCE && furthest.is_finite()) {
                return sweep;
            }
        }
        MOST_SWEEPS
    }

    /// How far a single weight of a frame could still move to improve the objective.
    fn kkt_error(&self, quadratic: &Quadratic, t: usize) -> f64 {
        let (n, frames) = (self.n, self.frames().len());
        if self.absurd[t] {
            return f64::INFINITY;
        }
        let roughness = 2.0 * quadratic.roughness;
        let x = |t: usize, k: usize| self.weights[t * n + k];
        (0..n).fold(0.0, |worst, k| {
            let [own, next, second] = second_differences(t, frames);
            let mut rough = own * x(t, k);
            for (ahead, entry) in [(1, next), (2, second)] {
                if t + ahead < frames {
                    rough += entry * x(t + ahead, k);
                }
                if t >= ahead {
                    rough += second_differences(t - ahead, frames)[ahead] * x(t - ahead, k);
                }
            }
            let row = self.row(t, k);
            let gradient = dot(row, &self.weights[t * n..(t + 1) * n]) - self.right[t * n + k]
                + roughness * rough;
            let curvature = row[k] + roughness * own;
            if gradient == 0.0 || curvature == 0.0 {
                return worst;
            }
            let [low, high] = quadratic.bounds[k];
            let goal = (x(t, k) - gradient / curvature).clamp(low, high);
            worse(worst, (goal - x(t, k)).abs())
        })
    }
}
