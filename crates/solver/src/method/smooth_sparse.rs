//! `smooth-sparse`: `sparse` over a window of frames, with squared second differences in time (Racković et
//! al., "Refined Inverse Rigging", SIGGRAPH Asia 2024, arXiv 2401.16496, its linear rig):
//!
//! sum over frames t of |D c_t - d_t|^2 / (2 l^2) + lambda 1^T c_t + mu |c_(t-1) - 2 c_t + c_(t+1)|^2,
//! weights within 0 and 1.
//!
//! With the other shapes given, the course of one shape is a programme in a box whose matrix is
//! pentadiagonal; [`crate::fit::window`] goes from shape to shape until none moves, and says how windows
//! follow one another. mu weighs differences between frames: at twice the rate the same course has
//! second differences a quarter as large.

use super::definition::{Defaults, Definition, Needs};
use super::sparse::sparse;
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, Quadratic, Setup};
use crate::parameters::group::Group;

/// The sum of the weights and their second differences beside the data.
pub(crate) const SMOOTH_SPARSE: Definition = Definition {
    summary: "`sparse` over a window of frames, with squared second differences in time",
    needs: Needs::Shapes,
    uses: &[
        Group::Sparsity,
        Group::Smoothness,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: smooth_sparse,
};

/// The objective of a frame, and what its second differences weigh.
fn smooth_sparse(setup: &Setup<'_>) -> Result<Engine, FitError> {
    Ok(Engine::Quadratic(Quadratic { roughness: setup.spec.mu(), ..sparse(setup) }))
}
