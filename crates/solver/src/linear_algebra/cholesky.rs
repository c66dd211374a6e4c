//! Symmetric systems: Cholesky's factor, four rows at a time, dependent variables taken out.

use crate::linear_algebra::dense::{dot4, widest};

/// U of A = U^T U, upper triangle; keeps its memory between uses.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cholesky {
    n: usize,
    /// The upper triangle holds A before, U after [`Cholesky::factor`]. Rows are `stride` apart, so
    /// that blocks of four begin at multiples of four; what is left of the diagonal means nothing.
    u: Vec<f64>,
    stride: usize,
    /// 1 / U_kk, or 0 where the pivot vanished.
    inverse_diagonal: Vec<f64>,
}

/// A pivot below this part of its own diagonal entry is rounding: the column depends on those
/// before it. 1e-13 is some 500 times the unit round-off, the growth of 50 subtractions with room.
const VANISHED_PIVOT: f64 = 1e-13;

impl Cholesky {
    /// Room for an n x n matrix; fill its upper triangle with [`Cholesky::row_mut`].
    pub(crate) fn reset(&mut self, n: usize) {
        if n != self.n {
            self.n = n;
            self.stride = n.next_multiple_of(4);
            // Zeros right of the last column, and nothing that could be a NaN anywhere.
            self.u.clear();
            self.u.resize(self.stride * self.stride, 0.0);
            self.inverse_diagonal.resize(n, 0.0);
        }
    }

    /// Entries i.. of row i.
    pub(crate) fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.u[i * self.stride + i..i * self.stride + self.n]
    }

    /// Factor in place. A variable that depends on those before it is taken out: its row of U and
    /// its solution are 0. Returns how many were.
    pub(crate) fn factor(&mut self) -> usize {
        factor_upper(&mut self.u, &mut self.inverse_diagonal, self.stride)
    }

    /// The smallest part of a variable that those before it leave, as a share of its size: near 0 where
    /// it nearly depends on them, 0 where it was taken out. `diagonal` is that of A.
    pub(crate) fn least_share(&self, diagonal: impl Iterator<Item = f64>) -> f64 {
        let pivots = self.inverse_diagonal.iter().zip(diagonal);
        pivots.fold(1.0, |least: f64, (&inverse, own)| {
            let share = if inverse > 0.0 { 1.0 / (inverse * own.sqrt()) } else { 0.0 };
            least.min(share)
        })
    }

    /// ln det A, of the variables that were not taken out.
    pub(crate) fn log_determinant(&self) -> f64 {
        let kept = self.inverse_diagonal.iter().filter(|x| **x > 0.0);
        kept.fold(0.0, |sum, x| sum - 2.0 * libm::log(*x))
    }

    /// b := A^-1 b.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        solve_upper(&self.u, &self.inverse_diagonal, self.stride, b);
    }
}

widest! {
    /// U of A = U^T U in place, four rows at a time: the rows below are loaded once for four of
    /// the subtractions that each of their numbers needs, made in the same order as one by one.
    fn factor_upper(u: &mut [f64], inverse_diagonal: &mut [f64], stride: usize) -> usize {
        let n = inverse_diagonal.len();
        let mut vanished = 0;
        for k in 0..n {
            inverse_diagonal[k] = VANISHED_PIVOT * u[k * stride + k];
        }
        let mut start = 0;
        while start < n {
            let end = (start + 4).min(n);
            let (head, tail) = u.split_at_mut((start + 4) * stride);
            let panel = &mut head[start * stride..];
            for k in start..end {
                let (above, below) = panel.split_at_mut((k + 1 - start) * stride);
                let row = &mut above[(k - start) * stride..];
                let pivot = row[k];
                if pivot > inverse_diagonal[k] && pivot > 0.0 {
                    let root = pivot.sqrt();
                    let inverse = 1.0 / root;
                    for x in &mut row[start..] {
                        *x *= inverse;
                    }
                    row[k] = root;
                    inverse_diagonal[k] = inverse;
                    for i in k + 1..end {
                        let factor = row[i];
                        let target = &mut below[(i - k - 1) * stride + start..(i - k) * stride];
                        for (t, x) in target.iter_mut().zip(&row[start..]) {
                            *t -= factor * x;
                        }
                    }
                } else {
                    row[k..].fill(0.0);
                    inverse_diagonal[k] = 0.0;
                    vanished += 1;
                }
            }
            // Two rows at a time, which share what they load of the panel.
            let mut i = start + 4;
            while i < n {
                let from = i / 4 * 4;
                let width = stride - from;
                let (above, below) = tail[(i - start - 4) * stride..].split_at_mut(stride);
                let target = &mut above[from..];
                let r0 = &panel[from..][..width];
                let r1 = &panel[stride + from..][..width];
                let r2 = &panel[2 * stride + from..][..width];
                let r3 = &panel[3 * stride + from..][..width];
                let f = [r0[i - from], r1[i - from], r2[i - from], r3[i - from]];
                if i + 1 < n {
                    let next = &mut below[from..stride];
                    let at = i + 1 - from;
                    let g = [r0[at], r1[at], r2[at], r3[at]];
                    for j in 0..width {
                        target[j] = (((target[j] - f[0] * r0[j]) - f[1] * r1[j]) - f[2] * r2[j])
                            - f[3] * r3[j];
                        next[j] = (((next[j] - g[0] * r0[j]) - g[1] * r1[j]) - g[2] * r2[j])
                            - g[3] * r3[j];
                    }
                } else {
                    for j in 0..width {
                        target[j] = (((target[j] - f[0] * r0[j]) - f[1] * r1[j]) - f[2] * r2[j])
                            - f[3] * r3[j];
                    }
                }
                i += 2;
            }
            start = end;
        }
        vanished
    }
}

