//! Small dense linear algebra with a fixed order of operations.
//!
//! Every loop either updates independent numbers (which a compiler may do several at a time without
//! changing one of them) or sums in an order written here; no fused multiply-add. So the bits are
//! the same on every processor and in WebAssembly, whatever the width of its vectors.

/// Compile a function twice on x86-64, for the vectors that every processor has and for AVX's of
/// twice the width, and choose at run time. Without the feature `fma` the bits are the same.
/// `widest! { [FEATURES] fn ... }` names the features itself, the widest first. Inside, loops are to be
/// written out: a closure would be a call from code that is compiled for wider vectors.
#[macro_export]
macro_rules! widest {
    ([$($feature:tt),*] $(#[$doc:meta])* fn $name:ident($($arg:ident: $type:ty),*)
        $(-> $out:ty)? $body:block) => {
        $(#[$doc])*
        #[inline]
        #[allow(unsafe_code)]
        pub fn $name($($arg: $type),*) $(-> $out)? {
            #[inline(always)]
            fn any($($arg: $type),*) $(-> $out)? $body
            $crate::widest!(@choose any [$($feature),*] ($($arg: $type),*) ($($arg),*) ($($out)?));
            any($($arg),*)
        }
    };
    ($(#[$doc:meta])* fn $name:ident($($arg:ident: $type:ty),*) $(-> $out:ty)? $body:block) => {
        $crate::widest! { ["avx"] $(#[$doc])* fn $name($($arg: $type),*) $(-> $out)? $body }
    };
    (@choose $any:ident [$($feature:tt),*] $taken:tt $given:tt $out:tt) => {
        $($crate::widest!(@one $any $feature $taken $given $out);)*
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

/// Sum of (x_i - y_i)^2 in the order of [`dot`].
#[inline(always)]
pub(crate) fn squared_distance(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len();
    let y = &y[..n];
    let mut lanes = [0.0; 4];
    let (xs, x_rest) = x.as_chunks::<4>();
    let (ys, y_rest) = y.as_chunks::<4>();
    for (a, b) in xs.iter().zip(ys) {
        for k in 0..4 {
            let d = a[k] - b[k];
            lanes[k] += d * d;
        }
    }
    let mut sum = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    for (a, b) in x_rest.iter().zip(y_rest) {
        sum += (a - b) * (a - b);
    }
    sum
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

/// Numbers without a pattern, for tests.
#[cfg(test)]
pub(crate) fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|i| (1e4 * (seed + 1.3 * i as f64).sin()).fract()).collect()
}
