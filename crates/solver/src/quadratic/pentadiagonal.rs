//! The course of one weight over the frames of a window, in a box: minimise
//! sum over frames t of diagonal_t x_t^2 / 2 - right_t x_t + (w / 2) (x_(t-1) - 2 x_t + x_(t+1))^2.
//!
//! Its matrix has five diagonals. Which frames are free is guessed and exchanged as in
//! [`super::box_qp`]; the free ones are solved for by the factor L D L^T of the whole matrix, in which the
//! others stand as rows of the identity, so that the band stays as narrow as it is.

use crate::quadratic::box_qp::{Exchange, Place};

/// A pivot below this part of its own diagonal entry is rounding: nothing holds the frame.
const VANISHED_PIVOT: f64 = 1e-13;

/// Memory of the solves.
#[derive(Debug, Clone, Default)]
pub(crate) struct CourseSolver {
    /// Entries (t, t), (t, t + 1) and (t, t + 2) of the matrix.
    matrix: Vec<[f64; 3]>,
    /// 1 / D_t, L_(t+1)t, L_(t+2)t.
    factor: Vec<[f64; 3]>,
    gradient: Vec<f64>,
}

/// Entries (t, t), (t, t + 1) and (t, t + 2) of the sum of squared second differences of `frames`
/// numbers, halved: rows of K, where x^T K x is that sum.
pub(crate) fn second_differences(t: usize, frames: usize) -> [f64; 3] {
    // Whether there is a second difference around a frame.
    let around = |t: usize| f64::from(u8::from(1 <= t && t + 1 < frames));
    let before = if t == 0 { 0.0 } else { around(t - 1) };
    let (here, after) = (around(t), around(t + 1));
    [before + 4.0 * here + after, -2.0 * (here + after), after]
}

impl CourseSolver {
    /// Solve for `x`, from the guess in `places` (which is left at what was found). Whether every
    /// condition is met.
    pub(crate) fn solve(
        &mut self,
        diagonal: &[f64],
        roughness: f64,
        right: &[f64],
        bounds: &[[f64; 2]],
        places: &mut [Place],
        x: &mut [f64],
    ) -> bool {
        let frames = x.len();
        self.matrix.clear();
        self.matrix.extend(diagonal.iter().enumerate().map(|(t, own)| {
            let [zero, one, two] = second_differences(t, frames);
            [own + roughness * zero, roughness * one, roughness * two]
        }));
        let steepest = self.matrix.iter().fold(0.0_f64, |s, row| s.max(row[0]));
        let mut exchange = Exchange::default();
        let mut met = false;
        for _ in 0..20 + 10 * frames {
            self.minimise_free(right, bounds, places, x);
            if exchange.violations(places, x, &self.gradient, bounds, steepest) == 0 {
                met = true;
                break;
            }
            exchange.make(places, x, &self.gradient, bounds, steepest);
        }
        for (x, [low, high]) in x.iter_mut().zip(bounds) {
            *x = x.clamp(*low, *high);
        }
        met && x.iter().all(|x| x.is_finite())
    }

    /// The minimiser over the free frames with the others at their bounds, and its gradient.
    fn minimise_free(
        &mut self,
        right: &[f64],
        bounds: &[[f64; 2]],
        places: &[Place],
        x: &mut [f64],
    ) {
        let frames = x.len();
        for (t, x) in x.iter_mut().enumerate() {
            *x = match places[t] {
                Place::Free => 0.0,
                Place::Lower => bounds[t][0],
                Place::Upper => bounds[t][1],
            };
        }
        // What the others leave for the free ones: b - A x, in the place of the gradient.
        self.multiply(x);
        for (residual, b) in self.gradient.iter_mut().zip(right) {
            *residual = b - *residual;
        }
        let free = |t: usize| t < frames && places[t] == Place::Free;
        self.factor.clear();
        for t in 0..frames {
            if !free(t) {
                self.factor.push([0.0; 3]);
                continue;
            }
            let mut row = self.matrix[t];
            let own = row[0];
            for back in [2, 1] {
                if t >= back {
                    let [inverse, first, second] = self.factor[t - back];
                    if inverse > 0.0 {
                        // L_t and what it takes of the row: D L_t L_(t + k).
                        let below = if back == 1 { [first, second] } else { [second, 0.0] };
                        let scaled = below[0] / inverse;
                        row[0] -= scaled * below[0];
                        row[1] -= scaled * below[1];
                    }
                }
            }
            // A frame that nothing holds stays at 0.
            let inverse = if row[0] > VANISHED_PIVOT * own { 1.0 / row[0] } else { 0.0 };
            let next = if free(t + 1) { row[1] * inverse } else { 0.0 };
            let second = if free(t + 2) { row[2] * inverse } else { 0.0 };
            self.factor.push([inverse, next, second]);
        }
        self.substitute(places, x);
        self.multiply(x);
        for (gradient, b) in self.gradient.iter_mut().zip(right) {
            *gradient -= b;
        }
    }

