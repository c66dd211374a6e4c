//! The face of a trial of reverse correlation: which units move when, drawn from seed and participant, and the weights
//! that show it on an avatar.
//!
//! The page draws it in a module of its own, the export draws it again and holds the weights against those that were
//! shown. Each trial has a stream of its own, `trajectories/STEP`, so that a face does not depend on the trials before.

use mimique_adaptive::{Trajectory, TrajectoryError, weights_of_units};
use mimique_solver::weights_hash;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::order::Draw;
use crate::study_file::ReverseCorrelationComponent;

/// Frames per second of a drawn face; the stage is linear between them.
const RATE_HZ: f64 = 60.0;

/// How an avatar shows the units of a block.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnitShapes {
    /// Number of the avatar's blendshapes.
    pub shapes: usize,
    /// Of each unit, in the block's order: places of the shapes that it moves, each with the weight of a whole activation.
    pub units: Vec<Vec<(usize, f64)>>,
}

/// The course of a unit as the export has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShownCourse {
    /// The unit: `AU12`.
    pub unit: String,
    /// Until then it rests, seconds from the first frame.
    pub onset_s: f64,
    /// When it is highest.
    pub peak_s: f64,
    /// From then on it rests.
    pub offset_s: f64,
    /// How high it is at its peak, above 0 to 1.
    pub amplitude: f64,
    /// Share of the rise at which half of the height is passed.
    pub acceleration: f64,
    /// Share of the fall at which half of the height is passed.
    pub deceleration: f64,
}

/// What a trial shows, as weights.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFace {
    /// Weights, frames x shapes.
    pub weights: Vec<f64>,
    /// Number of frames: the first is at 0 s, the last at the end.
    pub frames: usize,
    /// Frames per second.
    pub rate_hz: f64,
    /// SHA-256 of the weights, as those of every clip.
    pub weights_hash: String,
}

impl ReverseCorrelationComponent {
    /// What the trial of a step (`faces/12`) shows to a participant.
    ///
    /// # Errors
    /// [`TrajectoryError`]: what the check of a study refuses.
    pub fn trajectories(
        &self,
        step: &str,
        draw: Draw<'_>,
    ) -> Result<Vec<Trajectory>, TrajectoryError> {
        let mut stream = draw.stream(&["trajectories/", step].concat());
        self.design().draw(&mut || stream.unit())
    }

    /// The weights that show trajectories on an avatar.
    pub fn face(&self, shown: &[Trajectory], avatar: &UnitShapes) -> DrawnFace {
        let design = self.design();
        let activations = design.activations(shown, RATE_HZ);
        let weights = weights_of_units(&avatar.units, &activations, avatar.shapes);
        let hash = weights_hash(&weights);
        DrawnFace { weights, frames: design.frames(RATE_HZ), rate_hz: RATE_HZ, weights_hash: hash }
    }

    /// Trajectories with the names of their units.
    pub fn courses(&self, shown: &[Trajectory]) -> Vec<ShownCourse> {
        let named = |course: &Trajectory| ShownCourse {
            unit: self.units.get(course.unit).cloned().unwrap_or_default(),
            onset_s: course.onset_s,
            peak_s: course.peak_s,
            offset_s: course.offset_s,
            amplitude: course.amplitude,
            acceleration: course.acceleration,
            deceleration: course.deceleration,
        };
        shown.iter().map(named).collect()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn block() -> ReverseCorrelationComponent {
        let block = json!({
            "units": ["AU01", "AU06", "AU12", "AU26"], "trials": 10, "question": "emotion",
            "meanUnits": 2, "durationSeconds": 1.0
        });
        serde_json::from_value(block).unwrap()
    }

    fn draw(participant: u64) -> Draw<'static> {
        Draw { seed: 3, config_hash: "c", participant, condition: None }
    }

    #[test]
    fn a_trial_depends_on_its_own_step_and_participant_alone() {
        let block = block();
        let shown = block.trajectories("faces/7", draw(2)).unwrap();
        assert_eq!(shown, block.trajectories("faces/7", draw(2)).unwrap());
        assert_ne!(shown, block.trajectories("faces/8", draw(2)).unwrap());
        assert_ne!(shown, block.trajectories("faces/7", draw(3)).unwrap());
    }

    #[test]
    fn the_face_moves_the_shapes_of_its_units_and_begins_and_ends_at_rest() {
        let block = block();
        let avatar = UnitShapes {
            shapes: 5,
            units: vec![vec![(4, 0.5)], vec![(3, 1.0)], vec![(0, 1.0), (1, 1.0)], vec![(2, 1.0)]],
        };
        let mut moved = [false; 5];
        for trial in 1..50 {
            let shown = block.trajectories(&format!("faces/{trial}"), draw(1)).unwrap();
            let face = block.face(&shown, &avatar);
            assert_eq!((face.frames, face.weights.len()), (61, 61 * 5));
            assert!(face.weights[..5].iter().chain(&face.weights[300..]).all(|w| *w == 0.0));
            for frame in face.weights.chunks(5) {
                assert_eq!(frame[0], frame[1], "one unit moves both");
                for (moved, weight) in moved.iter_mut().zip(frame) {
                    *moved |= *weight > 0.0;
                }
            }
            assert_eq!(face.weights_hash, weights_hash(&face.weights));
        }
        assert_eq!(moved, [true; 5]);
    }

    #[test]
    fn courses_come_back_from_the_export_with_the_same_bits() {
        let block = block();
        let shown = block.trajectories("faces/1", draw(9)).unwrap();
        let courses = block.courses(&shown);
        let text = serde_json::to_string(&courses).unwrap();
        assert_eq!(serde_json::from_str::<Vec<ShownCourse>>(&text).unwrap(), courses);
        assert_eq!(courses[0].unit, block.units[shown[0].unit]);
    }
}
