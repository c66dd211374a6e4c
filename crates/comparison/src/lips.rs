//! The lips: which vertices they are, and which of them meet while the mouth is shut.

use mimique_avatar::arkit_shapes;
use mimique_layout::Face;

/// Distance from the border of the mouth that is lip, metres.
const LIPS_M: f64 = 0.010;
/// The share of the mouth's width about its middle in which lips are held against each other.
const MIDDLE: f64 = 0.5;

/// A vertex of the upper lip and the one of the lower lip that it meets, by their places in the vertices that are
/// compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LipPair {
    /// Of the upper lip.
    pub upper: usize,
    /// Of the lower lip.
    pub lower: usize,
}

/// Places in `vertices` of those within 10 mm of the border of the mouth.
pub(crate) fn lip_vertices(face: &Face<'_>, vertices: &[usize]) -> Vec<usize> {
    let near = |v: usize| {
        face.openings.mouth.iter().any(|&m| (face.place(m) - face.place(v)).length() <= LIPS_M)
    };
    (0..vertices.len()).filter(|&i| near(vertices[i])).collect()
}

/// Pairs of the mouth's border about its middle: each vertex that opening the jaw leaves, with the nearest that it
/// takes along, both of them among `vertices`. None of an avatar without a shape that opens the jaw.
pub(crate) fn lip_pairs(face: &Face<'_>, vertices: &[usize]) -> Vec<LipPair> {
    let mesh = &face.skin.mesh;
    let jaw = face.skin.shape_names.iter().position(|name| arkit_shapes(name) == ["jawOpen"]);
    let Some(jaw) = jaw.map(|k| &mesh.shapes[k]) else { return Vec::new() };
    let falls = |v: usize| {
        jaw.vertices.binary_search(&(v as u32)).map_or(0.0, |place| -jaw.deltas[place].y)
    };
    let mouth = &face.openings.mouth;
    let most = mouth.iter().map(|&v| falls(v)).fold(0.0, f64::max);
    let width = (face.landmarks.cheilion[0] - face.landmarks.cheilion[1]).length();
    let central =
        |v: &&usize| face.mirror.plane.distance(face.place(**v)).abs() < 0.5 * MIDDLE * width;
    let (lower, upper): (Vec<usize>, Vec<usize>) =
        mouth.iter().filter(central).partition(|&&v| falls(v) > 0.5 * most);
    let distance = |a: usize, b: usize| (face.place(a) - face.place(b)).length();
    let place = |v: usize| vertices.binary_search(&v).ok();
    let pair = |upper: usize| {
        let nearest = (lower.iter().copied())
            .min_by(|&a, &b| distance(upper, a).total_cmp(&distance(upper, b)))?;
        Some(LipPair { upper: place(upper)?, lower: place(nearest)? })
    };
    upper.into_iter().filter_map(pair).collect()
}
