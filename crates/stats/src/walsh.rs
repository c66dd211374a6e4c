//! Hodges-Lehmann estimates and intervals: order statistics of Walsh averages (one sample) and of
//! pairwise differences (two samples), found without listing them.

use serde::Serialize;

use crate::signed_rank::toss_distribution;
use crate::tail::normal_quantile_upper;

/// An estimate with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HodgesLehmann {
    /// Estimate of the location or shift.
    pub estimate: f64,
    /// Lower end.
    pub ci_low: f64,
    /// Upper end.
    pub ci_high: f64,
    /// The level asked for.
    pub conf_level: f64,
    /// Whether so few values can give that level; if not, the interval is the widest there is.
    pub level_reached: bool,
}

pub(crate) const LEVEL: f64 = 0.95;

/// Median of the Walsh averages (d_i + d_j)/2, i <= j.
pub(crate) fn one_sample_location(differences: &[f64]) -> f64 {
    let mut sorted = differences.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let pairs = pairs_of(sorted.len());
    let kth = |k| walsh_order_statistic(&sorted, k);
    0.5 * (kth(pairs.div_ceil(2)) + kth(pairs / 2 + 1))
}

/// Interval of the location from the Walsh averages of all differences: the signed rank distribution
/// without ties decides how many to cut off (exactly up to 200 differences, normal beyond), which is
/// conservative with ties.
pub(crate) fn one_sample_interval(differences: &[f64]) -> HodgesLehmann {
    let n = differences.len();
    let pairs = pairs_of(n);
    let cut = if n <= 200 {
        exact_cut(n)
    } else {
        let variance = (n * (n + 1) * (2 * n + 1)) as f64 / 24.0;
        (pairs as f64 / 2.0 - normal_quantile_upper((1.0 - LEVEL) / 2.0) * variance.sqrt() - 0.5)
            .floor()
            .max(0.0) as u64
    };
    interval_of_walsh(differences, cut)
}

/// Interval as R of 2019: exact, or by inverting the normal test with continuity correction, whose
/// variance knows only ties that remain at every shift.
pub(crate) fn thesis_interval(nonzero: &[f64], exact: bool) -> HodgesLehmann {
    let n = nonzero.len();
    if exact {
        let mut interval = interval_of_walsh(nonzero, exact_cut(n));
        interval.estimate = one_sample_location(nonzero);
        return interval;
    }
    let ties = crate::ranks::Ranks::of(nonzero).tie_term();
    let size = n as f64;
    let variance = size * (size + 1.0) * (2.0 * size + 1.0) / 24.0 - ties / 48.0;
    let half = pairs_of(n) as f64 / 2.0;
    let reach = 0.5 + normal_quantile_upper((1.0 - LEVEL) / 2.0) * variance.max(0.0).sqrt();
    // W+ at a shift is the number of Walsh averages above it; the border is where it falls below
    // half + reach.
    let cut = (half - reach).floor();
    if cut < 0.0 {
        let mut widest = interval_of_walsh(nonzero, 0);
        widest.level_reached = false;
        return widest;
    }
    interval_of_walsh(nonzero, cut as u64)
}

fn pairs_of(n: usize) -> u64 {
    n as u64 * (n as u64 + 1) / 2
}

/// How many Walsh averages to leave out at each end so that 2.5 % stay outside.
fn exact_cut(n: usize) -> u64 {
    let ranks: Vec<u64> = (1..=n as u64).collect();
    cut_of(toss_distribution(&ranks))
}

/// The quantile of 2.5 % of an integer distribution from 0, less one: with it as index from 1 the
/// interval begins.
pub(crate) fn cut_of(distribution: impl IntoIterator<Item = f64>) -> u64 {
    let mut below = 0.0;
    let quantile = distribution
        .into_iter()
        .take_while(|probability| {
            below += probability;
            below <= (1.0 - LEVEL) / 2.0
        })
        .count() as u64;
    quantile.saturating_sub(1)
}

/// The interval between the (cut+1)-th smallest and (cut+1)-th largest Walsh averages.
fn interval_of_walsh(differences: &[f64], cut: u64) -> HodgesLehmann {
    let mut sorted = differences.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let pairs = pairs_of(sorted.len());
    let cut = cut.min((pairs - 1) / 2);
    HodgesLehmann {
        estimate: one_sample_location(differences),
        ci_low: walsh_order_statistic(&sorted, cut + 1),
        ci_high: walsh_order_statistic(&sorted, pairs - cut),
        conf_level: LEVEL,
        // Even the widest interval misses with probability 2 / 2^n.
        level_reached: 0.5f64.powi(differences.len() as i32 - 1) <= 1.0 - LEVEL,
    }
}

