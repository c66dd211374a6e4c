//! The range-of-motion take that `regression` learns from: markers with known weights.

use std::ops::Range;

use mimique_geometry::coordinates;
use mimique_mocap::{Capture, WeightsTable};
use mimique_solver::{
    Inference, MethodSpec, Operators, Regression, TrainingError, TrainingOptions,
};
use serde_json::json;

use super::{JoinedTake, SolveError};
use crate::TakeWarning;
use crate::provenance::Provenance;
use crate::warning::some;

/// A take with the weights that were played in it, a row per frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Training {
    /// The markers.
    pub capture: Capture,
    /// The weights, under names that the avatar's are found by.
    pub weights: WeightsTable,
    /// Frames of the neutral face; the first 60 where not given.
    pub neutral: Option<Range<usize>>,
    /// Labels of the head markers; those of the take to be solved where not given.
    pub head: Option<Vec<String>>,
}

impl Training {
    /// A hash of everything in it.
    pub fn key(&self) -> String {
        Provenance::default()
            .numbers("positions", coordinates(&self.capture.positions))
            .json("rateHz", self.capture.rate_hz)
            .json("unitMetres", self.capture.unit.metres())
            .json("labels", self.capture.labels.clone())
            .numbers("weights", &self.weights.weights)
            .json("shapes", self.weights.shape_names.clone())
            .json("neutral", json!(self.neutral.as_ref().map(|n| [n.start, n.end])))
            .json("head", json!(self.head))
            .hash()
    }

    /// What should be said of the weights' names against an avatar's shapes.
    pub fn warnings(&self, shape_names: &[String]) -> Vec<TakeWarning> {
        let map = mimique_avatar::map_shapes(shape_names, &self.weights.shape_names);
        let mut out = Vec::new();
        let unused: Vec<String> =
            map.unused.iter().map(|&c| self.weights.shape_names[c].clone()).collect();
        if !unused.is_empty() {
            out.push(TakeWarning::TrainingUnused { shapes: unused });
        }
        let unlearnt: Vec<String> = (shape_names.iter().zip(&map.terms))
            .filter(|(_, terms)| terms.is_empty())
            .map(|(name, _)| name.clone())
            .collect();
        if !unlearnt.is_empty() {
            out.push(TakeWarning::TrainingUnlearnt { shapes: unlearnt });
        }
        out
    }

    /// Learns for the markers and shapes of a take that is to be solved; `bank` are its operators.
    ///
    /// # Errors
    /// [`SolveError`]: markers or frames that differ, a head or neutral that cannot be found, too
    /// little to learn from.
    pub fn learn(
        &self,
        joined: &JoinedTake<'_>,
        bank: &Operators,
        spec: &MethodSpec,
    ) -> Result<Regression, SolveError> {
        let frames = self.capture.frames();
        let rows = self.weights.frames.len();
        if frames != rows {
            return Err(TrainingError::Frames { inputs: frames, outputs: rows }.into());
        }
        let names = &bank.parts().shape_names;
        let map = mimique_avatar::map_shapes(names, &self.weights.shape_names);
        if map.terms.iter().all(Vec::is_empty) {
            return Err(SolveError::TrainingShapes {
                weights: some(self.weights.shape_names.iter().map(String::as_str)),
                avatar: some(names.iter().map(String::as_str)),
            });
        }
        let take =
            joined.of_other_capture(&self.capture, self.head.as_deref(), self.neutral.clone())?;
        let inputs = take.motion(bank, spec)?.displacements;
        let outputs: Vec<f64> = (0..rows)
            .flat_map(|row| {
                let row = self.weights.row(row);
                map.terms
                    .iter()
                    .map(move |terms| terms.iter().map(|&(c, share)| share * row[c]).sum())
            })
            .collect();
        let sparse = spec.inference() == Inference::Sparse;
        let options = TrainingOptions {
            capacity: sparse.then_some(spec.basis_vectors() as usize),
            given: [spec.length_scale, spec.signal, spec.noise],
        };
        let width = 3 * bank.marker_count();
        Ok(Regression::train(&inputs, width, &outputs, names.len(), &options)?)
    }
}
