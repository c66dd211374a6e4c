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
    places: Vec<f64>,
    /// The same at rest.
    rest: Vec<f64>,
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
        let take = |from: &[f32], out: &mut Vec<f64>| {
            for &v in &face.vertices {
                out.extend(from[3 * v..3 * v + 3].iter().copied().map(f64::from));
            }
        };
        for rows in weights.chunks(Synthesis::FRAMES * n.max(1)) {
            synthesis.pose(rows, &mut posed);
            for frame in posed.chunks_exact(width).take(rows.len() / n) {
                take(frame, &mut places);
            }
        }
        let mut rest = Vec::with_capacity(3 * face.vertices.len());
        synthesis.pose(&vec![0.0; n], &mut posed);
        take(&posed, &mut rest);
        Self::of_places(face, places, rest, rate_hz)
    }

    /// Of vertices' places, frames x vertices x 3, and those at rest, vertices x 3, metres.
    ///
    /// # Panics
    /// If they are not of the face's vertices.
    pub fn of_places(face: &ComparedFace, places: Vec<f64>, rest: Vec<f64>, rate_hz: f64) -> Self {
        assert_eq!(rest.len(), 3 * face.vertices.len(), "a place for each vertex");
        assert!(places.len().is_multiple_of(rest.len().max(1)), "whole frames");
        let at_rest = lip_distance(face, &rest).unwrap_or_default();
        let frames = places.chunks_exact(rest.len().max(1));
        let gaps = frames.filter_map(|frame| Some(lip_distance(face, frame)? - at_rest)).collect();
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
        of_vertex(&self.places[frame * self.rest.len()..], vertex)
    }

    /// How far a vertex is from its place at rest, metres.
    pub(crate) fn displacement(&self, frame: usize, vertex: usize) -> f64 {
        length(self.place(frame, vertex), of_vertex(&self.rest, vertex))
    }
}

fn of_vertex(frame: &[f64], vertex: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| frame[3 * vertex + axis])
}

/// Distance of two places.
pub(crate) fn length(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt()
}

/// Mean distance of the lips in a frame, metres; none without lips.
fn lip_distance(face: &ComparedFace, frame: &[f64]) -> Option<f64> {
    let apart = (face.lip_pairs.iter())
        .map(|pair| length(of_vertex(frame, pair.upper), of_vertex(frame, pair.lower)));
    (!face.lip_pairs.is_empty()).then(|| apart.sum::<f64>() / face.lip_pairs.len() as f64)
}
