//! Symmetric positive definite systems of up to six unknowns, without memory of their own.

/// Most rows: two markers of three coordinates.
pub(crate) const MOST: usize = 6;

/// A square of up to six rows; row i begins at 6 i.
pub(crate) type Small = [f64; MOST * MOST];

/// L of A = L L^T.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmallCholesky {
    n: usize,
    l: Small,
}

impl SmallCholesky {
    /// The factor of the first `n` rows and columns; a pivot that is not above 0 gives NaN.
    pub(crate) fn of(a: &Small, n: usize) -> Self {
        let mut l = [0.0; MOST * MOST];
        for j in 0..n {
            for i in j..n {
                let mut sum = a[i * MOST + j];
                for k in 0..j {
                    sum -= l[i * MOST + k] * l[j * MOST + k];
                }
                l[i * MOST + j] = if i == j { sum.sqrt() } else { sum / l[j * MOST + j] };
            }
        }
        Self { n, l }
    }

    pub(crate) fn log_determinant(&self) -> f64 {
        (0..self.n).map(|i| 2.0 * libm::log(self.l[i * MOST + i])).sum()
    }

    /// b := A^-1 b, `n` numbers.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        for i in 0..self.n {
            for k in 0..i {
                b[i] -= self.l[i * MOST + k] * b[k];
            }
            b[i] /= self.l[i * MOST + i];
        }
        for i in (0..self.n).rev() {
            for k in i + 1..self.n {
                b[i] -= self.l[k * MOST + i] * b[k];
            }
            b[i] /= self.l[i * MOST + i];
        }
    }

    /// M := M A^-1 for the first rows and `n` columns of M: its rows are solved for, A being symmetric.
    pub(crate) fn solve_rows(&self, m: &mut Small, rows: usize) {
        for row in m.chunks_exact_mut(MOST).take(rows) {
            self.solve(row);
        }
    }

    /// X := A^-1 X for a row-major X of `n` rows.
    pub(crate) fn solve_wide(&self, x: &mut [f64]) {
        let width = x.len() / self.n.max(1);
        let mut column = [0.0; MOST];
        for j in 0..width {
            for i in 0..self.n {
                column[i] = x[i * width + j];
            }
            self.solve(&mut column);
            for i in 0..self.n {
                x[i * width + j] = column[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_algebra::dense::numbers;

    #[test]
    fn solves_and_tells_the_determinant() {
        for n in 1..=MOST {
            let rows = numbers(n * 9, 0.3);
            let mut a = [0.0; MOST * MOST];
            for (i, x) in rows.chunks_exact(9).enumerate() {
                for (j, y) in rows.chunks_exact(9).enumerate() {
                    a[i * MOST + j] = x.iter().zip(y).map(|(x, y)| x * y).sum();
                }
            }
            let factor = SmallCholesky::of(&a, n);
            let x = numbers(n, 4.0);
            let mut b: Vec<f64> =
                (0..n).map(|i| (0..n).map(|j| a[i * MOST + j] * x[j]).sum()).collect();
            factor.solve(&mut b);
            let worst = b.iter().zip(&x).fold(0.0_f64, |m, (b, x)| m.max((b - x).abs()));
            assert!(worst < 1e-10, "{n}: {worst:e}");
            if n == 2 {
                let determinant = a[0] * a[MOST + 1] - a[1] * a[MOST];
                assert!((factor.log_determinant() - determinant.ln()).abs() < 1e-12);
            }
        }
    }
}
