//! `kouadio`: bounded least squares over all points of the face that the markers move (Kouadio 1997, eq.
//! 4.3-4.11).

use super::definition::{Defaults, Definition, Needs};
use crate::fit::setup::{Engine, UNIT_INTERVAL};
use crate::parameters::group::Group;

/// Points, Gaussian zones or triangles.
pub(crate) const KOUADIO: Definition = Definition {
    summary: "squared error of the points that the markers move, weights within 0 and 1",
    needs: Needs::Shapes,
    uses: &[
        Group::Association,
        Group::Bounds,
        Group::Shapes,
        Group::Markers,
        Group::FrontEnd,
        Group::Frames,
    ],
    defaults: Defaults::USUAL,
    engine: |setup| Ok(Engine::Linked { bounds: setup.bounds(UNIT_INTERVAL) }),
};
