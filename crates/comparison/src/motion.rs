//! A performance as motion of a skin: where every vertex of the face is in every frame.

use mimique_solver::Synthesis;
use mimique_stimulus::AvatarSkin;

use crate::ComparedFace;

/// Where the vertices of a face are in every frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceMotion {
    /// Frames per second.
    pub rate_hz: f64,
    /// Frames x vertices x 3, metres, in the order of [`ComparedFace::vertices`].
    places: Vec<f32>,
    /// The same at rest.
    rest: Vec<f32>,
    /// How far the lips are apart in each frame beyond their distance at rest, metres; empty without lips.
    pub(crate) gaps: Vec<f64>,
}

impl FaceMotion {
    /// Of weights on a skin, a row per frame.
    ///
    /// # Panics
    /// If the weights are no whole rows of the skin's shapes.
    pub fn of(skin: &AvatarSkin, face: &ComparedFace, weights: &[f64], rate_hz: f64) -> Self {
        let n = skin.shape_names.len();
        let synthesis = Synthesis::new(&skin.mesh);
        let width = synthesis.coordinates();
        let mut posed = vec![0.0; Synthesis::FRAMES * width];
        let mut places = Vec::with_capacity(weights.len() / n.max(1) * 3 * face.vertices.len());
        let mut gaps = Vec::new();
        let take = |from: &[f32], out: &mut Vec<f32>| {
            face.vertices.iter().for_each(|&v| out.extend_from_slice(&from[3 * v..3 * v + 3]));
        };
        for rows in weights.chunks(Synthesis::FRAMES * n.max(1)) {
            synthesis.pose(rows, &mut posed);
            for frame in posed.chunks_exact(width).take(rows.len() / n) {
                take(frame, &mut places);
                gaps.extend(gap(face, frame));
            }
        }
        let mut rest = Vec::with_capacity(3 * face.vertices.len());
        synthesis.pose(&vec![0.0; n], &mut posed);
        take(&posed, &mut rest);
        Self { rate_hz, places, rest, gaps }
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.places.len() / self.rest.len().max(1)
    }

    /// Number of vertices.
    pub(crate) fn vertices(&self) -> usize {
        self.rest.len() / 3
    }

    /// The place of a vertex in a frame, metres.
    pub(crate) fn place(&self, frame: usize, vertex: usize) -> [f64; 3] {
        let at = frame * self.rest.len() + 3 * vertex;
        [0, 1, 2].map(|a| f64::from(self.places[at + a]))
    }

    /// How far a vertex is from its place at rest, metres.
    pub(crate) fn displacement(&self, frame: usize, vertex: usize) -> f64 {
        let rest = [0, 1, 2].map(|a| f64::from(self.rest[3 * vertex + a]));
        length(self.place(frame, vertex), rest)
    }
}

/// Distance of two places.
pub(crate) fn length(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt()
}

/// Mean distance of the lips in a posed skin beyond that at rest, metres; none without lips.
fn gap(face: &ComparedFace, posed: &[f32]) -> Option<f64> {
    let place = |v: usize| [0, 1, 2].map(|a| f64::from(posed[3 * v + a]));
    let apart =
        face.pairs.iter().map(|pair| length(place(pair.upper), place(pair.lower)) - pair.rest_m);
    (!face.pairs.is_empty()).then(|| apart.sum::<f64>() / face.pairs.len() as f64)
}
