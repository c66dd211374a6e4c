//! `a2f` and `a2f-balanced`: the blendshape solver of NVIDIA's Audio2Face-3D SDK (MIT, 2025;
//! `blendshape_solver_base.cpp` and `blendshape_solver.cpp`):
//!
//! A = G + s L1^2/4 11^T + 10 s L2 I + 100 s T I + 10 s Y S^T S, b = g + s T c(t-1); A c = b within 0 and 1;
//! then the weaker of each pair that cancels is held at 0 and the rest is solved again.
//!
//! G and g are D^T D and D^T d, S has a row (1, -1) for the two sides of each movement, c(t-1) are the
//! weights of the frame before, 0 before the first. As shipped, the temporal term is lopsided: it weighs
//! 100 T in A and T in b, so that it draws to 0 what it is to hold to the last frame. `a2f-balanced` has
//! 100 T in both.
//!
//! **The scaling for markers.** The SDK sums G over the vertices of a mesh in centimetres, and s is the
//! square of the mesh's bounding-box diagonal over that of its template (54.7 cm), so that the terms
//! follow the size of the head; they do not follow the number of vertices, and markers are few. So D and
//! d are scaled until the mean diagonal entry of G, l^2 = tr(D^T D) / N, is what it is on a mesh at s = 1:
//! [`MESH_GRAM_CM2`]. s then has nothing left to do, and no unit, head size or number of markers changes a
//! weight.
//!
//! **Strengths.** L1 = 1, L2 = 3.5 and Y = 100 are the SDK's own defaults. Its default of T is 0, where the
//! two methods are one; 0.15 here is what a port of the SDK gives for one of its characters.
//!
//! **Pairs.** The SDK has a table of both kinds for each character; here they follow from names and from
//! how the shapes move the markers ([`super::shape_pairs`]).

use super::definition::{Defaults, Definition, Needs};
use super::shape_pairs::shape_pairs;
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, Quadratic, Setup, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// tr(G) / N of a mesh at s = 1, cm^2: 24,002 vertices, which the skin of the SDK's characters has, times
/// 0.0640 cm^2, the mean square by which a shape of ICT-FaceKit at weight 1 moves a vertex of its skin,
/// over (47.5 / 54.7)^2, the s of that skin.
const MESH_GRAM_CM2: f64 = 2030.0;

const USES: &[Group] = &[
    Group::Audio2Face,
    Group::Bounds,
    Group::Shapes,
    Group::Markers,
    Group::FrontEnd,
    Group::Frames,
];

/// The temporal term as shipped.
pub(crate) const A2F: Definition = Definition {
    summary: "squared marker error, size and sum of the weights, symmetry and the last frame, as in \
              Audio2Face-3D",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults::USUAL,
    engine: |setup| a2f(setup, 1.0),
};

/// The temporal term with 100 in both places.
pub(crate) const A2F_BALANCED: Definition = Definition {
    summary: "`a2f` with a temporal term that holds to the last frame and does not draw to 0",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults::USUAL,
    engine: |setup| a2f(setup, 100.0),
};

/// A - G and the weight of c(t-1), both over [`MESH_GRAM_CM2`]: G is over l^2. `last_frame` is what
/// multiplies T in b.
fn a2f(setup: &Setup<'_>, last_frame: f64) -> Result<Engine, FitError> {
    let spec = setup.spec;
    let bounds = setup.bounds(UNIT_INTERVAL);
    let n = bounds.len();
    let pairs = shape_pairs(setup);
    let sum = 0.25 * spec.l1() * spec.l1() / MESH_GRAM_CM2;
    let mut prior = vec![sum; n * n];
    for x in prior.iter_mut().step_by(n + 1) {
        *x += (10.0 * spec.l2() + 100.0 * spec.temporal()) / MESH_GRAM_CM2;
    }
    let symmetry = 10.0 * spec.symmetry() / MESH_GRAM_CM2;
    for [i, j] in pairs.symmetric {
        prior[i * n + i] += symmetry;
        prior[j * n + j] += symmetry;
        prior[i * n + j] -= symmetry;
        prior[j * n + i] -= symmetry;
    }
    Ok(Engine::Quadratic(Quadratic {
        last_frame: last_frame * spec.temporal() / MESH_GRAM_CM2,
        cancelling: pairs.cancelling,
        ..Quadratic::new(setup.data_weight(), prior, bounds)
    }))
}
