//! Sums of exponentials and the place of the highest number, the same bits on every target.

pub(crate) use mimique_stats::dot;

/// ln(sum of e^x); minus infinity of none.
pub(crate) fn log_sum(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if highest == f64::NEG_INFINITY {
        return highest;
    }
    highest + libm::log(values.iter().map(|v| libm::exp(v - highest)).sum())
}

/// Scores to probabilities that add to 1, in place: e^x over their sum.
pub(crate) fn softmax(scores: &mut [f64]) {
    let highest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    scores.iter_mut().for_each(|s| *s = libm::exp(*s - highest));
    let sum: f64 = scores.iter().sum();
    scores.iter_mut().for_each(|s| *s /= sum);
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
const LANES: usize = 8;

/// Sum of a function of two lists' members, lists of one length.
fn sum(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += of(a[lane], b[lane]);
        }
    }
    sums.iter_mut().zip(a_rest).zip(b_rest).for_each(|((sum, a), b)| *sum += of(*a, *b));
    together(sums)
}

fn together([a, b, c, d, e, f, g, h]: [f64; LANES]) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Sum of the squared differences.
pub(crate) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    sum(a, b, |a, b| (a - b) * (a - b))
}

/// Sum of the squared differences, each times a weight.
pub(crate) fn weighted_distance(a: &[f64], b: &[f64], weight: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    let (weight, weight_rest) = weight.as_chunks::<LANES>();
    for ((a, b), weight) in a.iter().zip(b).zip(weight) {
        for lane in 0..LANES {
            sums[lane] += (a[lane] - b[lane]) * (a[lane] - b[lane]) * weight[lane];
        }
    }
    let rest = a_rest.iter().zip(b_rest).zip(weight_rest);
    sums.iter_mut().zip(rest).for_each(|(sum, ((a, b), w))| *sum += (a - b) * (a - b) * w);
    together(sums)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_any_length_have_every_member_once() {
        for n in [0usize, 1, 7, 8, 9, 16, 51] {
            let ascending: Vec<f64> = (0..n).map(|i| i as f64).collect();
            let ones = vec![1.0; n];
            let total = (n * n.saturating_sub(1) / 2) as f64;
            assert_eq!(dot(&ascending, &ones), total);
            let squares: f64 = ascending.iter().map(|v| (v - 1.0) * (v - 1.0)).sum();
            assert_eq!(squared_distance(&ascending, &ones), squares);
            assert_eq!(weighted_distance(&ascending, &ones, &vec![2.0; n]), 2.0 * squares);
        }
    }

    #[test]
    fn sums_of_exponentials_neither_overflow_nor_vanish() {
        assert_eq!(log_sum(&[-1e6, -1e6]), -1e6 + libm::log(2.0));
        assert_eq!(log_sum(&[1e6]), 1e6);
        assert_eq!(log_sum(&[f64::NEG_INFINITY; 3]), f64::NEG_INFINITY);
        let mut scores = [1e4, 1e4, f64::NEG_INFINITY];
        softmax(&mut scores);
        assert_eq!(scores, [0.5, 0.5, 0.0]);
    }
}
