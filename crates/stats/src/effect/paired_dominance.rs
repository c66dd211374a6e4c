//! Dominance within pairs: an effect size of paired differences in which zeros count.

use crate::distributions::tail::normal_quantile_upper;
use crate::effect::{EffectSize, EffectSizeKind};
use crate::table::pairs::rounded;

/// Cliff's d_w: the share of pairs with a positive difference less the share with a negative one, out of all pairs
/// (Cliff 1993, Psychological Bulletin 114, p. 500). Where 35 % of pairs rise and 65 % do not differ it is .35, while the
/// matched rank-biserial correlation, which drops zeros, is 1. Differences are rounded to 9 decimals, as for the signed
/// rank test.
///
/// The interval is Bonett and Price's for a difference of paired proportions (2012, Journal of Educational and Behavioral
/// Statistics 37, equation 3): one is added to both counts, two to the number of pairs. NaN is missing. `None` without
/// pairs.
///
/// ```
/// let found = mimique_stats::paired_dominance(&[1.0, 0.0, 0.0, 2.0, -1.0]).unwrap();
/// assert!((found.estimate - 0.2).abs() < 1e-12);
/// ```
pub fn paired_dominance(differences: &[f64]) -> Option<EffectSize> {
    let given = differences.iter().copied().filter(|d| d.is_finite()).map(rounded);
    let (mut up, mut down, mut n) = (0.0, 0.0, 0);
    for difference in given {
        n += 1;
        up += f64::from(u8::from(difference > 0.0));
        down += f64::from(u8::from(difference < 0.0));
    }
    if n == 0 {
        return None;
    }
    let pairs = n as f64;
    let [plus, minus] = [up, down].map(|count| (count + 1.0) / (pairs + 2.0));
    let centre = plus - minus;
    let error = ((plus + minus - centre * centre) / (pairs + 2.0)).sqrt();
    let reach = normal_quantile_upper(0.025) * error;
    Some(EffectSize {
        kind: EffectSizeKind::PairedDominance,
        estimate: (up - down) / pairs,
        interval_95: Some([(centre - reach).max(-1.0), (centre + reach).min(1.0)]),
        n,
    })
}
