//! A method and its parameters as people write them: in the study file, on the command line.

use serde::{Deserialize, Serialize};

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

/// A method with its parameters; what is absent takes the method's default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MethodSpec {
    /// Which method.
    pub method: Method,
    /// Weight of the thin shell against the bounds, 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
    /// Overall weight of the priors against the data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kappa: Option<f64>,
}