widest! {
    /// b := (U^T U)^-1 b, four rows at a time.
    fn solve_upper(u: &[f64], inverse_diagonal: &[f64], stride: usize, b: &mut [f64]) {
        let n = inverse_diagonal.len();
        let b = &mut b[..n];
        let mut start = 0;
        while start < n {
            let end = (start + 4).min(n);
            for k in start..end {
                b[k] *= inverse_diagonal[k];
                for i in k + 1..end {
                    b[i] -= u[k * stride + i] * b[k];
                }
            }
            if end < n {
                let y = [b[start], b[start + 1], b[start + 2], b[start + 3]];
                let rest = &mut b[end..];
                let width = rest.len();
                let row = |k: usize| &u[(start + k) * stride + end..][..width];
                let (r0, r1, r2, r3) = (row(0), row(1), row(2), row(3));
                for j in 0..width {
                    rest[j] = (((rest[j] - y[0] * r0[j]) - y[1] * r1[j]) - y[2] * r2[j])
                        - y[3] * r3[j];
                }
            }
            start = end;
        }
        let mut end = n;
        while end > 0 {
            let start = (end - 1) / 4 * 4;
            if end < n {
                let row = |k: usize| &u[(start + k) * stride + end..];
                let sums = dot4([row(0), row(1), row(2), row(3)], &b[end..n]);
                for k in 0..4 {
                    b[start + k] -= sums[k];
                }
            }
            for k in (start..end).rev() {
                for i in k + 1..end {
                    b[k] -= u[k * stride + i] * b[i];
                }
                b[k] *= inverse_diagonal[k];
            }
            end = start;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_algebra::dense::{gram, mul, numbers};

    #[test]
    fn cholesky_solves_and_takes_dependent_variables_out() {
        for n in [1, 3, 4, 5, 8, 13, 53] {
            let rows = numbers(2 * n * n, 0.4);
            let a = gram(&rows, n);
            let x = numbers(n, 2.0);
            let mut b = vec![0.0; n];
            mul(&a, &x, &mut b);
            let mut cholesky = Cholesky::default();
            cholesky.reset(n);
            for i in 0..n {
                cholesky.row_mut(i).copy_from_slice(&a[i * n + i..(i + 1) * n]);
            }
            assert_eq!(cholesky.factor(), 0);
            cholesky.solve(&mut b);
            let worst = b.iter().zip(&x).fold(0.0_f64, |s, (a, b)| s.max((a - b).abs()));
            assert!(worst < 1e-9, "{n}: {worst:e}");
        }
        // The third variable is the sum of the first two.
        let m = [1.0, 0.0, 1.0, 0.0, 2.0, 2.0, 3.0, 1.0, 4.0];
        let mut cholesky = Cholesky::default();
        cholesky.reset(3);
        let a = gram(&m, 3);
        for i in 0..3 {
            cholesky.row_mut(i).copy_from_slice(&a[i * 3 + i..(i + 1) * 3]);
        }
        assert_eq!(cholesky.factor(), 1);
        let mut b = [a[0] + 2.0 * a[1], a[3] + 2.0 * a[4], a[6] + 2.0 * a[7]];
        cholesky.solve(&mut b);
        assert!((b[0] - 1.0).abs() < 1e-12 && (b[1] - 2.0).abs() < 1e-12 && b[2] == 0.0);
    }
}
