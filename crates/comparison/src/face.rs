//! The face that motions are compared on: its vertices, the part that each belongs to, its lips.

use mimique_layout::{Excluded, Face, FacePart};
use mimique_stimulus::AvatarSkin;

use crate::lips::{LipPair, lip_pairs, lip_vertices};

/// A vertex that no shape moves farther shows nothing, metres.
const MOVED_M: f64 = 1e-4;

/// The vertices of a skin that motions are compared on.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedFace {
    /// Vertices of the welded skin, ascending: the face without ears, neck and scalp.
    pub vertices: Vec<usize>,
    /// The part that each belongs to; empty where the avatar's landmarks cannot be found.
    pub parts: Vec<FacePart>,
    /// Places in `vertices` of the lips: within 10 mm of the border of the mouth.
    pub lips: Vec<usize>,
    /// Places in `vertices` of the upper face: forehead, brows and eyes.
    pub upper: Vec<usize>,
    /// Pairs of vertices that lie on each other while the mouth is shut.
    pub lip_pairs: Vec<LipPair>,
}

impl ComparedFace {
    /// Of an avatar's skin. Without landmarks (no shape of ARKit's vocabulary, no upright head) it is all that any
    /// shape moves by 0.1 mm, as one part without lips.
    pub fn of(skin: &AvatarSkin) -> Self {
        let Ok(face) = Face::of(skin) else { return Self::without_landmarks(skin) };
        let outside: Vec<Vec<bool>> =
            [Excluded::Ears, Excluded::Neck, Excluded::Hair].map(|part| part.mask(&face)).into();
        let inside = |v: &usize| outside.iter().all(|mask| !mask[*v]);
        let vertices: Vec<usize> = (0..skin.mesh.positions.len()).filter(inside).collect();
        if vertices.is_empty() {
            return Self::without_landmarks(skin);
        }
        let parts: Vec<FacePart> = vertices.iter().map(|&v| face.part(v)).collect();
        let above = |part| matches!(part, FacePart::Forehead | FacePart::Brow | FacePart::Eye);
        Self {
            lips: lip_vertices(&face, &vertices),
            upper: (0..parts.len()).filter(|&i| above(parts[i])).collect(),
            lip_pairs: lip_pairs(&face, &vertices),
            parts,
            vertices,
        }
    }

    fn without_landmarks(skin: &AvatarSkin) -> Self {
        let mut moved = vec![false; skin.mesh.positions.len()];
        for shape in &skin.mesh.shapes {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                moved[v as usize] |= d.length() > MOVED_M;
            }
        }
        let vertices = (0..moved.len()).filter(|&v| moved[v]).collect();
        Self {
            vertices,
            parts: Vec::new(),
            lips: Vec::new(),
            upper: Vec::new(),
            lip_pairs: Vec::new(),
        }
    }

    /// The parts that there are, from above to below, each with its places in `vertices`.
    pub fn by_part(&self) -> Vec<(FacePart, Vec<usize>)> {
        let places = |part| -> Vec<usize> {
            (0..self.parts.len()).filter(|&i| self.parts[i] == part).collect()
        };
        let parts = FacePart::ALL.into_iter().map(|part| (part, places(part)));
        parts.filter(|(_, places)| !places.is_empty()).collect()
    }
}
