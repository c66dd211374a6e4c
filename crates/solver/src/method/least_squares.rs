//! `box`, `nnls` and `pseudo-inverse`: least squares |Dc - d|^2 without a prior: bounded, non-negative,
//! free.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, NOT_NEGATIVE, Quadratic, Setup, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// Weights within 0 and 1: the plain baseline.
pub(crate) const BOX: Definition = Definition {
    summary: "squared marker error, weights within 0 and 1",
    needs: Needs::Shapes,
    uses: &[Group::Bounds, Group::Shapes, Group::Markers, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: |setup| within(setup, setup.bounds(UNIT_INTERVAL)),
};

/// Weights of 0 or more.
pub(crate) const NNLS: Definition = Definition {
    summary: "squared marker error, weights of 0 or more",
    needs: Needs::Shapes,
    uses: &[Group::Shapes, Group::Markers, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: |setup| within(setup, setup.bounds(NOT_NEGATIVE)),
};

/// c = D^+ d: the least of the free weights that fit best.
pub(crate) const PSEUDO_INVERSE: Definition = Definition {
    summary: "squared marker error, weights without bounds",
    needs: Needs::Shapes,
    uses: &[Group::Shapes, Group::Markers, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: |_| Ok(Engine::PseudoInverse),
};

/// The scale of the data changes no minimiser; with it the matrix is near 1 in any unit.
fn within(setup: &Setup<'_>, bounds: Vec<[f64; 2]>) -> Result<Engine, FitError> {
    let prior = vec![0.0; bounds.len() * bounds.len()];
    Ok(Engine::Quadratic(Quadratic::new(setup.data_weight(), prior, bounds)))
}
