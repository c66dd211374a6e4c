//! Moments of frames.

/// Sum over the rows of x x^T, n x n.
pub(super) fn products(rows: &[f64], n: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n * n];
    for row in rows.chunks_exact(n) {
        for (i, &x) in row.iter().enumerate() {
            if x != 0.0 {
                let line = &mut sum[i * n + i..(i + 1) * n];
                line.iter_mut().zip(&row[i..]).for_each(|(s, y)| *s += x * y);
            }
        }
    }
    for i in 0..n {
        for j in 0..i {
            sum[i * n + j] = sum[j * n + i];
        }
    }
    sum
}

/// E\[xx^T\].
pub(super) fn second_moment(rows: &[f64], n: usize) -> Vec<f64> {
    let count = (rows.len() / n).max(1) as f64;
    let mut moment = products(rows, n);
    moment.iter_mut().for_each(|m| *m /= count);
    moment
}

/// The covariance (1/rows).
pub(super) fn covariance(rows: &[f64], n: usize) -> Vec<f64> {
    let count = (rows.len() / n).max(1) as f64;
    let mut mean = vec![0.0; n];
    for row in rows.chunks_exact(n) {
        mean.iter_mut().zip(row).for_each(|(m, x)| *m += x / count);
    }
    let centred: Vec<f64> =
        rows.chunks_exact(n).flat_map(|row| row.iter().zip(&mean).map(|(x, m)| x - m)).collect();
    second_moment(&centred, n)
}
