//! Description of one sample: location, spread, quartiles (type 7), t interval of the mean.

use serde::Serialize;

use crate::outcome::Outcome;
use crate::tail::t_quantile_upper;

/// Result of [`describe`]. A field is none where it is not defined (spread of one value).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// Values.
    pub n: usize,
    /// Missing values.
    pub missing: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation with n - 1.
    pub sd: Option<f64>,
    /// Standard error of the mean.
    pub se: Option<f64>,
    /// 95 % t interval of the mean.
    pub mean_ci_t: Option<[f64; 2]>,
    /// Median.
    pub median: f64,
    /// Lower quartile, type 7 of Hyndman and Fan.
    pub q1: f64,
    /// Upper quartile, type 7.
    pub q3: f64,
    /// q3 - q1.
    pub iqr: f64,
    /// Median absolute deviation from the median, not scaled.
    pub mad_raw: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

/// Describes a sample; NaN is missing.
pub fn describe(values: &[f64]) -> Outcome<Description> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    let missing = values.len() - sorted.len();
    let n = sorted.len();
    if n == 0 {
        return Outcome::undefined(format!("no value is left, {missing} are missing"));
    }
    sorted.sort_unstable_by(f64::total_cmp);
    let (mean, variance) = moments(&sorted);
    let sd = variance.map(f64::sqrt);
    let se = sd.map(|sd| sd / (n as f64).sqrt());
    let median = quantile_sorted(&sorted, 0.5);
    let (q1, q3) = (quantile_sorted(&sorted, 0.25), quantile_sorted(&sorted, 0.75));
    let mut deviations: Vec<f64> = sorted.iter().map(|value| (value - median).abs()).collect();
    Outcome::Ok(Description {
        n,
        missing,
        mean,
        sd,
        se,
        mean_ci_t: se.map(|se| {
            let reach = t_quantile_upper(0.025, (n - 1) as f64) * se;
            [mean - reach, mean + reach]
        }),
        median,
        q1,
        q3,
        iqr: q3 - q1,
        mad_raw: self::median(&mut deviations),
        min: sorted[0],
        max: sorted[n - 1],
    })
}

/// Mean and variance (n - 1) in two passes about a shifted origin, so that a large mean costs no digits
/// (Chan, Golub and LeVeque 1983). The variance of one value is none.
pub fn moments(values: &[f64]) -> (f64, Option<f64>) {
    let n = values.len() as f64;
    let origin = values.first().copied().unwrap_or(0.0);
    let mean_shift = compensated_sum(values.iter().map(|value| value - origin)) / n;
    if values.len() < 2 {
        return (origin + mean_shift, None);
    }
    let deviations = || values.iter().map(|value| (value - origin) - mean_shift);
    let squares = compensated_sum(deviations().map(|deviation| deviation * deviation));
    let rest = compensated_sum(deviations());
    let variance = (squares - rest * rest / n) / (n - 1.0);
    (origin + mean_shift, Some(variance.max(0.0)))
}

/// Neumaier's sum: the rounding errors are carried along.
pub(crate) fn compensated_sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0f64);
    for value in values {
        let next = sum + value;
        lost += if sum.abs() >= value.abs() { (sum - next) + value } else { (value - next) + sum };
        sum = next;
    }
    sum + lost
}

/// Median; sorts its argument. Zero for no values.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    quantile_sorted(values, 0.5)
}

/// Quantile of ascending values by linear interpolation (type 7). Zero for no values.
pub fn quantile_sorted(sorted: &[f64], probability: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = probability * last as f64;
    let below = place.floor();
    let low = sorted[below as usize];
    let high = sorted[(below as usize + 1).min(last)];
    low + (place - below) * (high - low)
}
