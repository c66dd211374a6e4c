//! Small dense linear algebra with a fixed order of operations.
//!
//! Every loop either updates independent numbers (which a compiler may do several at a time without
//! changing one of them) or sums in an order written here; no fused multiply-add. So the bits are
//! the same on every processor and in WebAssembly, whatever the width of its vectors.

/// Compile a function twice on x86-64, for the vectors that every processor has and for AVX's of
/// twice the width, and choose at run time. Without the feature `fma` the bits are the same.
/// `widest! { [FEATURES] fn ... }` names the features itself, the widest first.
macro_rules! widest {
    ([$($feature:tt),*] $(#[$doc:meta])* fn $name:ident($($arg:ident: $type:ty),*)
        $(-> $out:ty)? $body:block) => {
        $(#[$doc])*
        #[inline]
        #[allow(unsafe_code)]
        pub(crate) fn $name($($arg: $type),*) $(-> $out)? {
            #[inline(always)]
            fn any($($arg: $type),*) $(-> $out)? $body
            widest!(@choose any [$($feature),*] ($($arg: $type),*) ($($arg),*) ($($out)?));
            any($($arg),*)
        }
    };
    ($(#[$doc:meta])* fn $name:ident($($arg:ident: $type:ty),*) $(-> $out:ty)? $body:block) => {
        widest! { ["avx"] $(#[$doc])* fn $name($($arg: $type),*) $(-> $out)? $body }
    };
    (@choose $any:ident [$($feature:tt),*] $taken:tt $given:tt $out:tt) => {
        $(widest!(@one $any $feature $taken $given $out);)*
    };
    (@one $any:ident $feature:tt ($($arg:ident: $type:ty),*) $given:tt ($($out:ty)?)) => {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = $feature)]
            fn wide($($arg: $type),*) $(-> $out)? {
                $any($($arg),*)
            }
            if std::arch::is_x86_feature_detected!($feature) {
                // SAFETY: the processor has the feature, as was just asked.
                return unsafe { wide $given };
            }
        }
    };
}
pub(crate) use widest;

/// Length of a packed triangle of an n x n matrix.
pub(crate) fn packed_len(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Sum of x_i y_i in four interleaved partial sums, then (0 + 1) + (2 + 3), then the rest.
#[inline(always)]
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

/// [`dot`] of four rows with one x, side by side: a processor adds the next row while it waits for
/// the last one.
#[inline(always)]
pub(crate) fn dot4(rows: [&[f64]; 4], x: &[f64]) -> [f64; 4] {
    let n = x.len();
    let [r0, r1, r2, r3] = rows;
    let rows = [&r0[..n], &r1[..n], &r2[..n], &r3[..n]];
    let mut lanes = [[0.0; 4]; 4];
    let (xs, x_rest) = x.as_chunks::<4>();
    // Written out: a closure would be a call from code that is compiled for wider vectors.
    let chunks = [
        &rows[0].as_chunks::<4>().0[..xs.len()],
        &rows[1].as_chunks::<4>().0[..xs.len()],
        &rows[2].as_chunks::<4>().0[..xs.len()],
        &rows[3].as_chunks::<4>().0[..xs.len()],
    ];
    for (i, x) in xs.iter().enumerate() {
        for r in 0..4 {
            let row = &chunks[r][i];
            for k in 0..4 {
                lanes[r][k] += row[k] * x[k];
            }
        }
    }
    let mut sums = [0.0; 4];
    for r in 0..4 {
        sums[r] = (lanes[r][0] + lanes[r][1]) + (lanes[r][2] + lanes[r][3]);
    }
    for (i, x) in x_rest.iter().enumerate() {
        for r in 0..4 {
            sums[r] += rows[r][4 * xs.len() + i] * x;
        }
    }
    sums
}

/// y += a x.
#[inline(always)]
pub(crate) fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

widest! {
    /// y = M x for a row-major matrix of `y.len()` rows.
    fn mul(m: &[f64], x: &[f64], y: &mut [f64]) {
        let n = x.len();
        let (fours, rest) = y.as_chunks_mut::<4>();
        let (blocks, last) = m.split_at(fours.len() * 4 * n);
        for (rows, y) in blocks.chunks_exact(4 * n).zip(fours) {
            *y = dot4([&rows[..n], &rows[n..2 * n], &rows[2 * n..3 * n], &rows[3 * n..]], x);
        }
        for (row, y) in last.chunks_exact(n).zip(rest) {
            *y = dot(row, x);
        }
    }
}

widest! {
    /// y = M^T x for a row-major matrix of `x.len()` rows; four rows at a time, in their order.
    fn mul_transposed(m: &[f64], x: &[f64], y: &mut [f64]) {
        let n = y.len();
        y.fill(0.0);
        let (fours, rest) = x.as_chunks::<4>();
        let (blocks, last) = m[..x.len() * n].split_at(fours.len() * 4 * n);
        for (rows, x) in blocks.chunks_exact(4 * n).zip(fours) {
            let (r0, rows) = rows.split_at(n);
            let (r1, rows) = rows.split_at(n);
            let (r2, r3) = rows.split_at(n);
            for j in 0..n {
                y[j] = (((y[j] + x[0] * r0[j]) + x[1] * r1[j]) + x[2] * r2[j]) + x[3] * r3[j];
            }
        }
        for (row, &x) in last.chunks_exact(n).zip(rest) {
            axpy(x, row, y);
        }
    }
}

widest! {
    /// y = R x for an upper triangle of `y.len()` rows, row-major, zeros written out.
    fn mul_triangle(r: &[f64], x: &[f64], y: &mut [f64]) {
        let n = x.len();
        let (fours, rest) = y.as_chunks_mut::<4>();
        let done = 4 * fours.len();
        for (block, y) in fours.iter_mut().enumerate() {
            let i = 4 * block;
            let row = |k: usize| &r[(i + k) * n + i..(i + k + 1) * n];
            *y = dot4([row(0), row(1), row(2), row(3)], &x[i..]);
        }
        for (i, y) in (done..).zip(rest) {
            *y = dot(&r[i * n + i..(i + 1) * n], &x[i..]);
        }
    }
}

widest! {
    /// y = R^T x for an upper triangle of `x.len()` rows; four rows at a time, in their order.
    fn mul_triangle_transposed(r: &[f64], x: &[f64], y: &mut [f64]) {
        let n = y.len();
        y.fill(0.0);
        let (fours, rest) = x.as_chunks::<4>();
        for (block, x) in fours.iter().enumerate() {
            let i = 4 * block;
            let y = &mut y[i..];
            let width = n - i;
            let row = |k: usize| &r[(i + k) * n + i..][..width];
            let (r0, r1, r2, r3) = (row(0), row(1), row(2), row(3));
            let y = &mut y[..width];
            for j in 0..width {
                y[j] = (((y[j] + x[0] * r0[j]) + x[1] * r1[j]) + x[2] * r2[j]) + x[3] * r3[j];
            }
        }
        for (k, &x) in rest.iter().enumerate() {
            let i = 4 * fours.len() + k;
            axpy(x, &r[i * n + i..(i + 1) * n], &mut y[i..]);
        }
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

/// Q and R of M = Q R by Householder's reflections; R is upper triangular.
///
/// M: `rows` x n, row-major. Returns Q^T (r x rows) and R (r x n), r the smaller of both. A matrix
/// without full rank has zeros, or rounding, on the diagonal of R.
pub(crate) fn householder(m: &[f64], rows: usize, n: usize) -> (Vec<f64>, Vec<f64>) {
    let rank = rows.min(n);
    let mut columns: Vec<Vec<f64>> =
        (0..n).map(|j| (0..rows).map(|i| m[i * n + j]).collect()).collect();
    let mut mirrors: Vec<Vec<f64>> = Vec::with_capacity(rank);
    for k in 0..rank {
        let mut v = columns[k][k..].to_vec();
        let length = dot(&v, &v).sqrt();
        v[0] += if v[0] < 0.0 { -length } else { length };
        let square = dot(&v, &v);
        if square > 0.0 {
            for column in &mut columns[k..] {
                reflect(&v, square, &mut column[k..]);
            }
        }
        mirrors.push(v);
    }
    let mut q_transposed = vec![0.0; rank * rows];
    for (i, row) in q_transposed.chunks_exact_mut(rows.max(1)).enumerate() {
        row[i] = 1.0;
        for k in (0..rank).rev() {
            let v = &mirrors[k];
            let square = dot(v, v);
            if square > 0.0 {
                reflect(v, square, &mut row[k..]);
            }
        }
    }
    let mut r = vec![0.0; rank * n];
    for i in 0..rank {
        for j in i..n {
            r[i * n + j] = columns[j][i];
        }
    }
    (q_transposed, r)
}

/// x - 2 v (v.x) / |v|^2.
fn reflect(v: &[f64], square: f64, x: &mut [f64]) {
    axpy(-2.0 * dot(v, x) / square, v, x);
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

/// Numbers without a pattern, for tests.
#[cfg(test)]
pub(crate) fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|i| (1e4 * (seed + 1.3 * i as f64).sin()).fract()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn householder_splits_into_orthogonal_and_triangular() {
        for (rows, n) in [(7, 4), (4, 7), (1, 1), (120, 53)] {
            let m = numbers(rows * n, 0.7);
            let (qt, r) = householder(&m, rows, n);
            let rank = rows.min(n);
            for i in 0..rows {
                for j in 0..n {
                    let x: f64 = (0..rank).map(|k| qt[k * rows + i] * r[k * n + j]).sum();
                    assert!((x - m[i * n + j]).abs() < 1e-13);
                }
            }
            for a in 0..rank {
                for b in 0..rank {
                    let x = dot(&qt[a * rows..(a + 1) * rows], &qt[b * rows..(b + 1) * rows]);
                    assert!((x - f64::from(u8::from(a == b))).abs() < 1e-13);
                }
                assert!(r[a * n..a * n + a.min(n)].iter().all(|&x| x == 0.0));
            }
        }
    }

    #[test]
    fn general_solve_finds_the_solution_or_says_singular() {
        let mut a = numbers(25, 0.2);
        let original = a.clone();
        let x = numbers(10, 5.0);
        let mut b = vec![0.0; 10];
        for i in 0..5 {
            for j in 0..2 {
                b[i * 2 + j] = (0..5).map(|k| a[i * 5 + k] * x[k * 2 + j]).sum();
            }
        }
        assert!(solve_general(&mut a, &mut b, 5).is_some());
        assert!(b.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-9), "{original:?}");
        assert!(solve_general(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0], 2).is_none());
    }
}
