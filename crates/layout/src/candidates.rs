//! Which vertices may have a marker: moved, seen, not on an excluded part of the face.

use mimique_avatar::turns_eyes;
use serde::Serialize;

use crate::face::{Excluded, Face};
use crate::view::{DepthPicture, View};

/// A vertex that no shape moves as far as this needs no marker, metres.
pub const MOVED_M: f64 = 1e-3;
/// Directions that a marker is to be seen from: one of them is enough.
const VIEWS_DEGREES: [f64; 3] = [-45.0, 0.0, 45.0];
/// Metres of a point of the pictures that visibility is told by.
const STEP_M: f64 = 0.00075;
/// What is hidden by less is seen, metres.
const HIDDEN_M: f64 = 0.0015;
/// Cosine of the steepest angle at which the skin is still seen.
const STEEPEST: f64 = 0.1;

/// Where markers may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Where {
    /// Parts that stay free.
    pub exclude: Vec<Excluded>,
    /// Vertices (of the welded skin) that markers are kept to; all where none are named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub only: Option<Vec<usize>>,
    /// Vertices that stay free.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<usize>,
}

impl Default for Where {
    fn default() -> Self {
        Self { exclude: Excluded::USUAL.to_vec(), only: None, without: Vec::new() }
    }
}

/// How many vertices there are at each step of the choice, for a report and for errors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CandidateCounts {
    /// Vertices of the skin.
    pub vertices: usize,
    /// Of these, moved by a millimetre or more.
    pub moved: usize,
    /// Of these, seen from the front or from 45 degrees.
    pub seen: usize,
    /// Of these, in the named region.
    pub named: usize,
    /// Of these, on no excluded part.
    pub allowed: usize,
}

/// The vertices that may have a marker.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Ascending.
    pub vertices: Vec<usize>,
    /// How they came about.
    pub counts: CandidateCounts,
}

impl Candidates {
    /// Of a face.
    pub fn of(face: &Face<'_>, place: &Where) -> Self {
        let count = face.skin.mesh.positions.len();
        let seen = seen(face);
        let mut named = vec![place.only.is_none(); count];
        place.only.iter().flatten().for_each(|&v| named[v] = true);
        let mut free = vec![true; count];
        for region in &place.exclude {
            let mask = region.mask(face);
            free.iter_mut().zip(mask).for_each(|(free, inside)| *free &= !inside);
        }
        place.without.iter().for_each(|&v| free[v] = false);
        let mut counts = CandidateCounts { vertices: count, ..CandidateCounts::default() };
        let mut vertices = Vec::new();
        for v in 0..count {
            let steps = [
                (face.reach[v] >= MOVED_M, &mut counts.moved),
                (seen[v], &mut counts.seen),
                (named[v], &mut counts.named),
                (free[v], &mut counts.allowed),
            ];
            let mut kept = true;
            for (passes, counter) in steps {
                kept &= passes;
                *counter += usize::from(kept);
            }
            if kept {
                vertices.push(v);
            }
        }
        Self { vertices, counts }
    }
}

/// Which vertices are seen from the front, or from 45 degrees to either side.
pub(crate) fn seen(face: &Face<'_>) -> Vec<bool> {
    let mesh = &face.skin.mesh;
    let mut seen = vec![false; mesh.positions.len()];
    let low = mesh.positions.iter().fold(f64::INFINITY, |least, p| least.min(p.y));
    let high = mesh.positions.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p.y));
    for degrees in VIEWS_DEGREES {
        let view = View::turned(degrees);
        let picture = DepthPicture::of(mesh, view, [low, high], STEP_M);
        for (v, seen) in seen.iter_mut().enumerate() {
            let faces = |n: mimique_geometry::Displacement| n.0.dot(view.towards()) > STEEPEST;
            let towards = face.gradients.normal(v).is_some_and(faces);
            *seen |= towards && picture.sees(mesh.positions[v], HIDDEN_M);
        }
    }
    seen
}

/// The shapes that markers at some vertices do not tell: those that move none of them by a millimetre, and
/// those that turn the eyes.
pub fn unseen_shapes(face: &Face<'_>, vertices: &[usize]) -> Vec<usize> {
    let n = face.shape_count();
    let mut most = vec![0.0_f64; n];
    for &v in vertices {
        let rows = face.deltas_of(v);
        for (k, most) in most.iter_mut().enumerate() {
            let [x, y, z] = [rows[k], rows[n + k], rows[2 * n + k]];
            *most = most.max((x * x + y * y + z * z).sqrt());
        }
    }
    let unseen = |k: &usize| most[*k] < MOVED_M || turns_eyes(&face.skin.shape_names[*k]);
    (0..n).filter(unseen).collect()
}

/// The shapes that turn the eyes.
pub fn gaze_shapes(face: &Face<'_>) -> Vec<usize> {
    (0..face.shape_count()).filter(|&k| turns_eyes(&face.skin.shape_names[k])).collect()
}
