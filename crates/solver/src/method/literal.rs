//! `thesis-literal` and `short-literal`: eq. 5.30 of the thesis and eq. 5 of the short paper as printed,
//! measured in the unit of their captures.

use super::definition::{Defaults, Definition, Needs};
use crate::newton::objective::Term;
use crate::parameters::group::Group;

const USES: &[Group] = &[
    Group::Balance,
    Group::Norms,
    Group::LiteralUnit,
    Group::ThinShell,
    Group::SoftBounds,
    Group::Bounds,
    Group::Shapes,
    Group::Markers,
    Group::FrontEnd,
    Group::Frames,
];

/// Eq. 5.30: E_b counts once for each of the 3S coordinates.
pub(crate) const THESIS_LITERAL: Definition = Definition {
    summary: "eq. 5.30 of the thesis as printed, in its unit",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults::USUAL,
    engine: |setup| {
        let (alpha, per_metre) = (setup.spec.alpha(), setup.spec.unit().per_metre());
        Ok(setup.smooth(
            Term::Norm { weight: per_metre, eps: setup.spec.eps() / per_metre },
            Term::Squared { weight: alpha * per_metre * per_metre },
            3.0 * setup.vertices() * (1.0 - alpha),
        ))
    },
};

/// Eq. 5 of the short paper.
pub(crate) const SHORT_LITERAL: Definition = Definition {
    summary: "eq. 5 of the short paper as printed, in its unit",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults { eps: 1e-6, ..Defaults::USUAL },
    engine: |setup| {
        let (alpha, per_metre) = (setup.spec.alpha(), setup.spec.unit().per_metre());
        let eps = setup.spec.eps() / per_metre;
        Ok(setup.smooth(
            Term::Norm { weight: per_metre, eps },
            Term::Norm { weight: alpha * per_metre, eps },
            1.0 - alpha,
        ))
    },
};