/// The k-th smallest (from 1) of the Walsh averages of ascending values.
fn walsh_order_statistic(sorted: &[f64], k: u64) -> f64 {
    let at_most = |limit: f64| {
        // As i grows, fewer j satisfy the limit.
        let (mut count, mut end) = (0u64, sorted.len());
        for (i, &first) in sorted.iter().enumerate() {
            while end > i && 0.5 * (first + sorted[end - 1]) > limit {
                end -= 1;
            }
            if end <= i {
                break;
            }
            count += (end - i) as u64;
        }
        count
    };
    smallest_with(sorted[0], sorted[sorted.len() - 1], |limit| at_most(limit) >= k)
}

/// The k-th smallest (from 1) of the differences x - y of ascending samples.
fn difference_order_statistic(x: &[f64], y: &[f64], k: u64) -> f64 {
    let at_most = |limit: f64| {
        // As x grows, y must be larger.
        let (mut count, mut start) = (0u64, 0);
        for &first in x {
            while start < y.len() && first - y[start] > limit {
                start += 1;
            }
            count += (y.len() - start) as u64;
        }
        count
    };
    let (low, high) = (x[0] - y[y.len() - 1], x[x.len() - 1] - y[0]);
    smallest_with(low, high, |limit| at_most(limit) >= k)
}

/// Median of the pairwise differences x - y.
pub(crate) fn two_sample_location(x: &[f64], y: &[f64]) -> f64 {
    let pairs = x.len() as u64 * y.len() as u64;
    let kth = |k| difference_order_statistic(x, y, k);
    0.5 * (kth(pairs.div_ceil(2)) + kth(pairs / 2 + 1))
}

/// Interval between the (cut+1)-th smallest and largest pairwise differences of ascending samples.
pub(crate) fn two_sample_interval(x: &[f64], y: &[f64], cut: Option<u64>) -> HodgesLehmann {
    let pairs = x.len() as u64 * y.len() as u64;
    let reached = cut.is_some();
    let cut = cut.unwrap_or(0).min((pairs - 1) / 2);
    HodgesLehmann {
        estimate: two_sample_location(x, y),
        ci_low: difference_order_statistic(x, y, cut + 1),
        ci_high: difference_order_statistic(x, y, pairs - cut),
        conf_level: LEVEL,
        level_reached: reached,
    }
}

/// The smallest double in [low, high] for which a monotone predicate holds; it holds at `high`.
fn smallest_with(low: f64, high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    // Doubles in numeric order are integers in order once negatives are flipped.
    let to_key = |value: f64| {
        let bits = (value + 0.0).to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    let from_key =
        |key: i64| f64::from_bits(if key < 0 { (i64::MIN - key) as u64 } else { key as u64 });
    let (mut below, mut at) = (i128::from(to_key(low)) - 1, i128::from(to_key(high)));
    while at - below > 1 {
        let middle = (below + at) / 2;
        // i128 division rounds to zero; the loop only needs below < middle < at.
        let middle = middle.clamp(below + 1, at - 1);
        if holds(from_key(middle as i64)) { at = middle } else { below = middle }
    }
    from_key(at as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_statistics_are_those_of_the_list() {
        let sample = [-3.5, -1.0, -1.0, 0.0, 0.25, 2.0, 7.5];
        let mut walsh: Vec<f64> = (0..sample.len())
            .flat_map(|i| (i..sample.len()).map(move |j| (i, j)))
            .map(|(i, j)| 0.5 * (sample[i] + sample[j]))
            .collect();
        walsh.sort_by(f64::total_cmp);
        for (k, &value) in walsh.iter().enumerate() {
            assert_eq!(walsh_order_statistic(&sample, k as u64 + 1), value);
        }
        let y = [-2.0, 0.5, 0.5, 3.0];
        let mut differences: Vec<f64> =
            sample.iter().flat_map(|x| y.iter().map(move |y| x - y)).collect();
        differences.sort_by(f64::total_cmp);
        for (k, &value) in differences.iter().enumerate() {
            assert_eq!(difference_order_statistic(&sample, &y, k as u64 + 1), value);
        }
    }

    #[test]
    fn few_differences_say_that_the_level_is_not_reached() {
        assert!(!one_sample_interval(&[1.0, 2.0, 3.0, 4.0, 5.0]).level_reached);
        assert!(one_sample_interval(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).level_reached);
    }
}
