//! `lsts` and `thin-shell-only`: squared marker error and thin shell, |Dc - d|^2 / l^2 + kappa alpha
//! c^T H c / tau (thesis eq. 5.28, normalised), within bounds or without.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, FREE, Quadratic, Setup, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// Weights within 0 and 1.
pub(crate) const LSTS: Definition = Definition {
    summary: "squared marker error and thin shell, weights within 0 and 1",
    needs: Needs::Shapes,
    uses: &[
        Group::Balance,
        Group::PriorWeight,
        Group::ThinShell,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults { alpha: 0.3, ..Defaults::USUAL },
    engine: |setup| within(setup, setup.bounds(UNIT_INTERVAL)),
};

/// Weights without bounds.
pub(crate) const THIN_SHELL_ONLY: Definition = Definition {
    summary: "squared marker error and thin shell, weights without bounds",
    needs: Needs::Shapes,
    uses: &[
        Group::Balance,
        Group::PriorWeight,
        Group::ThinShell,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: |setup| within(setup, setup.bounds(FREE)),
};

fn within(setup: &Setup<'_>, bounds: Vec<[f64; 2]>) -> Result<Engine, FitError> {
    let shell_weight = setup.spec.kappa() * setup.spec.alpha() / setup.shell_scale;
    let prior = setup.shell.iter().map(|h| shell_weight * h).collect();
    Ok(Engine::Quadratic(Quadratic::new(setup.data_weight(), prior, bounds)))
}
