//! Intervals of a proportion.

use serde::Serialize;

use crate::distributions::tail::{beta_quantile, normal_quantile_upper};

/// A proportion with its intervals at 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Proportion {
    /// Successes.
    pub successes: u64,
    /// Trials.
    pub n: u64,
    /// successes / n; none without trials.
    pub proportion: Option<f64>,
    /// Wilson 1927.
    pub wilson: Option<[f64; 2]>,
    /// Clopper and Pearson 1934.
    pub clopper_pearson: Option<[f64; 2]>,
}

/// A proportion and its intervals.
pub fn proportion(successes: u64, n: u64) -> Proportion {
    let defined = n > 0;
    Proportion {
        successes,
        n,
        proportion: defined.then(|| successes as f64 / n as f64),
        wilson: defined.then(|| wilson(successes, n)),
        clopper_pearson: defined.then(|| clopper_pearson(successes, n)),
    }
}

fn wilson(successes: u64, n: u64) -> [f64; 2] {
    let (n, z) = (n as f64, normal_quantile_upper(0.025));
    let p = successes as f64 / n;
    let shrink = 1.0 + z * z / n;
    let centre = (p + z * z / (2.0 * n)) / shrink;
    let reach = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt() / shrink;
    [(centre - reach).max(0.0), (centre + reach).min(1.0)]
}

fn clopper_pearson(successes: u64, n: u64) -> [f64; 2] {
    let (k, rest) = (successes as f64, (n - successes) as f64);
    [
        if successes == 0 { 0.0 } else { beta_quantile(0.025, k, rest + 1.0) },
        if successes == n { 1.0 } else { beta_quantile(0.975, k + 1.0, rest) },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P(X <= k) of a binomial variable, summed.
    fn binomial_cdf(k: u64, n: u64, p: f64) -> f64 {
        let choose = |k: u64| (1..=k).map(|i| (n - k + i) as f64 / i as f64).product::<f64>();
        (0..=k).map(|i| choose(i) * p.powi(i as i32) * (1.0 - p).powi((n - i) as i32)).sum()
    }

    #[test]
    fn clopper_pearson_ends_leave_a_fortieth_on_each_side() {
        for (k, n) in [(1, 10), (7, 12), (29, 60)] {
            let [low, high] = proportion(k, n).clopper_pearson.unwrap();
            assert!((binomial_cdf(k, n, high) - 0.025).abs() < 1e-10);
            assert!((1.0 - binomial_cdf(k - 1, n, low) - 0.025).abs() < 1e-10);
        }
    }

    #[test]
    fn borders_stay_in_the_unit_interval() {
        assert_eq!(proportion(0, 5).wilson.unwrap()[0], 0.0);
        assert_eq!(proportion(5, 5).clopper_pearson.unwrap()[1], 1.0);
        assert!(proportion(0, 0).proportion.is_none());
    }
}
