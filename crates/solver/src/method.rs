//! The methods: their names, and which parameters each of them uses.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::spec_check::SpecError;

/// The methods, by the names of the design notes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Squared data term, thin shell, exact bounds 0..1.
    Lsts,
    /// Squared data term, thin shell, soft bounds.
    LstsSoft,
    /// Eq. 5.30 of the thesis, normalised.
    LstsNorm,
    /// Eq. 5 of the short paper, normalised.
    LstsShort,
    /// Eq. 5.30 as printed, in its unit.
    ThesisLiteral,
    /// Eq. 5 of the short paper as printed, in its unit.
    ShortLiteral,
    /// Data and soft bounds alone.
    BoundsOnly,
    /// Data and thin shell alone.
    ThinShellOnly,
    /// Bounded least squares: the plain baseline.
    Box,
    /// Non-negative least squares.
    Nnls,
    /// Unbounded least squares.
    PseudoInverse,
    /// Kouadio 1997: Gaussian zones.
    Kouadio,
    /// The mesh moved by the thin shell, without shapes.
    ThinShellSurface,
    /// Learnt from a range-of-motion take.
    Regression,
    /// Weights read from a file.
    Recorded,
}

const SHELL: &[&str] = &["kS", "kB", "laplacian"];
const SOFT: &[&str] = &["softBounds", "s", "bounds"];
const COMMON: &[&str] = &["locked", "importance", "headLowpassHz"];

impl Method {
    /// Every method, in the order of the design notes.
    pub const ALL: [Method; 15] = [
        Method::Lsts,
        Method::LstsSoft,
        Method::LstsNorm,
        Method::LstsShort,
        Method::ThesisLiteral,
        Method::ShortLiteral,
        Method::BoundsOnly,
        Method::ThinShellOnly,
        Method::Box,
        Method::Nnls,
        Method::PseudoInverse,
        Method::Kouadio,
        Method::ThinShellSurface,
        Method::Regression,
        Method::Recorded,
    ];

    /// The name in study files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Method::Lsts => "lsts",
            Method::LstsSoft => "lsts-soft",
            Method::LstsNorm => "lsts-norm",
            Method::LstsShort => "lsts-short",
            Method::ThesisLiteral => "thesis-literal",
            Method::ShortLiteral => "short-literal",
            Method::BoundsOnly => "bounds-only",
            Method::ThinShellOnly => "thin-shell-only",
            Method::Box => "box",
            Method::Nnls => "nnls",
            Method::PseudoInverse => "pseudo-inverse",
            Method::Kouadio => "kouadio",
            Method::ThinShellSurface => "thin-shell-surface",
            Method::Regression => "regression",
            Method::Recorded => "recorded",
        }
    }

    /// The parameters that the method uses, by their JSON names.
    pub fn parameters(self) -> Vec<&'static str> {
        let groups: &[&[&str]] = match self {
            Method::Lsts => &[&["alpha", "kappa"], SHELL, &["bounds"], COMMON],
            Method::LstsSoft => &[&["alpha", "kappa"], SHELL, SOFT, COMMON],
            Method::LstsNorm | Method::LstsShort => &[&["alpha", "eps"], SHELL, SOFT, COMMON],
            Method::ThesisLiteral | Method::ShortLiteral => {
                &[&["alpha", "eps", "unit"], SHELL, SOFT, COMMON]
            }
            Method::BoundsOnly => &[&["boundsWeight"], SOFT, COMMON],
            Method::ThinShellOnly => &[&["alpha", "kappa"], SHELL, COMMON],
            Method::Box => &[&["bounds"], COMMON],
            Method::Nnls | Method::PseudoInverse => &[COMMON],
            Method::Kouadio => &[&["sigma", "bounds"], COMMON],
            Method::ThinShellSurface => {
                &[SHELL, &["stiffness", "hold", "importance", "headLowpassHz"]]
            }
            Method::Regression => &[
                &["inference", "basisVectors", "lengthScale", "signal", "noise"],
                &["bounds", "locked", "headLowpassHz"],
            ],
            Method::Recorded => &[],
        };
        groups.concat()
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Method {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Method, SpecError> {
        Method::ALL.into_iter().find(|m| m.name() == text).ok_or_else(|| SpecError {
            field: "method".into(),
            message: format!(
                "unknown method '{text}'; use one of {}",
                Method::ALL.map(Method::name).join(", ")
            ),
        })
    }
}
