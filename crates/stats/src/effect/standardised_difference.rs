//! Cohen's d of paired differences.

use crate::distributions::noncentral::noncentrality_of_t;
use crate::effect::{EffectSize, EffectSizeKind};
use crate::summary::describe::moments;

/// Cohen's d_z: the mean of the differences divided by their standard deviation (n - 1), without Hedges's correction
/// (Cohen 1988, equation 2.3.5; Lakens 2013, equation 6). The interval pivots the noncentral t with n - 1 degrees of
/// freedom, t = d_z sqrt(n) (Cumming and Finch 2001), as `MBESS::ci.sm` and `effectsize::cohens_d` do.
///
/// NaN is missing. `None` for fewer than two differences, or if all are equal.
///
/// ```
/// let found = mimique_stats::standardised_difference(&[1.0, 2.0, 0.0, 3.0]).unwrap();
/// assert!((found.estimate - 1.5 / (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
/// ```
pub fn standardised_difference(differences: &[f64]) -> Option<EffectSize> {
    let given: Vec<f64> = differences.iter().copied().filter(|d| d.is_finite()).collect();
    let n = given.len();
    let (mean, variance) = moments(&given);
    let sd = variance?.sqrt();
    // Means that should be equal differ by 1e-16; a standard deviation of that size is none.
    let largest = given.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    if sd <= 1e-12 * largest || sd == 0.0 {
        return None;
    }
    let root = (n as f64).sqrt();
    let estimate = mean / sd;
    let interval = noncentrality_of_t(estimate * root, (n - 1) as f64).map(|end| end / root);
    Some(EffectSize { kind: EffectSizeKind::CohenDz, estimate, interval_95: Some(interval), n })
}
