//! The dual problem of a support vector machine, solved by sequential minimal optimization.
//!
//! minimise 1/2 a'Qa + p'a over 0 <= a_t <= C_t, y'a = 0, with Q_ts = y_t y_s k(row of t, row of s)
//! (Chang and Lin, LIBSVM, ACM TIST 2011). Classification (C-SVC) has one variable per row and p = -1. Regression
//! (epsilon-SVR) has two variables per row: y = 1 with p = epsilon - target, and y = -1 with p = epsilon + target.
//! The working pair is selected by second-order information (Fan, Chen and Lin, JMLR 2005, WSS 2). There is no shrinking.

use std::collections::VecDeque;

/// The kernel matrix of a problem's rows, computed row by row.
pub struct KernelMatrix<F> {
    /// The kernel of each row with itself.
    pub diagonal: Vec<f64>,
    /// Writes the kernels of one row with every row.
    pub row: F,
}

/// The dual problem of a support vector machine.
pub struct SupportVectorDual<F> {
    kernels: KernelMatrix<F>,
    /// +1 or -1 for each variable; variable t belongs to row t modulo the number of rows.
    sign: Vec<f64>,
    /// Upper bound of each variable.
    bound: Vec<f64>,
    /// The linear term p.
    linear: Vec<f64>,
    tolerance: f64,
}

/// The optimum of a dual problem.
#[derive(Debug, Clone, PartialEq)]
pub struct DualOptimum {
    /// The coefficient of each row: the sum of y_t a_t over its variables.
    pub coefficients: Vec<f64>,
    /// Constant that is added to the sum of coefficients times kernels.
    pub bias: f64,
    /// 1/2 a'Qa + p'a.
    pub objective: f64,
    /// How far the optimality conditions are violated.
    pub violation: f64,
    /// Number of pairs that were changed.
    pub steps: usize,
    /// Whether the violation is below the tolerance; otherwise the solver stopped after 10,000,000 pairs,
    /// or 100 per variable if that is more.
    pub converged: bool,
}

/// Curvature below which a direction counts as flat (LIBSVM's TAU).
const FLAT: f64 = 1e-12;
/// Size of the cache of kernel rows, in numbers: 64 MiB.
const CACHED: usize = 8 << 20;

impl<F: Fn(usize, &mut [f64])> SupportVectorDual<F> {
    /// Classification into two classes (C-SVC). `sign` is +1 or -1 for each row, `bound` is the upper bound of each
    /// row's variable, `tolerance` is how far the optimality conditions may be violated.
    pub fn classification(
        kernels: KernelMatrix<F>,
        sign: Vec<f64>,
        bound: Vec<f64>,
        tolerance: f64,
    ) -> Self {
        let linear = vec![-1.0; sign.len()];
        Self { kernels, sign, bound, linear, tolerance }
    }

    /// Regression (epsilon-SVR) with the bound `c` of every coefficient and a tube of half width `epsilon` in which an
    /// error costs nothing.
    pub fn regression(
        kernels: KernelMatrix<F>,
        targets: &[f64],
        c: f64,
        epsilon: f64,
        tolerance: f64,
    ) -> Self {
        let n = targets.len();
        let above = targets.iter().map(|target| epsilon - target);
        let below = targets.iter().map(|target| epsilon + target);
        Self {
            kernels,
            sign: [vec![1.0; n], vec![-1.0; n]].concat(),
            bound: vec![c; 2 * n],
            linear: above.chain(below).collect(),
            tolerance,
        }
    }

    /// Solves the problem.
    pub fn solve(&self) -> DualOptimum {
        self.solve_with_cache(CACHED / self.kernels.diagonal.len().max(1))
    }

    /// Solves the problem with a cache of that many kernel rows, at least two.
    fn solve_with_cache(&self, rows: usize) -> DualOptimum {
        let variables = self.sign.len();
        let mut state = State {
            problem: self,
            alpha: vec![0.0; variables],
            gradient: self.linear.clone(),
            cache: KernelCache {
                matrix: &self.kernels,
                rows: vec![None; self.kernels.diagonal.len()],
                oldest: VecDeque::new(),
                most: rows.max(2),
            },
        };
        let most_steps = 10_000_000.max(100 * variables);
        for steps in 0..most_steps {
            let Some((i, j)) = state.working_pair() else { return state.optimum(steps, true) };
            state.change(i, j);
        }
        state.optimum(most_steps, false)
    }
}

