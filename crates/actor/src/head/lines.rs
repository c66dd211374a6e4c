//! The lines that a drawing of the built-in head is made of: outline, brows, lids, nose, lips.

use super::topology::{Feature, Site, Topology};
use super::{HeadSpec, Subdivided};

/// A line on the skin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaceLine {
    /// What it is of the face.
    pub part: FaceLinePart,
    /// Vertices of [`mimique_avatar::Avatar::skin`] along it.
    pub vertices: Vec<u32>,
    /// Whether the last one is joined to the first.
    pub closed: bool,
}

/// What a line is of the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceLinePart {
    /// From the crown by the ears to the chin.
    Outline,
    /// A brow, which is drawn thick.
    Brow,
    /// The opening between the lids.
    Eye,
    /// The nose: its base and wings.
    Nose,
    /// From the nose to the corner of the mouth.
    Fold,
    /// The outer border of the lips.
    Lips,
    /// The opening between the lips.
    Mouth,
}

/// The lines of the head that `spec` builds, each with its twin where there are two. They are the same for every
/// identity; vertex numbers depend on the density alone.
pub fn face_lines(spec: &HeadSpec) -> Vec<FaceLine> {
    let topology = Topology::new();
    let own = Subdivided::new(&topology, spec.density).skin_vertex_of_cage();
    let grid = |row: i32, column: i32| topology.at(Site::Grid(row, column));
    let ring = |feature: Feature, ring: i32| -> Vec<usize> {
        (0..feature.ring_length()).map(|k| topology.ring(feature, ring, k)).collect()
    };
    let mirrored = |line: &[usize]| line.iter().map(|&v| topology.mirror[v] as usize).collect();
    let right_to_left = |half: &[usize]| -> Vec<usize> {
        let mut whole: Vec<usize> = mirrored(half);
        whole.reverse();
        // The middle is there once.
        whole.extend(&half[1..]);
        whole
    };
    // From the chin by the ear to the crown, on the left.
    const OUTLINE: [Site; 14] = [
        Site::Grid(22, 0),
        Site::Grid(22, 3),
        Site::Grid(21, 6),
        Site::Grid(20, 9),
        Site::Grid(18, 11),
        Site::Grid(16, 12),
        Site::Grid(13, 13),
        Site::Grid(9, 13),
        Site::Grid(5, 13),
        Site::Grid(2, 13),
        Site::Cap(11, 6),
        Site::Cap(10, 6),
        Site::Cap(8, 6),
        Site::Cap(6, 6),
    ];
    let outline: Vec<usize> = OUTLINE.map(|site| topology.at(site)).to_vec();
    let nose: Vec<usize> = [(12, 0), (12, 1), (12, 2), (11, 3), (10, 3)]
        .map(|(row, column)| grid(row, column))
        .to_vec();
    let brow: Vec<usize> = (3..=9).map(|column| grid(4, column)).collect();
    let fold: Vec<usize> =
        [(12, 4), (13, 5), (14, 6)].map(|(row, column)| grid(row, column)).to_vec();
    let line = |part: FaceLinePart, line: &[usize], closed: bool| FaceLine {
        part,
        vertices: line.iter().map(|&v| own[v]).collect(),
        closed,
    };
    let mut lines = vec![
        line(FaceLinePart::Outline, &right_to_left(&outline), false),
        line(FaceLinePart::Nose, &right_to_left(&nose), false),
        line(FaceLinePart::Lips, &ring(Feature::Mouth, 2), true),
        line(FaceLinePart::Mouth, &ring(Feature::Mouth, 5), true),
        line(FaceLinePart::Eye, &ring(Feature::EyeLeft, 5), true),
        line(FaceLinePart::Eye, &ring(Feature::EyeRight, 5), true),
    ];
    for (part, left) in [(FaceLinePart::Brow, brow), (FaceLinePart::Fold, fold)] {
        lines.push(line(part, &left, false));
        lines.push(line(part, &mirrored(&left), false));
    }
    lines
}