    /// Puts (L D L^T)^-1 of the free entries of `gradient` into `x`.
    fn substitute(&mut self, places: &[Place], x: &mut [f64]) {
        let frames = x.len();
        let y = &mut self.gradient;
        for t in 0..frames {
            let [_, first, second] = self.factor[t];
            for (ahead, l) in [(1, first), (2, second)] {
                if t + ahead < frames {
                    y[t + ahead] -= l * y[t];
                }
            }
        }
        for t in (0..frames).rev() {
            if places[t] != Place::Free {
                continue;
            }
            let [inverse, first, second] = self.factor[t];
            let mut value = inverse * y[t];
            for (ahead, l) in [(1, first), (2, second)] {
                if t + ahead < frames && places[t + ahead] == Place::Free {
                    value -= l * x[t + ahead];
                }
            }
            x[t] = value;
        }
    }

    /// A x, into `gradient`.
    fn multiply(&mut self, x: &[f64]) {
        let frames = x.len();
        self.gradient.clear();
        self.gradient.resize(frames, 0.0);
        for (t, [zero, one, two]) in self.matrix.iter().enumerate() {
            self.gradient[t] += zero * x[t];
            for (ahead, a) in [(1, one), (2, two)] {
                if t + ahead < frames {
                    self.gradient[t] += a * x[t + ahead];
                    self.gradient[t + ahead] += a * x[t];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_algebra::dense::numbers;
    use crate::quadratic::box_qp::BoxState;

    /// A, dense.
    fn dense(diagonal: &[f64], roughness: f64) -> Vec<f64> {
        let n = diagonal.len();
        let mut q = vec![0.0; n * n];
        for t in 0..n {
            q[t * n + t] += diagonal[t];
        }
        for t in 1..n.saturating_sub(1) {
            for (i, a) in [(t - 1, 1.0), (t, -2.0), (t + 1, 1.0)] {
                for (j, b) in [(t - 1, 1.0), (t, -2.0), (t + 1, 1.0)] {
                    q[i * n + j] += roughness * a * b;
                }
            }
        }
        q
    }

    #[test]
    fn a_course_is_that_of_the_dense_programme() {
        let mut bounded = 0;
        for (case, &frames) in [1, 2, 3, 4, 7, 30, 90].iter().enumerate() {
            for roughness in [0.0, 0.3, 40.0] {
                let seed = case as f64 + roughness;
                let diagonal: Vec<f64> =
                    numbers(frames, seed).iter().map(|x| 0.1 + x.abs()).collect();
                let right: Vec<f64> =
                    numbers(frames, seed + 0.5).iter().map(|x| 1.6 * x - 0.1).collect();
                // Two frames are held.
                let bounds: Vec<[f64; 2]> =
                    (0..frames).map(|t| if t < 2 { [0.4; 2] } else { [0.0, 1.0] }).collect();
                let mut expected = vec![0.0; frames];
                let q = dense(&diagonal, roughness);
                let outcome = BoxState::default().solve(&q, &right, &bounds, &mut expected);
                assert!(outcome.converged);
                let mut x = vec![0.0; frames];
                for start in [Place::Lower, Place::Free] {
                    let mut places = vec![start; frames];
                    assert!(CourseSolver::default().solve(
                        &diagonal,
                        roughness,
                        &right,
                        &bounds,
                        &mut places,
                        &mut x
                    ));
                    for (x, expected) in x.iter().zip(&expected) {
                        assert!((x - expected).abs() < 1e-11, "{frames} {roughness}: {x}");
                    }
                }
                bounded += x.iter().filter(|x| **x == 0.0 || **x == 1.0).count();
            }
        }
        assert!(bounded > 50, "{bounded} at a bound");
    }

    #[test]
    fn frames_without_data_lie_on_the_line_through_the_others() {
        let diagonal = [1.0, 0.0, 0.0, 0.0, 1.0];
        let right = [0.2, 0.0, 0.0, 0.0, 0.6];
        let (mut x, mut places) = ([0.0; 5], [Place::Free; 5]);
        let solver = &mut CourseSolver::default();
        assert!(solver.solve(&diagonal, 2.0, &right, &[[0.0, 1.0]; 5], &mut places, &mut x));
        for (x, expected) in x.iter().zip([0.2, 0.3, 0.4, 0.5, 0.6]) {
            assert!((x - expected).abs() < 1e-12, "{x} of {expected}");
        }
        // Nothing holds a course without data: it stays at 0.
        let (mut x, mut places) = ([0.0; 5], [Place::Free; 5]);
        assert!(solver.solve(&[0.0; 5], 2.0, &[0.0; 5], &[[0.0, 1.0]; 5], &mut places, &mut x));
        assert_eq!(x, [0.0; 5]);
    }
}
