//! `lsts-norm` and `lsts-short`: the norm of the marker error, not its square, with thin shell and soft
//! bounds: eq. 5.30 of the thesis and eq. 5 of the short paper, normalised by l and tau.

use super::definition::{Defaults, Definition, Needs};
use crate::newton::objective::Term;
use crate::parameters::group::Group;

const USES: &[Group] = &[
    Group::Balance,
    Group::Norms,
    Group::ThinShell,
    Group::SoftBounds,
    Group::Bounds,
    Group::Shapes,
    Group::Markers,
    Group::FrontEnd,
    Group::Frames,
];

/// Eq. 5.30 of the thesis: the thin shell squared.
pub(crate) const LSTS_NORM: Definition = Definition {
    summary: "norm of the marker error, squared thin shell and soft bounds (eq. 5.30, normalised)",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults::USUAL,
    engine: |setup| {
        let (alpha, length) = (setup.spec.alpha(), setup.length());
        Ok(setup.smooth(
            Term::Norm { weight: 1.0 / length, eps: setup.spec.eps() * length },
            Term::Squared { weight: alpha / setup.shell_scale },
            (1.0 - alpha) / setup.shapes(),
        ))
    },
};

/// Eq. 5 of the short paper: the norm of the thin shell, too.
pub(crate) const LSTS_SHORT: Definition = Definition {
    summary: "norms of marker error and thin shell, and soft bounds (short paper, eq. 5, normalised)",
    needs: Needs::Shapes,
    uses: USES,
    defaults: Defaults { eps: 1e-4, ..Defaults::USUAL },
    engine: |setup| {
        let (alpha, length) = (setup.spec.alpha(), setup.length());
        Ok(setup.smooth(
            Term::Norm { weight: 1.0 / length, eps: setup.spec.eps() * length },
            Term::Norm { weight: alpha / setup.shell_scale.sqrt(), eps: setup.spec.eps() * length },
            (1.0 - alpha) / setup.shapes(),
        ))
    },
};
