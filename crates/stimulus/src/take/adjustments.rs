//! What a take's displacements are adjusted by: scale factors (Kouadio 5.3) and the depth of a
//! two-dimensional capture, as options and marker map ask for them.

use mimique_geometry::{DVec3, RigidMotion};
use mimique_solver::{
    FrontEnd, FrontEndError, MarkerFrames, MarkerScales, MethodSpec, Operators, bank_extents,
    motion_extents,
};
use serde_json::json;

use super::{JoinedTake, SolveError, TakeOptions};
use crate::provenance::Provenance;
use crate::{Depth, MarkerMap, ScaleRule};

impl JoinedTake<'_> {
    /// The factors of eq. 5.1: automatic, by hand and global, one after the other.
    pub(crate) fn scales(
        &self,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<Option<MarkerScales>, FrontEndError> {
        let rule = &self.scale;
        if rule.is_none() {
            return Ok(None);
        }
        let p = self.markers.len();
        let mut scales = match &rule.automatic {
            None => MarkerScales::ones(p),
            Some(frames) => {
                let width = 3 * self.labels.len();
                let positions = &self.positions[frames.start * width..frames.end * width];
                let take = MarkerFrames { positions, columns: self.labels.len() };
                let d = front_end.take_displacements(take, &poses[frames.clone()])?;
                let bounds: Vec<[f64; 2]> = (self.skin.shape_names.iter())
                    .map(|name| match spec.bounds.get(name) {
                        _ if spec.locked.contains(name) => [0.0, 0.0],
                        Some(&bounds) => bounds,
                        None => [0.0, 1.0],
                    })
                    .collect();
                let face = bank_extents(operators.parts(), &bounds);
                MarkerScales::automatic(&face, &motion_extents(&d, p))
            }
        };
        for (m, site) in self.markers.iter().enumerate() {
            let by_hand = rule.markers.get(&site.label);
            for factors in by_hand.into_iter().chain(&rule.global) {
                scales.times(m, DVec3::from_array(*factors));
            }
        }
        Ok(Some(scales))
    }

    /// Scale factors and depth, where the weights follow from them.
    pub(crate) fn adjustments(&self, provenance: Provenance) -> Provenance {
        let mut out = provenance;
        if self.depth == Depth::Surface {
            out = out.json("map.depth", "surface");
        }
        if let Some(frames) = &self.scale.automatic {
            out = out.json("map.scale.automatic", json!([frames.start, frames.end]));
        }
        if let Some(global) = &self.scale.global {
            out = out.json("map.scale.global", json!(global));
        }
        if !self.scale.markers.is_empty() {
            out = out.json("map.scale.markers", json!(self.scale.markers));
        }
        out
    }
}

/// The options' factors, and of each kind that they leave out the map's.
pub(crate) fn scale_rule(options: &TakeOptions, map: &MarkerMap) -> ScaleRule {
    let (first, second) = (&options.scale, &map.scale);
    let mut markers = second.markers.clone();
    markers.extend(first.markers.clone());
    ScaleRule {
        automatic: first.automatic.clone().or_else(|| second.automatic.clone()),
        global: first.global.or(second.global),
        markers,
    }
}

/// A capture whose third coordinate never changes was made with one camera.
pub(crate) fn refuse_flat(positions: &[f64]) -> Result<(), SolveError> {
    let mut seen = positions.chunks_exact(3).map(|p| p[2]).filter(|z| z.is_finite());
    match seen.next() {
        Some(z) if seen.all(|other| other == z) => Err(SolveError::Flat { z_mm: 1e3 * z }),
        _ => Ok(()),
    }
}
