//! `recorded`: weights of a file under the avatar's names. There is nothing to solve.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;

/// Weights read from a file.
pub(crate) const RECORDED: Definition = Definition {
    summary: "nothing: weights of a file under the avatar's names",
    needs: Needs::Weights,
    uses: &[],
    defaults: Defaults::USUAL,
    engine: |_| Err(FitError::Recorded),
};
