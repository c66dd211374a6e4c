//! `regression`: weights predicted by a Gaussian process that has learnt from a range-of-motion take with
//! known weights (thesis 3.3.1, eq. 3.2-3.4), put within their bounds.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// It counts every marker alike: the kernel standardises them.
pub(crate) const REGRESSION: Definition = Definition {
    summary: "nothing: a Gaussian process learnt from a range-of-motion take with known weights",
    needs: Needs::Training,
    uses: &[Group::GaussianProcess, Group::Bounds, Group::Shapes, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: |setup| {
        let model = setup.parts.regression.clone().ok_or(FitError::NotTrained)?;
        Ok(Engine::Learnt { model: Box::new(model), bounds: setup.bounds(UNIT_INTERVAL) })
    },
};
