//! One-sided Jacobi: the pseudo-inverse of a small matrix, to full relative accuracy.

/// The Moore-Penrose inverse of a row-major `rows` x `n` matrix: n x rows, row-major.
///
/// Singular values below `rows` x unit round-off of the largest count as 0, so that a shape that no
/// marker sees gets weight 0.
pub(crate) fn pseudo_inverse(m: &[f64], rows: usize, n: usize) -> Vec<f64> {
    // Columns of M, turned until they are orthogonal: M V = U S.
    let mut us: Vec<Vec<f64>> = (0..n).map(|j| (0..rows).map(|i| m[i * n + j]).collect()).collect();
    let mut v: Vec<Vec<f64>> =
        (0..n).map(|j| (0..n).map(|i| f64::from(i == j)).collect()).collect();
    // Quadratic convergence after a few sweeps; 60 is a guard.
    for _ in 0..60 {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let (a, b) = (norm2(&us[p]), norm2(&us[q]));
                let c = inner(&us[p], &us[q]);
                if c == 0.0 || c.abs() <= 1e-15 * (a * b).sqrt() {
                    continue;
                }
                rotated = true;
                let zeta = (b - a) / (2.0 * c);
                let sign = if zeta < 0.0 { -1.0 } else { 1.0 };
                let t = sign / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let cos = 1.0 / (1.0 + t * t).sqrt();
                let sin = cos * t;
                turn(&mut us, p, q, cos, sin);
                turn(&mut v, p, q, cos, sin);
            }
        }
        if !rotated {
            break;
        }
    }
    let squares: Vec<f64> = us.iter().map(|u| norm2(u)).collect();
    let largest = squares.iter().fold(0.0_f64, |s, x| s.max(*x)).sqrt();
    let smallest = largest * rows as f64 * f64::EPSILON;
    let mut inverse = vec![0.0; n * rows];
    for ((u, v), s2) in us.iter().zip(&v).zip(&squares) {
        if s2.sqrt() > smallest {
            for i in 0..n {
                let factor = v[i] / s2;
                for (out, u) in inverse[i * rows..(i + 1) * rows].iter_mut().zip(u) {
                    *out += factor * u;
                }
            }
        }
    }
    inverse
}

fn turn(columns: &mut [Vec<f64>], p: usize, q: usize, cos: f64, sin: f64) {
    let (left, right) = columns.split_at_mut(q);
    for (x, y) in left[p].iter_mut().zip(&mut right[0]) {
        let (a, b) = (*x, *y);
        *x = cos * a - sin * b;
        *y = sin * a + cos * b;
    }
}

fn norm2(x: &[f64]) -> f64 {
    inner(x, x)
}

fn inner(x: &[f64], y: &[f64]) -> f64 {
    crate::dense::dot(x, y)
}
