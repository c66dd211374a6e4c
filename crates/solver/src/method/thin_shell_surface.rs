//! `thin-shell-surface`: the thin shell of the mesh itself with its marked vertices put where the markers
//! are (thesis eq. 2.16): moves vertices, not weights.

use super::definition::{Defaults, Definition, Needs};
use crate::energy::operators::OperatorParts;
use crate::fit::problem::FitError;
use crate::fit::setup::Engine;
use crate::parameters::group::Group;
use crate::surface::frame::{METRES_PER_WEIGHT, SurfaceProblem};

/// Its "shapes" are the markers, each along x, y and z.
pub(crate) const THIN_SHELL_SURFACE: Definition = Definition {
    summary: "thin shell of the mesh with its markers where they are seen; moves vertices",
    needs: Needs::Surface,
    uses: &[Group::ThinShell, Group::Surface, Group::Markers, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: |setup| {
        if !is_surface(setup.parts) {
            return Err(FitError::NoSurface);
        }
        let markers = setup.parts.marker_labels.len();
        let stiffness = setup.spec.stiffness();
        Ok(Engine::Surface(SurfaceProblem::new(&setup.parts.shell_gram, markers, stiffness)))
    },
};

/// Whether the "shapes" are the markers themselves, each along x, y and z.
fn is_surface(parts: &OperatorParts) -> bool {
    let n = 3 * parts.marker_labels.len();
    parts.shape_names.len() == n
        && (0..n * n).all(|at| {
            let expected = if at / n == at % n { METRES_PER_WEIGHT } else { 0.0 };
            parts.marker_deltas[at] == expected
        })
}
