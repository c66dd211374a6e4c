//! Sums, exponentials and distances in an order of operations that is written down: the same bits on
//! every target. Many rows at once are done by the widest vectors that a processor has
//! ([`mimique_solver::widest`]), which changes no bit.

use mimique_solver::{exp_all, widest};
pub(crate) use mimique_stats::dot;

/// ln(sum of e^x); minus infinity of none. The numbers in `values` are lost.
pub(crate) fn log_sum(values: &mut [f64]) -> f64 {
    let highest = highest_value(values);
    if highest == f64::NEG_INFINITY {
        return highest;
    }
    values.iter_mut().for_each(|v| *v -= highest);
    exp_all(values);
    highest + libm::log(values.iter().sum())
}

/// Scores to probabilities that add to 1, in place: e^x over their sum.
pub(crate) fn softmax(scores: &mut [f64]) {
    shares(scores);
}

/// The same; ln(sum of e^x) comes back.
pub(crate) fn softmax_and_log_sum(scores: &mut [f64]) -> f64 {
    let (highest, sum) = shares(scores);
    highest + libm::log(sum)
}

/// e^x over their sum; the highest x, and the sum of e^x over e^highest.
fn shares(scores: &mut [f64]) -> (f64, f64) {
    let highest = highest_value(scores);
    scores.iter_mut().for_each(|s| *s -= highest);
    exp_all(scores);
    let sum: f64 = scores.iter().sum();
    scores.iter_mut().for_each(|s| *s /= sum);
    (highest, sum)
}

/// The highest number; minus infinity of none.
pub(crate) fn highest_value(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The place of the highest number; of equals the first; 0 of none.
pub(crate) fn highest(values: &[f64]) -> usize {
    let mut best = 0;
    for (place, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = place;
        }
    }
    best
}

/// Numbers that are added side by side, so that processors can: always as many, so that the sum is
/// the same bits everywhere.
pub(crate) const LANES: usize = 8;

/// The sum of the lanes.
#[inline(always)]
pub(crate) fn together([a, b, c, d, e, f, g, h]: [f64; LANES]) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Sum of the squared differences.
#[inline(always)]
pub(crate) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            let way = a[lane] - b[lane];
            sums[lane] += way * way;
        }
    }
    let mut sum = together(sums);
    for (a, b) in a_rest.iter().zip(b_rest) {
        sum += (a - b) * (a - b);
    }
    sum
}

widest! {
    /// [`squared_distance`] of a row from each row of a table of the same width.
    fn squared_distances(rows: &[f64], row: &[f64], out: &mut [f64]) {
        for (own, out) in rows.chunks_exact(row.len()).zip(out) {
            *out = squared_distance(own, row);
        }
    }
}

/// Rows that are asked together, so that those of a table are read once for all.
pub(crate) const BLOCK: usize = 4;

widest! {
    /// [`dot`] of a row with each row of a table of the same width.
    fn dots(rows: &[f64], row: &[f64], out: &mut [f64]) {
        for (own, out) in rows.chunks_exact(row.len()).zip(out) {
            *out = dot(own, row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_any_length_have_every_member_once() {
        for n in [1usize, 7, 8, 9, 16, 51] {
            let ascending: Vec<f64> = (0..n).map(|i| i as f64).collect();
            let ones = vec![1.0; n];
            let total = (n * n.saturating_sub(1) / 2) as f64;
            assert_eq!(dot(&ascending, &ones), total);
            let squares: f64 = ascending.iter().map(|v| (v - 1.0) * (v - 1.0)).sum();
            assert_eq!(squared_distance(&ascending, &ones), squares);
            let rows = [ascending.clone(), ones.clone()].concat();
            let mut out = [0.0; 2];
            squared_distances(&rows, &ones, &mut out);
            assert_eq!(out, [squares, 0.0]);
            dots(&rows, &ones, &mut out);
            assert_eq!(out, [total, n as f64]);
        }
        assert_eq!((dot(&[], &[]), squared_distance(&[], &[])), (0.0, 0.0));
    }

    #[test]
    fn many_rows_have_the_bits_of_one() {
        let mut random = mimique_test_support::Random::new(4);
        let rows: Vec<f64> = (0..51 * 40).map(|_| random.normal()).collect();
        let row: Vec<f64> = (0..51).map(|_| random.normal()).collect();
        let mut out = vec![0.0; 40];
        squared_distances(&rows, &row, &mut out);
        for (own, out) in rows.chunks_exact(51).zip(&out) {
            assert_eq!(squared_distance(own, &row).to_bits(), out.to_bits());
        }
        dots(&rows, &row, &mut out);
        for (own, out) in rows.chunks_exact(51).zip(&out) {
            assert_eq!(dot(own, &row).to_bits(), out.to_bits());
        }
    }

    #[test]
    fn sums_of_exponentials_neither_overflow_nor_vanish() {
        assert_eq!(log_sum(&mut [-1e6, -1e6]), -1e6 + libm::log(2.0));
        assert_eq!(log_sum(&mut [1e6]), 1e6);
        assert_eq!(log_sum(&mut [f64::NEG_INFINITY; 3]), f64::NEG_INFINITY);
        let mut scores = [1e4, 1e4, f64::NEG_INFINITY];
        softmax(&mut scores);
        assert_eq!(scores, [0.5, 0.5, 0.0]);
        let mut scores = [3.0, 3.0 + libm::log(3.0)];
        assert!((softmax_and_log_sum(&mut scores) - 3.0 - libm::log(4.0)).abs() < 1e-15);
        assert!((scores[1] - 0.75).abs() < 1e-15);
    }
}
