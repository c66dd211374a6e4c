//! Hodges-Lehmann estimates and intervals: order statistics of Walsh averages (one sample) and of
//! pairwise differences (two samples), found without listing them.

use serde::Serialize;

use crate::order_statistic::{Count, Pairs, two_from};
use crate::signed_rank::toss_distribution;
use crate::tail::normal_quantile_upper;
use crate::tally::Tally;

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
pub(crate) fn one_sample_location(differences: &Tally) -> f64 {
    middle_of(&WalshAverages::of(differences), pairs_of(differences.total()))
}

/// Interval of the location from the Walsh averages of all differences: the signed rank distribution
/// without ties decides how many to cut off (exactly up to 200 differences, normal beyond), which is
/// conservative with ties.
pub(crate) fn one_sample_interval(differences: &Tally) -> HodgesLehmann {
    let n = differences.total();
    let cut = if n <= 200 {
        exact_cut(n)
    } else {
        let size = n as f64;
        let variance = size * (size + 1.0) * (2.0 * size + 1.0) / 24.0;
        let half = pairs_of(n) as f64 / 2.0;
        (half - normal_quantile_upper((1.0 - LEVEL) / 2.0) * variance.sqrt() - 0.5).floor().max(0.0)
            as u64
    };
    interval_of_walsh(differences, cut)
}

/// Interval as R of 2019: exact, or by inverting the normal test with continuity correction, whose
/// variance knows only ties that remain at every shift.
pub(crate) fn thesis_interval(nonzero: &Tally, exact: bool) -> HodgesLehmann {
    let n = nonzero.total();
    if exact {
        return interval_of_walsh(nonzero, exact_cut(n));
    }
    let size = n as f64;
    let variance = size * (size + 1.0) * (2.0 * size + 1.0) / 24.0 - nonzero.tie_term() / 48.0;
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

fn pairs_of(n: u64) -> u64 {
    n * (n + 1) / 2
}

/// How many Walsh averages to leave out at each end so that 2.5 % stay outside.
fn exact_cut(n: u64) -> u64 {
    let ranks: Vec<u64> = (1..=n).collect();
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
fn interval_of_walsh(differences: &Tally, cut: u64) -> HodgesLehmann {
    let walsh = WalshAverages::of(differences);
    let pairs = pairs_of(differences.total());
    let cut = cut.min((pairs - 1) / 2);
    let (estimate, ci_low, ci_high) = three(&walsh, pairs, cut);
    HodgesLehmann {
        estimate,
        ci_low,
        ci_high,
        conf_level: LEVEL,
        // Even the widest interval misses with probability 2 / 2^n.
        level_reached: 0.5f64.powi(differences.total().min(2000) as i32 - 1) <= 1.0 - LEVEL,
    }
}

/// Median of the pairwise differences x - y.
#[cfg(test)]
fn two_sample_location(x: &Tally, y: &Tally) -> f64 {
    middle_of(&Differences::of(x, y), x.total() * y.total())
}

/// Interval between the (cut+1)-th smallest and largest pairwise differences.
pub(crate) fn two_sample_interval(x: &Tally, y: &Tally, cut: Option<u64>) -> HodgesLehmann {
    let pairs = x.total() * y.total();
    let level_reached = cut.is_some();
    let cut = cut.unwrap_or(0).min((pairs - 1) / 2);
    let (estimate, ci_low, ci_high) = three(&Differences::of(x, y), pairs, cut);
    HodgesLehmann { estimate, ci_low, ci_high, conf_level: LEVEL, level_reached }
}

/// Median, and the values that leave `cut` outside on each side. With many pairs the three are sought
/// at the same time.
fn three(values: &(impl Pairs + Sync), pairs: u64, cut: u64) -> (f64, f64, f64) {
    let low = || two_from(values, cut + 1).0;
    let high = || two_from(values, pairs - cut).0;
    if pairs < 1 << 32 {
        return (middle_of(values, pairs), low(), high());
    }
    std::thread::scope(|scope| {
        let beside = scope.spawn(|| (low(), high()));
        let estimate = middle_of(values, pairs);
        let (low, high) = beside.join().unwrap_or_else(|_| (low(), high()));
        (estimate, low, high)
    })
}

fn middle_of(values: &impl Pairs, pairs: u64) -> f64 {
    let (low, high) = two_from(values, pairs.div_ceil(2));
    if pairs % 2 == 1 { low } else { 0.5 * (low + high) }
}

/// Averages of a sample's values with each other and with themselves.
struct WalshAverages<'a> {
    values: &'a [f64],
    counts: &'a [u64],
    /// Values with repetition before each place.
    before: Vec<u64>,
}

impl<'a> WalshAverages<'a> {
    fn of(tally: &'a Tally) -> Self {
        Self { values: &tally.values, counts: &tally.counts, before: before(&tally.counts) }
    }
}

fn before(counts: &[u64]) -> Vec<u64> {
    let mut sum = 0;
    let mut before = Vec::with_capacity(counts.len() + 1);
    before.push(0);
    before.extend(counts.iter().map(|count| {
        sum += count;
        sum
    }));
    before
}

impl Pairs for WalshAverages<'_> {
    fn at_most(&self, limit: f64) -> Count {
        // As i grows, fewer j satisfy the limit.
        let mut count = Count::default();
        let mut end = self.values.len();
        for (i, &first) in self.values.iter().enumerate() {
            while end > i && 0.5 * (first + self.values[end - 1]) > limit {
                end -= 1;
            }
            if end <= i {
                break;
            }
            let own = self.counts[i];
            count.distinct += (end - i) as u64;
            count.pairs += own * (own + 1) / 2 + own * (self.before[end] - self.before[i + 1]);
        }
        count
    }

    fn between(&self, low: f64, high: f64, mut found: impl FnMut(f64, u64)) {
        let (mut start, mut end) = (self.values.len(), self.values.len());
        for (i, &first) in self.values.iter().enumerate() {
            let average = |j: usize| 0.5 * (first + self.values[j]);
            while end > i && average(end - 1) > high {
                end -= 1;
            }
            if end <= i {
                break;
            }
            while start > i && average(start - 1) > low {
                start -= 1;
            }
            for j in start.max(i)..end {
                let own = self.counts[i];
                let count = if i == j { own * (own + 1) / 2 } else { own * self.counts[j] };
                found(average(j), count);
            }
        }
    }

    fn range(&self) -> (f64, f64) {
        (self.values[0], self.values[self.values.len() - 1])
    }
}

