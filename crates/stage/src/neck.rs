//! The neck: what the head turns about, by which weights, and how far down it takes the skin along.

use glam::{EulerRot, Mat3, Vec3};
use mimique_avatar::{Avatar, HEAD_POSE_SHAPES, HeadAngles};

use crate::framing::Landmarks;

/// From the middle of the eyes to what the head turns about, the joint of skull and spine, in units of the eyes'
/// distance (63 mm in adults): 75 mm below and 82 mm behind them (Yoganandan et al., Physical properties of the human
/// head, J. Biomechanics 42, 2009, for the occipital condyles).
const JOINT: Vec3 = Vec3::new(0.0, -1.2, -1.3);
/// How far below the chin the neck no longer turns, in units of the eyes' distance.
const NECK: f32 = 1.5;

/// The neck of a head.
pub(crate) struct Neck {
    /// Places of [`HEAD_POSE_SHAPES`]; none of an avatar whose head does not turn.
    shapes: Option<[usize; 3]>,
    /// What the head turns about, metres.
    pub pivot: Vec3,
    /// The height from which the head turns whole, and that below which nothing turns, metres.
    pub heights: [f32; 2],
}

impl Neck {
    pub fn of(avatar: &Avatar, landmarks: &Landmarks) -> Self {
        let [nod, turn, tilt] = HEAD_POSE_SHAPES.map(|name| avatar.shape_index(name));
        let shapes = nod.zip(turn).zip(tilt).map(|((nod, turn), tilt)| [nod, turn, tilt]);
        let (span, chin) = (landmarks.eye_span().max(1e-4), landmarks.chin[1]);
        Self {
            shapes,
            pivot: Vec3::from(landmarks.eyes_middle()) + JOINT * span,
            heights: [chin, chin - NECK * span],
        }
    }

    /// The rotation of the head at the given weights; weights that are missing or no number are 0.
    pub fn rotation(&self, weights: &[f32]) -> Mat3 {
        let Some(shapes) = self.shapes else { return Mat3::IDENTITY };
        let weight = |k: usize| weights.get(k).copied().filter(|w| w.is_finite()).unwrap_or(0.0);
        let HeadAngles { nod, turn, tilt } =
            HeadAngles::of_weights(shapes.map(|k| f64::from(weight(k))));
        let [nod, turn, tilt] = [nod, turn, -tilt].map(|degrees| (degrees as f32).to_radians());
        Mat3::from_euler(EulerRot::ZYX, tilt, turn, nod)
    }

    /// Where a point of the head goes.
    pub fn turned(&self, rotation: Mat3, point: Vec3) -> Vec3 {
        self.pivot + rotation * (point - self.pivot)
    }
}
