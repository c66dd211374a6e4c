//! Small dense linear algebra with a fixed order of operations.
//!
//! Every loop either updates independent numbers (which a compiler may do several at a time without
//! changing one of them) or sums in an order written here; no fused multiply-add. So the bits are
//! the same on every processor and in WebAssembly, whatever the width of its vectors.

/// Length of a packed triangle of an n x n matrix.
pub(crate) fn packed_len(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Sum of x_i y_i in four interleaved partial sums, then (0 + 1) + (2 + 3), then the rest.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    let mut lanes = [0.0; 4];
    let (xs, x_rest) = x.as_chunks::<4>();
    let (ys, y_rest) = y.as_chunks::<4>();
    for (a, b) in xs.iter().zip(ys) {
        for k in 0..4 {
            lanes[k] += a[k] * b[k];
        }
    }
    let mut sum = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    for (a, b) in x_rest.iter().zip(y_rest) {
        sum += a * b;
    }
    sum
}

/// y += a x.
pub(crate) fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// y = M x for a row-major matrix of `y.len()` rows.
pub(crate) fn mul(m: &[f64], x: &[f64], y: &mut [f64]) {
    for (row, y) in m.chunks_exact(x.len()).zip(y) {
        *y = dot(row, x);
    }
}

/// y = M^T x for a row-major matrix of `x.len()` rows.
pub(crate) fn mul_transposed(m: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (row, &x) in m.chunks_exact(y.len()).zip(x) {
        axpy(x, row, y);
    }
}

/// M^T M of a row-major matrix with n columns: n x n.
pub(crate) fn gram(m: &[f64], n: usize) -> Vec<f64> {
    let mut g = vec![0.0; n * n];
    for row in m.chunks_exact(n) {
        for (i, &x) in row.iter().enumerate() {
            if x != 0.0 {
                axpy(x, &row[i..], &mut g[i * n + i..(i + 1) * n]);
            }
        }
    }
    for i in 0..n {
        for j in 0..i {
            g[i * n + j] = g[j * n + i];
        }
    }
    g
}

/// U of A = U^T U, upper triangle, row-major; keeps its memory between uses.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cholesky {
    n: usize,
    /// The upper triangle holds A before, U after [`Cholesky::factor`].
    u: Vec<f64>,
    /// 1 / U_kk, or 0 where the pivot vanished.
    inverse_diagonal: Vec<f64>,
}

/// A pivot below this part of its own diagonal entry is rounding: the column depends on those
/// before it. 1e-13 is some 500 times the unit round-off, the growth of 50 subtractions with room.
const VANISHED_PIVOT: f64 = 1e-13;

impl Cholesky {
    /// Room for an n x n matrix; fill its upper triangle with [`Cholesky::row_mut`].
    pub(crate) fn reset(&mut self, n: usize) {
        self.n = n;
        self.u.resize(n * n, 0.0);
        self.inverse_diagonal.resize(n, 0.0);
    }

    /// Entries i.. of row i.
    pub(crate) fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.u[i * self.n + i..(i + 1) * self.n]
    }

    /// Factor in place. A variable that depends on those before it is taken out: its row of U and
    /// its solution are 0. Returns how many were.
    pub(crate) fn factor(&mut self) -> usize {
        let n = self.n;
        let mut vanished = 0;
        for k in 0..n {
            self.inverse_diagonal[k] = VANISHED_PIVOT * self.u[k * n + k];
        }
        for k in 0..n {
            let (head, tail) = self.u.split_at_mut((k + 1) * n);
            let row = &mut head[k * n + k..];
            let smallest = self.inverse_diagonal[k];
            if row[0] > smallest && row[0] > 0.0 {
                let root = row[0].sqrt();
                let inverse = 1.0 / root;
                row[0] = root;
                for x in &mut row[1..] {
                    *x *= inverse;
                }
                self.inverse_diagonal[k] = inverse;
                for i in k + 1..n {
                    let factor = row[i - k];
                    let target = &mut tail[(i - k - 1) * n + i..(i - k) * n];
                    for (t, x) in target.iter_mut().zip(&row[i - k..]) {
                        *t -= factor * x;
                    }
                }
            } else {
                row.fill(0.0);
                self.inverse_diagonal[k] = 0.0;
                vanished += 1;
            }
        }
        vanished
    }

    /// b := A^-1 b.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        for k in 0..n {
            let y = b[k] * self.inverse_diagonal[k];
            b[k] = y;
            let row = &self.u[k * n + k + 1..(k + 1) * n];
            for (b, u) in b[k + 1..n].iter_mut().zip(row) {
                *b -= u * y;
            }
        }
        for k in (0..n).rev() {
            let row = &self.u[k * n + k + 1..(k + 1) * n];
            b[k] = (b[k] - dot(row, &b[k + 1..n])) * self.inverse_diagonal[k];
        }
    }
}

/// Solve A X = B by Gaussian elimination with partial pivoting: A n x n, B n x m, both row-major
/// and overwritten, X in B. None where A is singular to working precision.
pub(crate) fn solve_general(a: &mut [f64], b: &mut [f64], n: usize) -> Option<()> {
    let m = b.len() / n;
    let scale = a.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    for k in 0..n {
        let mut pivot = k;
        for i in k + 1..n {
            if a[i * n + k].abs() > a[pivot * n + k].abs() {
                pivot = i;
            }
        }
        let size = a[pivot * n + k].abs();
        if !(size > scale * 1e-15) {
            return None;
        }
        if pivot != k {
            for j in 0..n {
                a.swap(k * n + j, pivot * n + j);
            }
            for j in 0..m {
                b.swap(k * m + j, pivot * m + j);
            }
        }
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            if factor != 0.0 {
                for j in k..n {
                    a[i * n + j] -= factor * a[k * n + j];
                }
                for j in 0..m {
                    b[i * m + j] -= factor * b[k * m + j];
                }
            }
        }
    }
    for k in (0..n).rev() {
        for j in 0..m {
            let mut x = b[k * m + j];
            for i in k + 1..n {
                x -= a[k * n + i] * b[i * m + j];
            }
            b[k * m + j] = x / a[k * n + k];
        }
    }
    Some(())
}