/// Rows of the kernel matrix; a new row replaces the oldest.
struct KernelCache<'p, F> {
    matrix: &'p KernelMatrix<F>,
    rows: Vec<Option<Vec<f64>>>,
    oldest: VecDeque<usize>,
    most: usize,
}

impl<F: Fn(usize, &mut [f64])> KernelCache<'_, F> {
    fn ensure(&mut self, i: usize) {
        if self.rows[i].is_some() {
            return;
        }
        let recycled = (self.oldest.len() >= self.most).then(|| self.oldest.pop_front()).flatten();
        let mut row = recycled.and_then(|old| self.rows[old].take()).unwrap_or_default();
        row.clear();
        row.resize(self.rows.len(), 0.0);
        (self.matrix.row)(i, &mut row);
        self.rows[i] = Some(row);
        self.oldest.push_back(i);
    }

    /// A row that is among the last two that were ensured.
    fn row(&self, i: usize) -> &[f64] {
        self.rows[i].as_deref().unwrap_or(&[])
    }
}

struct State<'p, F> {
    problem: &'p SupportVectorDual<F>,
    alpha: Vec<f64>,
    /// Qa + p.
    gradient: Vec<f64>,
    cache: KernelCache<'p, F>,
}

impl<F: Fn(usize, &mut [f64])> State<'_, F> {
    /// The row of a variable.
    fn row_of(&self, variable: usize) -> usize {
        let rows = self.problem.kernels.diagonal.len();
        if variable < rows { variable } else { variable - rows }
    }

    /// Whether y_t a_t may still rise, and whether it may still fall.
    fn may(&self, t: usize) -> (bool, bool) {
        let below = self.alpha[t] < self.problem.bound[t];
        let above = self.alpha[t] > 0.0;
        if self.problem.sign[t] > 0.0 { (below, above) } else { (above, below) }
    }

    /// The variable that may rise whose -y gradient is highest, and that value.
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
        self.steepest().map_or(0.0, |(_, highest)| (highest - lowest).max(0.0))
    }

    /// The pair of variables whose change promises most; `None` at the optimum.
    fn working_pair(&mut self) -> Option<(usize, usize)> {
        let (i, highest) = self.steepest()?;
        let row_i = self.row_of(i);
        self.cache.ensure(row_i);
        let kernels = self.cache.row(row_i);
        let diagonal = &self.problem.kernels.diagonal;
        let (mut lowest, mut best) = (f64::INFINITY, None);
        let mut least = f64::INFINITY;
        for first in (0..self.alpha.len()).step_by(kernels.len()) {
            for (row, kernel) in kernels.iter().enumerate() {
                let t = first + row;
                if !self.may(t).1 {
                    continue;
                }
                let slope = -self.problem.sign[t] * self.gradient[t];
                lowest = lowest.min(slope);
                let gap = highest - slope;
                if gap > 0.0 {
                    let curvature = diagonal[row_i] + diagonal[row] - 2.0 * kernel;
                    let gain = -gap * gap / if curvature > 0.0 { curvature } else { FLAT };
                    if gain <= least {
                        (least, best) = (gain, Some(t));
                    }
                }
            }
        }
        if highest - lowest < self.problem.tolerance { None } else { best.map(|j| (i, j)) }
    }

    /// Moves y_i a_i up and y_j a_j down by the same amount, as far as it helps and the bounds allow.
    fn change(&mut self, i: usize, j: usize) {
        let (row_i, row_j) = (self.row_of(i), self.row_of(j));
        self.cache.ensure(row_j);
        self.cache.ensure(row_i);
        let SupportVectorDual { sign, bound, kernels, .. } = self.problem;
        let (kernels_i, kernels_j) = (self.cache.row(row_i), self.cache.row(row_j));
        let diagonal = &kernels.diagonal;
        let curvature = diagonal[row_i] + diagonal[row_j] - 2.0 * kernels_i[row_j];
        let gap = sign[j] * self.gradient[j] - sign[i] * self.gradient[i];
        // How far each may go in its direction.
        let room = |t: usize, up: bool| {
            if (sign[t] > 0.0) == up { bound[t] - self.alpha[t] } else { self.alpha[t] }
        };
        let free = gap / if curvature > 0.0 { curvature } else { FLAT };
        let (room_i, room_j) = (room(i, true), room(j, false));
        let step = free.min(room_i).min(room_j);
        for (t, direction, room) in [(i, 1.0, room_i), (j, -1.0, room_j)] {
            // A variable that reaches its bound gets exactly the bound's value, so that it counts as bounded.
            self.alpha[t] = if step < room {
                self.alpha[t] + sign[t] * direction * step
            } else if sign[t] * direction > 0.0 {
                bound[t]
            } else {
                0.0
            };
        }
        let rows = kernels_i.len();
        for (gradient, sign) in self.gradient.chunks_mut(rows).zip(sign.chunks(rows)) {
            let each = gradient.iter_mut().zip(sign).zip(kernels_i.iter().zip(kernels_j));
            for ((gradient, sign), (of_i, of_j)) in each {
                *gradient += sign * step * (of_i - of_j);
            }
        }
    }

    /// The bias is the mean over free variables; if there are none, the middle of what the bounds allow.
    fn bias(&self) -> f64 {
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
        match (free, lower.is_finite(), upper.is_finite()) {
            (1.., _, _) => sum / free as f64,
            (_, true, true) => (lower + upper) / 2.0,
            (_, true, false) => lower,
            (_, false, true) => upper,
            (_, false, false) => 0.0,
        }
    }

    fn optimum(&self, steps: usize, converged: bool) -> DualOptimum {
        let SupportVectorDual { sign, linear, kernels, .. } = self.problem;
        let terms = self.alpha.iter().zip(&self.gradient).zip(linear);
        let objective = terms.map(|((a, gradient), p)| a * (gradient + p)).sum::<f64>() / 2.0;
        let signed: Vec<f64> = self.alpha.iter().zip(sign).map(|(a, y)| a * y).collect();
        let (first, more) = signed.split_at(kernels.diagonal.len());
        let mut coefficients = first.to_vec();
        for (coefficient, more) in coefficients.iter_mut().zip(more) {
            *coefficient += more;
        }
        let (bias, violation) = (self.bias(), self.violation());
        DualOptimum { coefficients, bias, objective, violation, steps, converged }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    /// The kernel matrix of rows, by a function of two rows.
    fn matrix<const N: usize>(
        rows: &[[f64; N]],
        kernel: fn(&[f64; N], &[f64; N]) -> f64,
    ) -> KernelMatrix<impl Fn(usize, &mut [f64])> {
        let row = move |i: usize, out: &mut [f64]| {
            out.iter_mut().zip(rows).for_each(|(out, row)| *out = kernel(&rows[i], row));
        };
        KernelMatrix { diagonal: rows.iter().map(|row| kernel(row, row)).collect(), row }
    }

    fn product<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn gaussian<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
        (-0.8 * a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()).exp()
    }

    /// Rows and targets of a planted function with noise.
    fn planted(count: usize) -> (Vec<[f64; 2]>, Vec<f64>) {
        let mut random = Random::new(17);
        let rows: Vec<[f64; 2]> = (0..count).map(|_| [random.normal(), random.normal()]).collect();
        let noisy = |x: &[f64; 2]| 2.0 * x[0].sin() + x[1] + 0.3 * random.normal();
        let targets = rows.iter().map(noisy).collect();
        (rows, targets)
    }

    #[test]
    fn a_planted_margin_is_found() {
        // The lines x = 1 and x = -1: weight (1, 0), bias 0, a = 1/4 each, objective -1/2.
        let rows = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [5.0, 0.0]];
        let sign = vec![1.0, 1.0, -1.0, -1.0, 1.0];
        let problem =
            SupportVectorDual::classification(matrix(&rows, product), sign, vec![10.0; 5], 1e-9);
        let found = problem.solve();
        let weight =
            |c: usize| -> f64 { rows.iter().zip(&found.coefficients).map(|(r, a)| a * r[c]).sum() };
        assert!((weight(0) - 1.0).abs() < 1e-8 && weight(1).abs() < 1e-8);
        assert!(found.bias.abs() < 1e-8 && (found.objective + 0.5).abs() < 1e-8);
        assert!(found.converged && found.violation < 1e-9);
    }

    #[test]
    fn classification_meets_the_optimality_conditions_with_a_small_cache_and_a_large_one() {
        let mut random = Random::new(5);
        let rows: Vec<[f64; 2]> = (0..80).map(|_| [random.normal(), random.normal()]).collect();
        let sign: Vec<f64> = rows.iter().map(|r| (r[0] + 0.5 * random.normal()).signum()).collect();
        let (matrix, bound) = (matrix(&rows, product), vec![2.0; 80]);
        let problem = SupportVectorDual::classification(matrix, sign.clone(), bound, 1e-9);
        let found = problem.solve();
        assert_eq!(found, problem.solve_with_cache(2));
        assert!(found.coefficients.iter().sum::<f64>().abs() < 1e-9);
        for (t, row) in rows.iter().enumerate() {
            let products = rows.iter().zip(&found.coefficients);
            let decision = products.map(|(r, a)| a * product(r, row)).sum::<f64>() + found.bias;
            let (margin, alpha) = (sign[t] * decision, sign[t] * found.coefficients[t]);
            assert!((0.0..=2.0).contains(&alpha));
            assert!(alpha > 0.0 || margin > 1.0 - 1e-6, "{t}: {margin} {alpha}");
            assert!(alpha < 2.0 || margin < 1.0 + 1e-6, "{t}: {margin} {alpha}");
        }
    }

    #[test]
    fn regression_finds_the_flattest_line_in_the_tube() {
        // Targets 2x at 0, 1/2 and 1 with a tube of 0.1: slope 2 - 0.2, through the middle of the outer points.
        let rows = [[0.0], [0.5], [1.0]];
        let matrix = matrix(&rows, product);
        let found =
            SupportVectorDual::regression(matrix, &[0.0, 1.0, 2.0], 1e3, 0.1, 1e-10).solve();
        for (found, expected) in found.coefficients.iter().zip([-1.8, 0.0, 1.8]) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
        // 1/2 1.8 * 1.8 - 1.8 * 2 + 0.1 * 3.6.
        assert!((found.bias - 0.1).abs() < 1e-9 && (found.objective + 1.62).abs() < 1e-9);
    }

    #[test]
    fn regression_has_no_duality_gap_and_meets_the_optimality_conditions() {
        let (rows, targets) = planted(60);
        for (c, epsilon) in [(0.05, 0.1), (3.0, 0.2), (100.0, 0.3), (2.0, 0.0)] {
            let problem =
                SupportVectorDual::regression(matrix(&rows, gaussian), &targets, c, epsilon, 1e-9);
            let found = problem.solve();
            assert!(found.converged, "{c} {epsilon}");
            assert_eq!(found, problem.solve_with_cache(2));
            assert!(found.coefficients.iter().sum::<f64>().abs() < 1e-9 * c.max(1.0));
            // The primal: 1/2 |w|^2 + C times the errors beyond the tube.
            let (mut norm, mut loss) = (0.0, 0.0);
            for ((row, target), own) in rows.iter().zip(&targets).zip(&found.coefficients) {
                let products = rows.iter().zip(&found.coefficients);
                let sum = products.map(|(other, a)| a * gaussian(other, row)).sum::<f64>();
                let error = target - sum - found.bias;
                norm += own * sum;
                loss += (error.abs() - epsilon).max(0.0);
                assert!(own.abs() <= c);
                let free = *own != 0.0 && own.abs() < c;
                assert!(!free || (error.abs() - epsilon).abs() < 1e-8, "{error} {own}");
                assert!(*own == 0.0 || error * own.signum() > epsilon - 1e-8, "{error} {own}");
                assert!(own.abs() == c || error.abs() < epsilon + 1e-8, "{error} {own}");
            }
            let gap = 0.5 * norm + c * loss + found.objective;
            let size = found.objective.abs().max(1.0);
            assert!(gap.abs() < 1e-7 * size, "C {c}, epsilon {epsilon}: gap {gap}");
        }
    }

    #[test]
    fn equal_rows_and_an_empty_tube_have_an_answer() {
        // The kernel's curvature is 0 between equal rows: the median is the answer.
        let rows = [[1.0], [1.0], [1.0]];
        let problem = SupportVectorDual::regression(
            matrix(&rows, gaussian),
            &[1.0, 2.0, 9.0],
            1.0,
            0.0,
            1e-9,
        );
        let found = problem.solve();
        assert!(found.converged, "{found:?}");
        assert!((found.bias - 2.0).abs() < 1e-9, "{found:?}");
        assert!((found.objective + 8.0).abs() < 1e-9, "{found:?}");
    }
}