/// Differences x - y of two samples.
struct Differences<'a> {
    x: &'a Tally,
    y: &'a Tally,
    y_before: Vec<u64>,
}

impl<'a> Differences<'a> {
    fn of(x: &'a Tally, y: &'a Tally) -> Self {
        Self { x, y, y_before: before(&y.counts) }
    }
}

impl Pairs for Differences<'_> {
    fn at_most(&self, limit: f64) -> Count {
        // As x grows, y must be larger.
        let (mut count, mut start) = (Count::default(), 0);
        let (ys, all) = (&self.y.values, self.y_before[self.y.values.len()]);
        for (&first, &own) in self.x.values.iter().zip(&self.x.counts) {
            while start < ys.len() && first - ys[start] > limit {
                start += 1;
            }
            count.distinct += (ys.len() - start) as u64;
            count.pairs += own * (all - self.y_before[start]);
        }
        count
    }

    fn between(&self, low: f64, high: f64, mut found: impl FnMut(f64, u64)) {
        let (mut start, mut end) = (0, 0);
        let ys = &self.y.values;
        for (&first, &own) in self.x.values.iter().zip(&self.x.counts) {
            while start < ys.len() && first - ys[start] > high {
                start += 1;
            }
            while end < ys.len() && first - ys[end] > low {
                end += 1;
            }
            for (&second, &count) in ys[start..end].iter().zip(&self.y.counts[start..end]) {
                found(first - second, own * count);
            }
        }
    }

    fn range(&self) -> (f64, f64) {
        let (x, y) = (&self.x.values, &self.y.values);
        (x[0] - y[y.len() - 1], x[x.len() - 1] - y[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pseudo_random(n: usize, levels: u64) -> Vec<f64> {
        let mut state = n as u64 ^ levels;
        (0..n)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                ((state >> 33) % levels) as f64 / 7.0 - levels as f64 / 20.0
            })
            .collect()
    }

    /// Each order statistic against the sorted list, for few and many pairs, with and without ties.
    #[test]
    fn order_statistics_are_those_of_the_list() {
        for (n, levels) in
            [(1, 3), (2, 3), (7, 4), (30, 5), (60, 1 << 30), (700, 900), (900, 1 << 30)]
        {
            let (sample, y) = (pseudo_random(n, levels), pseudo_random(n / 2 + 1, levels + 1));
            let mut walsh: Vec<f64> = (0..n)
                .flat_map(|i| (i..n).map(move |j| (i, j)))
                .map(|(i, j)| 0.5 * (sample[i] + sample[j]))
                .collect();
            walsh.sort_by(f64::total_cmp);
            let mut differences: Vec<f64> =
                sample.iter().flat_map(|x| y.iter().map(move |y| x - y)).collect();
            differences.sort_by(f64::total_cmp);
            let (x, y) = (Tally::of(&sample), Tally::of(&y));
            let (averages, shifts) = (WalshAverages::of(&x), Differences::of(&x, &y));
            let step = (walsh.len() / 97).max(1);
            for k in (0..walsh.len()).step_by(step).chain([walsh.len() - 1]) {
                let next = walsh[(k + 1).min(walsh.len() - 1)];
                assert_eq!(two_from(&averages, k as u64 + 1), (walsh[k], next), "{n} {levels} {k}");
            }
            for k in (0..differences.len()).step_by(step).chain([differences.len() - 1]) {
                let next = differences[(k + 1).min(differences.len() - 1)];
                assert_eq!(two_from(&shifts, k as u64 + 1), (differences[k], next), "{n} {k}");
            }
            let half = differences.len() / 2;
            let median = if differences.len() % 2 == 1 {
                differences[half]
            } else {
                0.5 * (differences[half - 1] + differences[half])
            };
            assert_eq!(two_sample_location(&x, &y), median);
        }
    }

    #[test]
    fn few_differences_say_that_the_level_is_not_reached() {
        let interval = |values: &[f64]| one_sample_interval(&Tally::of(values));
        assert!(!interval(&[1.0, 2.0, 3.0, 4.0, 5.0]).level_reached);
        assert!(interval(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).level_reached);
    }
}
