//! Shapes that depend on each other: among the weights that fit equally well, the least.
//!
//! Where the columns of D depend on each other (a bank with visemes made of its other shapes, more
//! shapes than marker coordinates), |Dc - d|^2 has many minimisers, and where they nearly do, it has one
//! that noise puts anywhere. The one with the least norm is the limit of adding delta |c|^2 as delta
//! goes to 0; delta is small and not 0 here, so that a near dependence does not amplify noise.

use crate::linear_algebra::cholesky::Cholesky;

/// What is left of a shape, after the others before it, below which its weight is noise: a thousandth of a
/// shape of 10 mm is 0.01 mm, a tenth of what a marker is measured to.
const NEARLY_DEPENDENT: f64 = 1e-3;

/// delta, in units of the mean diagonal entry of Q. A shape that stands alone loses a millionth.
const RIDGE: f64 = 1e-6;

/// Adds delta to the diagonal of `q`, n x n, if its variables depend on each other, to
/// [`NEARLY_DEPENDENT`]. Returns whether they do. Variables without any effect do not count.
pub(crate) fn choose_least_norm(q: &mut [f64], n: usize) -> bool {
    let seen: Vec<usize> = (0..n).filter(|&i| q[i * n + i] > 0.0).collect();
    let mut factor = Cholesky::default();
    factor.reset(seen.len());
    for (at, &i) in seen.iter().enumerate() {
        for (entry, &j) in factor.row_mut(at).iter_mut().zip(&seen[at..]) {
            *entry = q[i * n + j];
        }
    }
    factor.factor();
    if factor.least_share(seen.iter().map(|&i| q[i * n + i])) >= NEARLY_DEPENDENT {
        return false;
    }
    let mean = seen.iter().map(|&i| q[i * n + i]).sum::<f64>() / seen.len().max(1) as f64;
    for i in 0..n {
        q[i * n + i] += RIDGE * mean;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_algebra::dense::{gram, numbers};
    use crate::quadratic::box_qp::BoxState;

    /// Rows x n of five independent columns, and a sixth that is the sum of the first two but for
    /// `apart` of their size.
    fn bank(rows: usize, apart: f64) -> Vec<f64> {
        let columns: Vec<Vec<f64>> =
            (0..6).map(|k| numbers(rows, 0.4 + 1.7 * f64::from(k))).collect();
        (0..rows)
            .flat_map(|i| {
                let c = |k: usize| columns[k][i];
                [c(0), c(1), c(2), c(3), c(4), c(0) + c(1) + apart * c(5)]
            })
            .collect()
    }

    #[test]
    fn the_least_of_equal_answers_is_taken_and_noise_is_not_amplified() {
        let rows = 40;
        // Here noise of a thousandth is as large as what tells them apart.
        for (apart, within) in [(0.0, 0.02), (1e-9, 0.02), (1e-5, 0.02), (5e-4, 0.1)] {
            let bank = bank(rows, apart);
            let mut q = gram(&bank, 6);
            assert!(choose_least_norm(&mut q, 6), "{apart}");
            // 0.9 of the first two and 0.3 of the third, and noise of a thousandth.
            let noise = numbers(rows, 0.123);
            let b: Vec<f64> = (0..6)
                .map(|k| {
                    (0..rows)
                        .map(|i| {
                            let row = &bank[i * 6..i * 6 + 6];
                            row[k] * (0.9 * (row[0] + row[1]) + 0.3 * row[2] + 1e-3 * noise[i])
                        })
                        .sum()
                })
                .collect();
            let mut c = [0.0; 6];
            let outcome = BoxState::default().solve(&q, &b, &[[0.0, f64::INFINITY]; 6], &mut c);
            assert!(outcome.converged && outcome.kkt_error < 1e-9, "{apart}: {outcome:?}");
            // The least norm: a third of it by each of the two, two thirds by their sum.
            for (c, expected) in c.iter().zip([0.3, 0.3, 0.3, 0.0, 0.0, 0.6]) {
                assert!((c - expected).abs() < within, "{apart}: {c} of {expected}");
            }
        }
    }

    #[test]
    fn independent_shapes_are_left_as_they_are() {
        let mut q = gram(&bank(40, 1.0), 6);
        let before = q.clone();
        assert!(!choose_least_norm(&mut q, 6));
        assert_eq!(q, before);
        // A shape that no marker sees depends on nothing.
        let mut unseen = vec![0.0; 49];
        for i in 0..6 {
            unseen[i * 7..i * 7 + 6].copy_from_slice(&before[i * 6..i * 6 + 6]);
        }
        let before = unseen.clone();
        assert!(!choose_least_norm(&mut unseen, 7));
        assert_eq!(unseen, before);
    }
}
