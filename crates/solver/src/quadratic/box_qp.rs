//! Strictly convex quadratic programmes in a box: minimise c^T Q c / 2 - b^T c, lo <= c <= hi.
//!
//! Block principal pivoting (Judice and Pires 1994) with Murty's single exchange as its safeguard:
//! guess which weights are free, solve for them exactly, exchange everything that violates its
//! condition, until nothing does. Warm-started from the last frame's guess it takes 1-3 solves; the
//! factor of the free part is kept while the guess stays.

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::dot;

/// Where a weight is guessed to be at the optimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    Free,
    Lower,
    Upper,
}

/// The guess of the last solve, its factor, and scratch.
#[derive(Debug, Clone, Default)]
pub(crate) struct BoxState {
    places: Vec<Place>,
    factor: Cholesky,
    /// The free weights that `factor` is of; none = no factor.
    factored: Option<Vec<usize>>,
    free: Vec<usize>,
    gradient: Vec<f64>,
    right: Vec<f64>,
}

/// How a solve went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) iterations: u32,
    /// The largest step by which one weight alone could still improve, see [`kkt_error`].
    pub(crate) kkt_error: f64,
    pub(crate) converged: bool,
}

/// A weight this far outside its bounds, or a gradient of this part of the largest diagonal of Q
/// on the wrong side, is rounding and no violation.
const TINY: f64 = 1e-14;

/// Blocks that bring no progress before single exchanges begin.
const PATIENCE: u32 = 3;

impl BoxState {
    /// Forget the last frame: every weight at its bound nearest 0.
    pub(crate) fn reset(&mut self) {
        self.places.clear();
    }

    /// Forget the factor, because Q changed.
    pub(crate) fn forget_factor(&mut self) {
        self.factored = None;
    }

    /// Solve; the answer in `c`.
    pub(crate) fn solve(
        &mut self,
        q: &[f64],
        b: &[f64],
        bounds: &[[f64; 2]],
        c: &mut [f64],
    ) -> Outcome {
        let n = c.len();
        if self.places.len() != n {
            self.places.clear();
            self.places.extend(
                bounds.iter().map(
                    |&[lo, _]| {
                        if lo.is_finite() { Place::Lower } else { Place::Free }
                    },
                ),
            );
        }
        self.gradient.resize(n, 0.0);
        let steepest = (0..n).fold(0.0_f64, |s, i| s.max(q[i * n + i]));
        let mut exchange = Exchange::default();
        let limit = 20 + 10 * n as u32;
        let mut iterations = 0;
        loop {
            iterations += 1;
            self.minimise_free(q, b, bounds, c);
            let places = &mut self.places;
            let violations = exchange.violations(places, c, &self.gradient, bounds, steepest);
            if violations == 0 || iterations == limit {
                for i in 0..n {
                    c[i] = c[i].clamp(bounds[i][0], bounds[i][1]);
                }
                let kkt_error = kkt_error(q, &self.gradient, c, bounds);
                // A value that is not a number violates nothing.
                let finite = c.iter().chain(&self.gradient).all(|x| x.is_finite());
                return Outcome { iterations, kkt_error, converged: violations == 0 && finite };
            }
            exchange.make(places, c, &self.gradient, bounds, steepest);
        }
    }

    /// The minimiser over the free weights with the others at their bounds, and its gradient.
    fn minimise_free(&mut self, q: &[f64], b: &[f64], bounds: &[[f64; 2]], c: &mut [f64]) {
        let n = c.len();
        self.free.clear();
        for i in 0..n {
            match self.places[i] {
                Place::Free => {
                    self.free.push(i);
                    c[i] = 0.0;
                }
                Place::Lower => c[i] = bounds[i][0],
                Place::Upper => c[i] = bounds[i][1],
            }
        }
        if self.factored.as_ref() != Some(&self.free) {
            self.factor.reset(self.free.len());
            for (at, &i) in self.free.iter().enumerate() {
                for (entry, &j) in self.factor.row_mut(at).iter_mut().zip(&self.free[at..]) {
                    *entry = q[i * n + j];
                }
            }
            self.factor.factor();
            self.factored.get_or_insert_default().clone_from(&self.free);
        }
        self.right.clear();
        for &i in &self.free {
            self.right.push(b[i] - dot(&q[i * n..(i + 1) * n], c));
        }
        self.factor.solve(&mut self.right);
        for (&i, &x) in self.free.iter().zip(&self.right) {
            c[i] = x;
        }
        for i in 0..n {
            self.gradient[i] = dot(&q[i * n..(i + 1) * n], c) - b[i];
        }
    }
}

/// Which guesses are exchanged: all that are wrong while that brings progress, then one at a time.
#[derive(Debug)]
pub(crate) struct Exchange {
    fewest: usize,
    patience: u32,
    violations: usize,
    last: usize,
}

impl Default for Exchange {
    fn default() -> Exchange {
        Exchange { fewest: usize::MAX, patience: PATIENCE, violations: 0, last: 0 }
    }
}

impl Exchange {
    /// How many guesses are wrong.
    pub(crate) fn violations(
        &mut self,
        places: &[Place],
        c: &[f64],
        gradient: &[f64],
        bounds: &[[f64; 2]],
        steepest: f64,
    ) -> usize {
        self.violations = 0;
        for i in 0..c.len() {
            if violated(places[i], c[i], gradient[i], bounds[i], steepest) {
                self.violations += 1;
                self.last = i;
            }
        }
        self.violations
    }

    /// Guess anew, from what [`Exchange::violations`] found.
    pub(crate) fn make(
        &mut self,
        places: &mut [Place],
        c: &[f64],
        gradient: &[f64],
        bounds: &[[f64; 2]],
        steepest: f64,
    ) {
        let block = if self.violations < self.fewest {
            self.fewest = self.violations;
            self.patience = PATIENCE;
            true
        } else if self.patience > 0 {
            self.patience -= 1;
            true
        } else {
            false
        };
        for i in 0..c.len() {
            let (x, g) = (c[i], gradient[i]);
            if (block || i == self.last) && violated(places[i], x, g, bounds[i], steepest) {
                places[i] = match places[i] {
                    Place::Free if x < bounds[i][0] => Place::Lower,
                    Place::Free => Place::Upper,
                    _ => Place::Free,
                };
            }
        }
    }
}

fn violated(place: Place, c: f64, gradient: f64, [lo, hi]: [f64; 2], steepest: f64) -> bool {
    match place {
        Place::Free => c < lo - TINY || c > hi + TINY,
        _ if lo == hi => false,
        Place::Lower => gradient < -TINY * steepest,
        Place::Upper => gradient > TINY * steepest,
    }
}

/// The KKT error in units of weight: for each weight the step |g_i| / Q_ii that would minimise along
/// it, as far as its bounds let it go; the largest.
pub(crate) fn kkt_error(q: &[f64], gradient: &[f64], c: &[f64], bounds: &[[f64; 2]]) -> f64 {
    let n = c.len();
    (0..n).fold(0.0, |worst: f64, i| {
        if gradient[i] == 0.0 {
            return worst;
        }
        let goal = (c[i] - gradient[i] / q[i * n + i]).clamp(bounds[i][0], bounds[i][1]);
        worse(worst, (goal - c[i]).abs())
    })
}

/// The larger of two errors; a value that is not a number counts as infinitely wrong.
pub(crate) fn worse(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error) }
}
