//! The two-class support vector machine: C-SVC by sequential minimal optimisation.
//!
//! minimise 1/2 a'Qa - sum a over 0 <= a_i <= C_i, y'a = 0, with Q_ij = y_i y_j k(x_i, x_j)
//! (Chang and Lin, LIBSVM, ACM TIST 2011, eq. 2). The pair that is changed is theirs too: second
//! order information (Fan, Chen and Lin, JMLR 2005, WSS 2). Without shrinking.

use crate::{AnnotateError, Kernel};

/// A two-class problem.
pub(crate) struct TwoClasses<'a> {
    /// The rows, one after the other.
    pub rows: &'a [f64],
    /// Columns of a row.
    pub width: usize,
    /// +1 or -1 of each.
    pub sign: Vec<f64>,
    /// Upper bound of each multiplier.
    pub bound: Vec<f64>,
    /// How alike rows are.
    pub kernel: Kernel,
    /// How far the optimality conditions may be violated.
    pub tolerance: f64,
}

/// The optimum of a two-class problem.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Optimum {
    /// y_i a_i of each row.
    pub coefficients: Vec<f64>,
    /// What is added to the sum of coefficients times kernels.
    pub bias: f64,
    /// 1/2 a'Qa - sum a.
    pub objective: f64,
}

/// Curvature below which a direction counts as flat (LIBSVM's TAU).
const FLAT: f64 = 1e-12;
/// Kernel rows kept, numbers: 64 MiB.
const KEPT: usize = 8 << 20;

/// Rows of the kernel matrix, the oldest given up for a new one.
struct KernelRows<'p, 'a> {
    problem: &'p TwoClasses<'a>,
    rows: Vec<Option<Vec<f64>>>,
    oldest: std::collections::VecDeque<usize>,
    most: usize,
}

impl KernelRows<'_, '_> {
    fn ensure(&mut self, i: usize) {
        if self.rows[i].is_some() {
            return;
        }
        let recycled = (self.oldest.len() >= self.most).then(|| self.oldest.pop_front()).flatten();
        let mut row = recycled.and_then(|old| self.rows[old].take()).unwrap_or_default();
        row.resize(self.problem.sign.len(), 0.0);
        self.problem.kernel.of_all(self.problem.rows, self.problem.row(i), &mut row);
        self.rows[i] = Some(row);
        self.oldest.push_back(i);
    }

    /// A row that was ensured among the last two.
    fn row(&self, i: usize) -> &[f64] {
        self.rows[i].as_deref().unwrap_or(&[])
    }
}

struct State<'p, 'a> {
    problem: &'p TwoClasses<'a>,
    alpha: Vec<f64>,
    /// Qa - 1.
    gradient: Vec<f64>,
    diagonal: Vec<f64>,
    kernels: KernelRows<'p, 'a>,
}

impl TwoClasses<'_> {
    fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.width..(i + 1) * self.width]
    }

    /// The kernel of a row with itself.
    fn own_kernel(&self, i: usize) -> f64 {
        let mut own = [0.0];
        self.kernel.of_all(self.row(i), self.row(i), &mut own);
        own[0]
    }

    /// Solve.
    ///
    /// # Errors
    /// [`AnnotateError::NotConverged`] after 10,000,000 pairs, or 100 a row if that is more.
    pub(crate) fn solve(&self) -> Result<Optimum, AnnotateError> {
        self.solve_keeping(KEPT / self.sign.len().max(1))
    }

    /// Solve, keeping that many rows of the kernel matrix, two at least.
    fn solve_keeping(&self, kept: usize) -> Result<Optimum, AnnotateError> {
        let n = self.sign.len();
        let most = kept.max(2);
        let mut state = State {
            problem: self,
            alpha: vec![0.0; n],
            gradient: vec![-1.0; n],
            diagonal: (0..n).map(|i| self.own_kernel(i)).collect(),
            kernels: KernelRows {
                problem: self,
                rows: vec![None; n],
                oldest: std::collections::VecDeque::new(),
                most,
            },
        };
        let steps = 10_000_000.max(100 * n);
        for _ in 0..steps {
            let Some((i, j)) = state.pair() else { return Ok(state.optimum()) };
            state.change(i, j);
        }
        Err(AnnotateError::NotConverged { method: "svm", steps, residual: state.violation() })
    }
}

impl State<'_, '_> {
    /// Whether y a may still rise, and whether it may still fall.
    fn may(&self, t: usize) -> (bool, bool) {
        let below = self.alpha[t] < self.problem.bound[t];
        let above = self.alpha[t] > 0.0;
        if self.problem.sign[t] > 0.0 { (below, above) } else { (above, below) }
    }

