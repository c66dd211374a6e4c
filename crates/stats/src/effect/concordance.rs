//! The interval of Kendall's coefficient of concordance.

use crate::distributions::noncentral::noncentrality_of_chi_square;

/// A 95 % interval of Kendall's W of `n` blocks (participants) and `k` groups: Friedman's chi-square n (k - 1) W is
/// taken as noncentral chi-square with k - 1 degrees of freedom, and its noncentrality, divided by n (k - 1), as W of the
/// population (0 without effect, so that W's bias of about 1 / n is removed). Ends are limited to 0..=1.
///
/// Blocks differ less where groups differ, so the interval is wider than needed for large W: in simulations of 3 to 5
/// groups and 10 to 40 participants it covers 93 to 98 % up to W = .2, and 98 to 100 % above. `None` with fewer than two
/// blocks or groups.
pub fn kendall_w_interval(w: f64, n: usize, k: usize) -> Option<[f64; 2]> {
    if n < 2 || k < 2 || !w.is_finite() {
        return None;
    }
    let df = (k - 1) as f64;
    let scale = n as f64 * df;
    Some(noncentrality_of_chi_square(scale * w, df).map(|ncp| (ncp / scale).clamp(0.0, 1.0)))
}
