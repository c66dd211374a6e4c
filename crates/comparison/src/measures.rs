//! How a motion moves by itself: how far, and how smoothly.

use serde::Serialize;

use crate::motion::length;
use crate::{ComparedFace, FaceMotion};

/// How a motion moves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Measures {
    /// Largest less smallest distance of a vertex from its place at rest, its mean over each part's vertices, millimetres:
    /// the dynamic range.
    pub range_mm: Vec<(&'static str, f64)>,
    /// Root mean square of the third derivative of the vertices' places, m/s^3: what trembles is large.
    pub jerk: f64,
    /// Largest distance of the lips beyond that at rest, millimetres; none of an avatar without lips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub widest_mouth_mm: Option<f64>,
}

/// The measures of a motion. A motion of fewer than four frames has no jerk, 0.
pub fn measures(face: &ComparedFace, motion: &FaceMotion) -> Measures {
    let frames = motion.frames();
    let range = |places: &[usize]| {
        let of_vertex = |&v: &usize| {
            let distances = (0..frames).map(|frame| motion.displacement(frame, v));
            let ends = distances.fold(None, |ends: Option<[f64; 2]>, distance| {
                let [least, most] = ends.unwrap_or([distance; 2]);
                Some([least.min(distance), most.max(distance)])
            });
            ends.map_or(0.0, |[least, most]| most - least)
        };
        1e3 * places.iter().map(of_vertex).sum::<f64>() / places.len().max(1) as f64
    };
    let mut range_mm: Vec<(&'static str, f64)> =
        face.by_part().iter().map(|(part, places)| (part.name(), range(places))).collect();
    let all: Vec<usize> = (0..motion.vertices()).collect();
    range_mm.push(("Face", range(&all)));
    let widest = motion.gaps.iter().copied().reduce(f64::max).map(|gap| 1e3 * gap);
    Measures { range_mm, jerk: jerk(motion), widest_mouth_mm: widest }
}

/// Root mean square over frames and vertices of p(t+3) - 3 p(t+2) + 3 p(t+1) - p(t), by the cube of the rate.
fn jerk(motion: &FaceMotion) -> f64 {
    let windows = motion.frames().saturating_sub(3);
    let mut squares = 0.0;
    for frame in 0..windows {
        for v in 0..motion.vertices() {
            let p = [0, 1, 2, 3].map(|k| motion.place(frame + k, v));
            let third = [0, 1, 2].map(|a| p[3][a] - 3.0 * p[2][a] + 3.0 * p[1][a] - p[0][a]);
            squares += length(third, [0.0; 3]).powi(2);
        }
    }
    let count = (windows * motion.vertices()).max(1) as f64;
    (squares / count).sqrt() * motion.rate_hz.powi(3)
}