    /// The row that may rise whose -y gradient is highest, and that value.
    fn steepest(&self) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        for t in 0..self.alpha.len() {
            let slope = -self.problem.sign[t] * self.gradient[t];
            if self.may(t).0 && best.is_none_or(|(_, highest)| slope >= highest) {
                best = Some((t, slope));
            }
        }
        best
    }

    /// How far the optimality conditions are violated.
    fn violation(&self) -> f64 {
        let lowest = (0..self.alpha.len())
            .filter(|&t| self.may(t).1)
            .map(|t| -self.problem.sign[t] * self.gradient[t])
            .fold(f64::INFINITY, f64::min);
        self.steepest().map_or(0.0, |(_, highest)| highest - lowest)
    }

    /// The pair whose change promises most; none at the optimum.
    fn pair(&mut self) -> Option<(usize, usize)> {
        let (i, highest) = self.steepest()?;
        self.kernels.ensure(i);
        let row = self.kernels.row(i);
        let (mut lowest, mut best) = (f64::INFINITY, None);
        let mut least = f64::INFINITY;
        for (t, kernel) in row.iter().enumerate() {
            if !self.may(t).1 {
                continue;
            }
            let slope = -self.problem.sign[t] * self.gradient[t];
            lowest = lowest.min(slope);
            let gap = highest - slope;
            if gap > 0.0 {
                let curvature = self.diagonal[i] + self.diagonal[t] - 2.0 * kernel;
                let gain = -gap * gap / if curvature > 0.0 { curvature } else { FLAT };
                if gain <= least {
                    (least, best) = (gain, Some(t));
                }
            }
        }
        if highest - lowest < self.problem.tolerance { None } else { best.map(|j| (i, j)) }
    }

    /// Move y_i a_i up and y_j a_j down by the same, as far as it helps and the bounds allow.
    fn change(&mut self, i: usize, j: usize) {
        self.kernels.ensure(j);
        if self.kernels.rows[i].is_none() {
            self.kernels.ensure(i);
        }
        let TwoClasses { sign, bound, .. } = self.problem;
        let (row_i, row_j) = (self.kernels.row(i), self.kernels.row(j));
        let curvature = self.diagonal[i] + self.diagonal[j] - 2.0 * row_i[j];
        let gap = sign[j] * self.gradient[j] - sign[i] * self.gradient[i];
        // How far each may go in its direction.
        let room = |t: usize, up: bool| {
            if (sign[t] > 0.0) == up { bound[t] - self.alpha[t] } else { self.alpha[t] }
        };
        let free = gap / if curvature > 0.0 { curvature } else { FLAT };
        let (room_i, room_j) = (room(i, true), room(j, false));
        let step = free.min(room_i).min(room_j);
        for (t, direction, room) in [(i, 1.0, room_i), (j, -1.0, room_j)] {
            // At a bound exactly on it, so that it is known to be there.
            self.alpha[t] = if step < room {
                self.alpha[t] + sign[t] * direction * step
            } else if sign[t] * direction > 0.0 {
                bound[t]
            } else {
                0.0
            };
        }
        for (t, gradient) in self.gradient.iter_mut().enumerate() {
            *gradient += sign[t] * step * (row_i[t] - row_j[t]);
        }
    }

    /// The bias is the mean over free rows, else the middle of what the bounds allow.
    fn optimum(&self) -> Optimum {
        let (mut upper, mut lower) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut sum, mut free) = (0.0, 0usize);
        for t in 0..self.alpha.len() {
            let slope = -self.problem.sign[t] * self.gradient[t];
            match self.may(t) {
                (true, true) => {
                    sum += slope;
                    free += 1;
                }
                (true, false) => lower = lower.max(slope),
                (false, true) => upper = upper.min(slope),
                (false, false) => {}
            }
        }
        let bias = match (free, lower.is_finite(), upper.is_finite()) {
            (1.., _, _) => sum / free as f64,
            (_, true, true) => (lower + upper) / 2.0,
            (_, true, false) => lower,
            (_, false, true) => upper,
            (_, false, false) => 0.0,
        };
        let products = self.alpha.iter().zip(&self.gradient).map(|(a, g)| a * (g - 1.0));
        Optimum {
            coefficients: self.alpha.iter().zip(&self.problem.sign).map(|(a, y)| a * y).collect(),
            bias,
            objective: products.sum::<f64>() / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn problem<'a>(rows: &'a [[f64; 2]], sign: &[f64], bound: f64) -> TwoClasses<'a> {
        TwoClasses {
            rows: rows.as_flattened(),
            width: 2,
            sign: sign.to_vec(),
            bound: vec![bound; rows.len()],
            kernel: Kernel::Linear,
            tolerance: 1e-9,
        }
    }

    #[test]
    fn a_planted_margin_is_found() {
        // The lines x = 1 and x = -1: weight (1, 0), bias 0, a = 1/4 each, objective -1/2.
        let rows = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [5.0, 0.0]];
        let found = problem(&rows, &[1.0, 1.0, -1.0, -1.0, 1.0], 10.0).solve().unwrap();
        let weight =
            |c: usize| -> f64 { rows.iter().zip(&found.coefficients).map(|(r, a)| a * r[c]).sum() };
        assert!((weight(0) - 1.0).abs() < 1e-8 && weight(1).abs() < 1e-8);
        assert!(found.bias.abs() < 1e-8 && (found.objective + 0.5).abs() < 1e-8);
    }

    #[test]
    fn the_optimality_conditions_hold_with_few_kernel_rows_as_with_all() {
        let mut random = Random::new(5);
        let rows: Vec<[f64; 2]> = (0..80).map(|_| [random.normal(), random.normal()]).collect();
        let sign: Vec<f64> = rows.iter().map(|r| (r[0] + 0.5 * random.normal()).signum()).collect();
        let problem = problem(&rows, &sign, 2.0);
        let found = problem.solve().unwrap();
        assert_eq!(found, problem.solve_keeping(2).unwrap());
        assert!(found.coefficients.iter().sum::<f64>().abs() < 1e-9);
        for (t, row) in rows.iter().enumerate() {
            let products = rows.iter().zip(&found.coefficients);
            let decision: f64 =
                products.map(|(r, a)| a * (r[0] * row[0] + r[1] * row[1])).sum::<f64>()
                    + found.bias;
            let (margin, alpha) = (sign[t] * decision, sign[t] * found.coefficients[t]);
            assert!((0.0..=2.0).contains(&alpha));
            assert!(alpha > 0.0 || margin > 1.0 - 1e-6, "{t}: {margin} {alpha}");
            assert!(alpha < 2.0 || margin < 1.0 + 1e-6, "{t}: {margin} {alpha}");
        }
    }
}
