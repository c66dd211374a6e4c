//! `ridge`: the baseline that is regularised without a mesh (Cetinaslan and Orvalho 2020):
//!
//! |Dc - d|^2 / l^2 + kappa alpha |c|^2, weights within 0 and 1.
//!
//! It is `lsts` with the identity in the place of H, scaled to the same trace: c^T (tau I) c / tau =
//! |c|^2, so that the same kappa and alpha weigh the same amount of prior in both.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, Quadratic, Setup, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// Weights within 0 and 1, drawn to 0.
pub(crate) const RIDGE: Definition = Definition {
    summary: "squared marker error and squared weights, weights within 0 and 1",
    needs: Needs::Shapes,
    uses: &[
        Group::Balance,
        Group::PriorWeight,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults { alpha: 0.3, ..Defaults::USUAL },
    engine: ridge,
};

/// |Dc - d|^2 / l^2 + kappa alpha |c|^2, 0 <= c <= 1.
fn ridge(setup: &Setup<'_>) -> Result<Engine, FitError> {
    let bounds = setup.bounds(UNIT_INTERVAL);
    let n = bounds.len();
    let mut prior = vec![0.0; n * n];
    for x in prior.iter_mut().step_by(n + 1) {
        *x = setup.spec.kappa() * setup.spec.alpha();
    }
    Ok(Engine::Quadratic(Quadratic::new(setup.data_weight(), prior, bounds)))
}
