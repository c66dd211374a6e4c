//! What gives the gaze of a take.

use mimique_avatar::{GazeAngles, GazeShapes};
use mimique_mocap::WeightsTable;
use serde_json::{Value, json};

use super::GazeTrack;
use crate::SolveError;

/// What gives the gaze of a take.
#[derive(Debug, Clone, PartialEq)]
pub enum GivenGaze {
    /// The same gaze throughout.
    Held(GazeAngles),
    /// A gaze over the seconds of the take.
    Track(GazeTrack),
    /// A marker of the capture at what is looked at (a target, or an eye tracker's point of gaze): both eyes
    /// turn to it.
    Target(String),
}

impl GivenGaze {
    /// The weights of the shapes that turn the eyes at some seconds of the take, a row each; none where a marker
    /// tells the gaze.
    pub(crate) fn weights(
        &self,
        shapes: &GazeShapes,
        seconds: impl Iterator<Item = f64>,
    ) -> Option<Vec<f64>> {
        match self {
            Self::Held(gaze) => Some(seconds.flat_map(|_| shapes.weights(*gaze)).collect()),
            Self::Track(track) => {
                Some(seconds.flat_map(|second| shapes.weights(track.at(second))).collect())
            }
            Self::Target(_) => None,
        }
    }

    /// Puts the gaze in the place of the one that was recorded; `table` has an avatar's shapes.
    ///
    /// # Errors
    /// [`SolveError`]: an avatar whose eyes do not turn, a marker that recorded weights do not have.
    pub(crate) fn put_into(&self, table: &mut WeightsTable) -> Result<(), SolveError> {
        let shapes = GazeShapes::of(&table.shape_names);
        if shapes.is_empty() {
            return Err(SolveError::NoGazeShapes);
        }
        let first = table.times.first().copied().unwrap_or_default();
        let seconds = table.times.iter().map(|time| time - first);
        let weights = self.weights(&shapes, seconds).ok_or_else(|| SolveError::NoGazeTarget {
            label: if let Self::Target(label) = self { label.clone() } else { String::new() },
            capture: "weights and no markers".to_owned(),
        })?;
        let columns = shapes.shapes();
        let rows = table.weights.chunks_exact_mut(table.shape_names.len());
        for (row, own) in rows.zip(weights.chunks_exact(columns.len())) {
            columns.iter().zip(own).for_each(|(&shape, &weight)| row[shape] = weight);
        }
        Ok(())
    }

    /// What provenance knows it by.
    pub(crate) fn key(&self) -> Value {
        let angles = |g: &GazeAngles| json!([g.azimuth, g.elevation, g.vergence]);
        match self {
            Self::Held(gaze) => json!({ "held": angles(gaze) }),
            Self::Track(track) => json!({
                "seconds": track.seconds(),
                "angles": track.angles().iter().map(angles).collect::<Vec<_>>(),
            }),
            Self::Target(label) => json!({ "target": label }),
        }
    }
}
