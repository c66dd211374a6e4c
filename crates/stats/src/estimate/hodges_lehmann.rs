//! Hodges-Lehmann estimates and intervals: order statistics of Walsh averages (one sample) and of
//! pairwise differences (two samples), found without listing them.

use serde::Serialize;

use crate::distributions::order_statistic::{Pairs, two_from};
use crate::distributions::tail::normal_quantile_upper;
use crate::estimate::pairs::{Differences, WalshAverages, pairs_of};
use crate::ranks::signed_rank::toss_distribution;
use crate::ranks::tally::Tally;

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

/// Intervals of the location: from all differences, and as R of 2019 from those other than zero
/// (`nonzero` where there are any), whose p was exact or not.
pub(crate) fn intervals(
    all: &Tally,
    nonzero: Option<&Tally>,
    exact: bool,
) -> (HodgesLehmann, HodgesLehmann) {
    let cut = one_sample_cut(all.total(), LEVEL);
    let of_all = interval_of_walsh(all, cut, LEVEL);
    let thesis_cut = thesis_cut(nonzero.unwrap_or(all), exact);
    if nonzero.is_none() && thesis_cut == Some(cut) {
        return (of_all, of_all);
    }
    let mut thesis = interval_of_walsh(nonzero.unwrap_or(all), thesis_cut.unwrap_or(0), LEVEL);
    thesis.level_reached &= thesis_cut.is_some();
    (of_all, thesis)
}

/// The interval of the location at a level, from all differences.
pub(crate) fn one_sample_interval(all: &Tally, level: f64) -> HodgesLehmann {
    interval_of_walsh(all, one_sample_cut(all.total(), level), level)
}

/// Walsh averages to leave out at each end: the signed rank distribution without ties decides (exactly
/// up to 200 differences, normal beyond), which is conservative with ties.
fn one_sample_cut(n: u64, level: f64) -> u64 {
    if n <= 200 {
        return exact_cut(n, level);
    }
    let size = n as f64;
    let variance = size * (size + 1.0) * (2.0 * size + 1.0) / 24.0;
    let half = pairs_of(n) as f64 / 2.0;
    let reach = normal_quantile_upper((1.0 - level) / 2.0) * variance.sqrt() + 0.5;
    (half - reach).floor().max(0.0) as u64
}

/// The same as R of 2019: exact, or by inverting the normal test with continuity correction, whose
/// variance knows only ties that remain at every shift. None where so few cannot give the level.
fn thesis_cut(nonzero: &Tally, exact: bool) -> Option<u64> {
    let n = nonzero.total();
    if exact {
        return Some(exact_cut(n, LEVEL));
    }
    let size = n as f64;
    let variance = size * (size + 1.0) * (2.0 * size + 1.0) / 24.0 - nonzero.tie_term() / 48.0;
    let half = pairs_of(n) as f64 / 2.0;
    let reach = normal_quantile_upper((1.0 - LEVEL) / 2.0) * variance.max(0.0).sqrt() + 0.5;
    // W+ at a shift is the number of Walsh averages above it; the border is where it falls below
    // half + reach.
    let cut = (half - reach).floor();
    (cut >= 0.0).then_some(cut as u64)
}

/// How many Walsh averages to leave out at each end so that half of what the level leaves stays outside.
fn exact_cut(n: u64, level: f64) -> u64 {
    let ranks: Vec<u64> = (1..=n).collect();
    cut_of(toss_distribution(&ranks), level)
}

/// The quantile of (1 - level) / 2 of an integer distribution from 0, less one: with it as index from 1 the
/// interval begins.
pub(crate) fn cut_of(distribution: impl IntoIterator<Item = f64>, level: f64) -> u64 {
    let mut below = 0.0;
    let quantile = distribution
        .into_iter()
        .take_while(|probability| {
            below += probability;
            below <= (1.0 - level) / 2.0
        })
        .count() as u64;
    quantile.saturating_sub(1)
}

/// The interval between the (cut+1)-th smallest and (cut+1)-th largest Walsh averages.
fn interval_of_walsh(differences: &Tally, cut: u64, level: f64) -> HodgesLehmann {
    let walsh = WalshAverages::of(differences);
    let pairs = pairs_of(differences.total());
    let cut = cut.min((pairs - 1) / 2);
    let (estimate, ci_low, ci_high) = three(&walsh, pairs, cut);
    HodgesLehmann {
        estimate,
        ci_low,
        ci_high,
        conf_level: level,
        // Even the widest interval misses with probability 2 / 2^n.
        level_reached: 0.5f64.powi(differences.total().min(2000) as i32 - 1) <= 1.0 - level,
    }
}

/// Median of the pairwise differences x - y.
#[cfg(test)]
pub(super) fn two_sample_location(x: &Tally, y: &Tally) -> f64 {
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
fn three(values: &impl Pairs, pairs: u64, cut: u64) -> (f64, f64, f64) {
    let low = || two_from(values, cut + 1).0;
    let high = || two_from(values, pairs - cut).0;
    if pairs < 1 << 24 {
        return (middle_of(values, pairs), low(), high());
    }
    let (estimate, (low, high)) =
        rayon::join(|| middle_of(values, pairs), || rayon::join(low, high));
    (estimate, low, high)
}

fn middle_of(values: &impl Pairs, pairs: u64) -> f64 {
    let (low, high) = two_from(values, pairs.div_ceil(2));
    if pairs % 2 == 1 { low } else { 0.5 * (low + high) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_differences_say_that_the_level_is_not_reached() {
        let interval = |values: &[f64]| intervals(&Tally::of(values), None, true).0;
        assert!(!interval(&[1.0, 2.0, 3.0, 4.0, 5.0]).level_reached);
        assert!(interval(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).level_reached);
    }
}
