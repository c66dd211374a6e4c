//! `lsts-soft` and `bounds-only`: squared marker error and soft bounds (thesis eq. 5.24), with the thin
//! shell or without.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::setup::Setup;
use crate::newton::objective::Term;
use crate::parameters::group::Group;

/// The thesis's energies normalised.
pub(crate) const LSTS_SOFT: Definition = Definition {
    summary: "squared marker error, thin shell and soft bounds, normalised",
    needs: Needs::Shapes,
    uses: &[
        Group::Balance,
        Group::PriorWeight,
        Group::ThinShell,
        Group::SoftBounds,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: |setup| {
        let (alpha, kappa) = (setup.spec.alpha(), setup.spec.kappa());
        let shell = Term::Squared { weight: kappa * alpha / setup.shell_scale };
        Ok(setup.smooth(squared(setup), shell, kappa * (1.0 - alpha) / setup.shapes()))
    },
};

/// Data and soft bounds alone.
pub(crate) const BOUNDS_ONLY: Definition = Definition {
    summary: "squared marker error and soft bounds, without the thin shell",
    needs: Needs::Shapes,
    uses: &[
        Group::BoundsWeight,
        Group::SoftBounds,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: |setup| Ok(setup.smooth(squared(setup), Term::Absent, setup.spec.bounds_weight())),
};

fn squared(setup: &Setup<'_>) -> Term {
    Term::Squared { weight: setup.data_weight() }
}
