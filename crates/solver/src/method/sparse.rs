//! `sparse`: few shapes at a time (Racković et al., "High-fidelity Interpretable Inverse Rig", arXiv
//! 2302.04820, its linear rig):
//!
//! |Dc - d|^2 / (2 l^2) + lambda 1^T c, weights within 0 and 1.
//!
//! The sum of weights that are not negative is their L1 norm: each shape has to earn its place. The paper
//! measures the data in the mesh's unit and goes from shape to shape, each at its best while the others
//! stay; here the data are divided by l^2, so that lambda has no unit, and the programme, which is
//! strictly convex, is solved by exchanging its active set: to the weights that going from shape to shape
//! comes near to. The default of lambda is where the planted take of ICT-FaceKit, with 0.1 mm of noise, has
//! its smallest vertex error.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::setup::{Engine, Quadratic, Setup, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// The sum of the weights beside the data.
pub(crate) const SPARSE: Definition = Definition {
    summary: "squared marker error and the sum of the weights, weights within 0 and 1",
    needs: Needs::Shapes,
    uses: &[
        Group::Sparsity,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: |setup| Ok(Engine::Quadratic(sparse(setup))),
};

/// |Dc - d|^2 / (2 l^2) + lambda 1^T c, 0 <= c <= 1.
pub(super) fn sparse(setup: &Setup<'_>) -> Quadratic {
    let bounds = setup.bounds(UNIT_INTERVAL);
    let prior = vec![0.0; bounds.len() * bounds.len()];
    Quadratic { linear: setup.spec.lambda(), ..Quadratic::new(setup.data_weight(), prior, bounds) }
}
