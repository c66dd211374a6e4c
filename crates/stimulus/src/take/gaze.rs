//! The gaze that is given for a take, as weights of the shapes that turn the eyes.

use std::ops::Range;

use mimique_avatar::{EyeAngles, GazeAngles, GazeShapes, VERGENCE_DEGREES};
use mimique_geometry::{Displacement, Point, RigidMotion};
use mimique_mocap::Capture;
use mimique_solver::FrontEnd;

use super::SolveError;
use super::joined::{JoinedTake, metres};
use crate::warning::some;
use crate::{AvatarSkin, GivenGaze, TakeWarning};

/// Half of the distance between the eyes where the avatar has no eyeballs, metres: half of the mean of adults, 63 mm
/// (Dodgson, Variation and extrema of human interpupillary distance, 2004).
const HALF_PUPILS_M: f64 = 0.0315;
/// The gaze is held at the limit of the shapes where it goes beyond it by more, degrees.
const BEYOND_DEG: f64 = 0.5;

/// The gaze of a take.
#[derive(Debug, Clone)]
pub(crate) struct JoinedGaze {
    given: GivenGaze,
    shapes: GazeShapes,
    /// Names of the shapes that turn the eyes.
    pub(crate) names: Vec<String>,
    /// Column of the marker that is looked at.
    target: Option<usize>,
}

impl JoinedGaze {
    pub(crate) fn given(&self) -> &GivenGaze {
        &self.given
    }
}

/// The shapes that turn the eyes as a gaze is given.
///
/// # Errors
/// [`SolveError`] where no shape turns them, or what is looked at is not in the capture.
pub(crate) fn given_gaze(
    skin: &AvatarSkin,
    capture: &Capture,
    given: &GivenGaze,
) -> Result<GazeShapes, SolveError> {
    let shapes = GazeShapes::of(&skin.shape_names);
    if shapes.is_empty() {
        return Err(SolveError::NoGazeShapes);
    }
    match given {
        GivenGaze::Target(label) if capture.marker_index(label).is_none() => {
            let capture = some(capture.labels.iter().map(String::as_str));
            Err(SolveError::NoGazeTarget { label: label.clone(), capture })
        }
        _ => Ok(shapes),
    }
}

impl JoinedTake<'_> {
    /// The given gaze; a marker that is looked at as a column after the others.
    pub(crate) fn add_gaze(
        &mut self,
        capture: &Capture,
        given: &GivenGaze,
    ) -> Result<(), SolveError> {
        let shapes = given_gaze(self.skin, capture, given)?;
        let names = shapes.shapes().into_iter().map(|k| self.skin.shape_names[k].clone()).collect();
        let mut target = None;
        if let GivenGaze::Target(label) = given {
            let column = self.labels.iter().position(|l| l == label).unwrap_or_else(|| {
                self.labels.push(label.clone());
                self.labels.len() - 1
            });
            target = Some(column);
            self.positions = metres(capture, &self.labels);
        }
        self.gaze = Some(JoinedGaze { given: given.clone(), shapes, names, target });
        Ok(())
    }

    /// Names of the shapes that turn the eyes and their weights in some frames, a row each; nothing where no gaze
    /// is given. `poses` hold the head still in all frames.
    pub(crate) fn gaze_tracks(
        &self,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
        frames: Range<usize>,
    ) -> (Vec<String>, Vec<f64>) {
        let Some(gaze) = &self.gaze else { return (Vec::new(), Vec::new()) };
        let seconds = frames.clone().map(|frame| frame as f64 / self.rate_hz);
        let weights = gaze.given.weights(&gaze.shapes, seconds).unwrap_or_else(|| {
            let looks = self.looks_at_target(gaze, front_end, poses);
            looks[frames].iter().flat_map(|&look| gaze.shapes.weights(look)).collect()
        });
        (gaze.names.clone(), weights)
    }

    /// Where both eyes look in every frame that a marker is looked at. While the marker is not seen, the eyes stay
    /// where they were.
    fn looks_at_target(
        &self,
        gaze: &JoinedGaze,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
    ) -> Vec<GazeAngles> {
        let eyes = self.skin.eyes.unwrap_or_else(|| {
            let middle = front_end_middle(front_end);
            [HALF_PUPILS_M, -HALF_PUPILS_M].map(|x| middle + Displacement::new(x, 0.0, 0.0))
        });
        let column = gaze.target.unwrap_or(0);
        let mut last = GazeAngles::default();
        let mut looks = Vec::with_capacity(poses.len());
        for (frame, pose) in poses.iter().enumerate() {
            let at = 3 * (frame * self.labels.len() + column);
            let p = &self.positions[at..at + 3];
            if p[0].is_finite() {
                let there =
                    front_end.avatar_from_actor().apply(pose.apply(Point::new(p[0], p[1], p[2])));
                let [left, right] = eyes.map(|eye| Some(direction(there - eye)));
                if let Some(look) = (EyeAngles { left, right }).gaze() {
                    let vergence = look.vergence.clamp(0.0, VERGENCE_DEGREES[1]);
                    last = GazeAngles { vergence, ..look };
                }
            }
            looks.push(last);
        }
        looks
    }

    /// What should be said where the given gaze goes beyond what the avatar's eyes turn by.
    pub(crate) fn gaze_beyond_eyes(&self) -> Option<TakeWarning> {
        let gaze = self.gaze.as_ref()?;
        let wanted: Vec<GazeAngles> = match &gaze.given {
            GivenGaze::Held(held) => vec![*held],
            GivenGaze::Track(track) => {
                (0..self.frame_count()).map(|f| track.at(f as f64 / self.rate_hz)).collect()
            }
            GivenGaze::Target(_) => return None,
        };
        let mut row = vec![0.0; self.skin.shape_names.len()];
        let mut is_beyond = |look: &&GazeAngles| {
            let weights = gaze.shapes.weights(**look);
            gaze.shapes.shapes().into_iter().zip(weights).for_each(|(k, weight)| row[k] = weight);
            let shown = gaze.shapes.eyes(&row).gaze().unwrap_or_default();
            (shown.azimuth - look.azimuth).abs() > BEYOND_DEG
                || (shown.elevation - look.elevation).abs() > BEYOND_DEG
        };
        let count = wanted.iter().filter(|look| is_beyond(look)).count();
        (count > 0).then_some(TakeWarning::GazeBeyondAvatar { frames: count, of: wanted.len() })
    }
}

/// Azimuth to the person's left and elevation of a direction, degrees.
fn direction(to: Displacement) -> [f64; 2] {
    let azimuth = libm::atan2(to.x, to.z);
    let elevation = libm::atan2(to.y, libm::hypot(to.x, to.z));
    [azimuth.to_degrees(), elevation.to_degrees()]
}

/// The middle of the face markers on the avatar: where its eyes are about, without eyeballs.
fn front_end_middle(front_end: &FrontEnd) -> Point {
    let laid = front_end.neutral().iter().map(|&p| front_end.avatar_from_actor().apply(p));
    mimique_geometry::centroid(laid)
}
