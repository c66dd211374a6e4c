//! Kernels of the support vector machine.

use serde::{Deserialize, Serialize};

use crate::numbers::{dot, squared_distance};

/// How alike two rows are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Kernel {
    /// Their product.
    Linear,
    /// exp(-gamma d^2), d their distance.
    Rbf {
        /// One over the squared width.
        gamma: f64,
    },
}

impl Kernel {
    /// The kernel of two rows.
    pub fn of(self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            Self::Linear => dot(a, b),
            Self::Rbf { gamma } => libm::exp(-gamma * squared_distance(a, b)),
        }
    }
}
