//! Shares of each rating at each level of the one factor: as the model has them for random effects of 0, and as they
//! were given.

use super::cumulative::Thresholds;
use super::result::MixedShares;
use super::search::Fit;
use crate::outcome::Labelled;
use crate::table::factor::Factor;

/// Of each level of a factor. The ratings are some of `steps`, which ascend; the coefficients are those of the levels
/// against the first one.
///
/// The model's shares are P(y = j) = logistic(θ_j - β) - logistic(θ_(j-1) - β). Averaged over people and clips that
/// differ, shares are more even than those of the average person and clip: the two are not the same numbers.
pub(super) fn of_levels(
    factor: &Factor,
    rating: &[f64],
    steps: &[f64],
    found: &Fit,
) -> Labelled<MixedShares> {
    let thresholds = Thresholds::new(found.thresholds.clone());
    let of_level = |level: usize| {
        let eta = level.checked_sub(1).map_or(0.0, |place| found.coefficients[place]);
        let model = (0..steps.len())
            .map(|category| libm::exp(-thresholds.curvature(category, eta).minus_ln_p))
            .collect();
        let mut counts = vec![0.0; steps.len()];
        for (value, _) in rating.iter().zip(&factor.codes).filter(|(_, own)| **own == level as u32)
        {
            counts[steps.partition_point(|step| step < value)] += 1.0;
        }
        let all: f64 = counts.iter().sum();
        MixedShares { model, observed: counts.iter().map(|count| count / all).collect() }
    };
    Labelled::zip(&factor.levels, (0..factor.levels.len()).map(of_level))
}
