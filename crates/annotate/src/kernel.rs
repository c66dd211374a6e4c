//! Kernels of the support vector machine.

use mimique_solver::exp_all;
use serde::{Deserialize, Serialize};

use crate::numbers::{dots, squared_distances};

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
    /// The kernel of a row with each row of a table of the same width.
    pub(crate) fn of_all(self, rows: &[f64], row: &[f64], out: &mut [f64]) {
        match self {
            Self::Linear => dots(rows, row, out),
            Self::Rbf { gamma } => {
                squared_distances(rows, row, out);
                out.iter_mut().for_each(|d| *d *= -gamma);
                exp_all(out);
            }
        }
    }
}
