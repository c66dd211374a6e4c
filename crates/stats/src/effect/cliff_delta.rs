//! Cliff's delta of two independent groups.

use crate::distributions::tail::normal_quantile_upper;
use crate::effect::{EffectSize, EffectSizeKind};

/// Cliff's delta P(a > b) - P(a < b), which is the rank-biserial correlation of the Mann-Whitney test, with Feng and
/// Cliff's asymmetric interval (2004, Journal of Modern Applied Statistical Methods 3, equation 8, on the unbiased
/// variance of Cliff 1993, equation 5). Where no value of one group is in the range of the other, that variance is 0 and
/// one end is (n - z²) / (n + z²) of the smaller group's n, the other 1 (Cliff 1996, p. 141).
///
/// NaN is missing. `None` if a group has fewer than two values.
pub fn cliff_delta(a: &[f64], b: &[f64]) -> Option<EffectSize> {
    let sorted = |values: &[f64]| {
        let mut values: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        values.sort_unstable_by(f64::total_cmp);
        values
    };
    let (a, b) = (sorted(a), sorted(b));
    if a.len() < 2 || b.len() < 2 {
        return None;
    }
    let (m, n) = (a.len() as f64, b.len() as f64);
    let (of_a, tied) = dominances(&a, &b);
    let (of_b, _) = dominances(&b, &a);
    let delta = of_a.iter().sum::<f64>() / m;
    let squares = |own: &[f64], mean: f64| own.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
    // Sum over all pairs of (d_ij - delta)², each d_ij being -1, 0 or 1.
    let of_pairs = m * n - tied - m * n * delta * delta;
    let variance = (n * n * squares(&of_a, delta) + m * m * squares(&of_b, -delta) - of_pairs)
        / (m * n * (m - 1.0) * (n - 1.0));
    // Cliff 1993: the unbiased estimate can be negative; this is its least value.
    let variance = variance.max((1.0 - delta * delta) / (m * n - 1.0));
    let z = normal_quantile_upper(0.025);
    let interval = if delta.abs() >= 1.0 {
        let fewest = m.min(n);
        let end = (fewest - z * z) / (fewest + z * z);
        if delta > 0.0 { [end, 1.0] } else { [-1.0, -end] }
    } else {
        let rest = 1.0 - delta * delta;
        let reach = z * variance.sqrt() * (rest * rest + z * z * variance).sqrt();
        let scale = rest + z * z * variance;
        let centre = delta - delta.powi(3);
        [((centre - reach) / scale).max(-1.0), ((centre + reach) / scale).min(1.0)]
    };
    Some(EffectSize {
        kind: EffectSizeKind::CliffDelta,
        estimate: delta,
        interval_95: Some(interval),
        n: a.len() + b.len(),
    })
}

/// Of each of `own`, the share of `others` below it less the share above it; and the number of equal pairs. Both sorted.
fn dominances(own: &[f64], others: &[f64]) -> (Vec<f64>, f64) {
    let mut tied = 0.0;
    let of = own.iter().map(|value| {
        let below = others.partition_point(|other| other < value);
        let not_above = others.partition_point(|other| other <= value);
        tied += (not_above - below) as f64;
        (below as f64 - (others.len() - not_above) as f64) / others.len() as f64
    });
    let of = of.collect();
    (of, tied)
}
