//! Both eyes in one mesh, as many exporters write them, made two meshes: each turns about its own
//! centre and gets its own iris.
//!
//! The pieces of the mesh that hang together (eyeball, iris and cornea of one eye, and those of the
//! other) lie in two groups across the face. Pieces of one eye lie within each other; between the
//! eyes is a gap, and there the mesh is parted.

use std::collections::HashMap;
use std::ops::Range;

use mimique_avatar::{Avatar, Mesh, Part, SparseShape, Textured};

/// Narrowest gap between two eyes, in widths of the wider one. Eyes of 24 mm stand 63 mm apart: 1.6.
const LEAST_GAP: f32 = 0.25;

/// Parts each mesh of [`Part::EyeLeft`] or [`Part::EyeRight`] that holds both eyes, and answers the
/// names of those that did. The left eye stays where the mesh was, the right one comes behind it.
pub(crate) fn part_eyes(avatar: &mut Avatar) -> Vec<String> {
    let mut parted = Vec::new();
    let mut meshes = Vec::with_capacity(avatar.meshes.len());
    for mesh in std::mem::take(&mut avatar.meshes) {
        let eye = mesh.part.is_eye();
        let Some(middle) = eye.then(|| middle_plane(&mesh)).flatten() else {
            meshes.push(mesh);
            continue;
        };
        // Triangles hang together, so that one corner tells the side of all.
        let of_side = |left: bool| {
            let here = |v: usize| (mesh.positions[v][0] > middle) == left;
            let mut out = kept(&mesh, &here);
            (out.part, out.name) = match left {
                true => (Part::EyeLeft, format!("{}_L", mesh.name)),
                false => (Part::EyeRight, format!("{}_R", mesh.name)),
            };
            out
        };
        meshes.extend([of_side(true), of_side(false)]);
        parted.push(mesh.name);
    }
    avatar.meshes = meshes;
    parted
}

/// The x between two eyes, where the mesh is two.
fn middle_plane(mesh: &Mesh) -> Option<f32> {
    let mut pieces = pieces(mesh);
    pieces.sort_by(|a, b| a.start.total_cmp(&b.start));
    let all = pieces.first()?.start..pieces.iter().fold(f32::NEG_INFINITY, |x, p| x.max(p.end));
    let (mut end, mut widest) = (all.start, 0.0..0.0);
    for piece in &pieces {
        if piece.start - end > widest.end - widest.start {
            widest = end..piece.start;
        }
        end = end.max(piece.end);
    }
    let wider = (widest.start - all.start).max(all.end - widest.end);
    let parted = widest.end - widest.start > LEAST_GAP * wider && wider > 0.0;
    parted.then_some(0.5 * (widest.start + widest.end))
}

/// From where to where each piece of the mesh reaches in x. Vertices in one place hang together, as
/// those of a triangle do.
fn pieces(mesh: &Mesh) -> Vec<Range<f32>> {
    let mut leader: Vec<usize> = (0..mesh.positions.len()).collect();
    fn first(leader: &mut [usize], mut v: usize) -> usize {
        while leader[v] != v {
            leader[v] = leader[leader[v]];
            v = leader[v];
        }
        v
    }
    let mut at: HashMap<[u32; 3], usize> = HashMap::with_capacity(leader.len());
    for (v, p) in mesh.positions.iter().enumerate() {
        leader[v] = *at.entry(p.map(f32::to_bits)).or_insert(v);
    }
    let corners = mesh.triangles.iter().map(|t| t.map(|v| v as usize));
    for [a, b, c] in corners.clone() {
        for other in [b, c] {
            let (a, other) = (first(&mut leader, a), first(&mut leader, other));
            leader[a.max(other)] = a.min(other);
        }
    }
    let mut reach: HashMap<usize, Range<f32>> = HashMap::new();
    for v in corners.flatten() {
        let x = mesh.positions[v][0];
        let range = reach.entry(first(&mut leader, v)).or_insert(x..x);
        *range = range.start.min(x)..range.end.max(x);
    }
    reach.into_values().collect()
}

/// The mesh of the vertices that `here` keeps.
fn kept(mesh: &Mesh, here: &dyn Fn(usize) -> bool) -> Mesh {
    let old: Vec<usize> = (0..mesh.positions.len()).filter(|v| here(*v)).collect();
    let mut new = vec![None; mesh.positions.len()];
    (0..).zip(&old).for_each(|(n, v): (u32, _)| new[*v] = Some(n));
    // How many of the triangles before each stay.
    let mut before = vec![0];
    let mut triangles = Vec::new();
    for t in &mesh.triangles {
        if let [Some(a), Some(b), Some(c)] = t.map(|v| new[v as usize]) {
            triangles.push([a, b, c]);
        }
        before.push(triangles.len());
    }
    let shape = |shape: &SparseShape| {
        let moved = shape.vertices.iter().zip(&shape.deltas);
        let (vertices, deltas) = moved.filter_map(|(v, d)| Some((new[*v as usize]?, *d))).unzip();
        SparseShape { vertices, deltas }
    };
    let run = |run: &Textured| {
        let triangles = before[run.triangles.start]..before[run.triangles.end];
        (!triangles.is_empty()).then_some(Textured { triangles, ..*run })
    };
    let of = |all: &[[f32; 3]]| old.iter().filter_map(|v| all.get(*v).copied()).collect();
    Mesh {
        name: mesh.name.clone(),
        part: mesh.part,
        positions: of(&mesh.positions),
        vertex_colours: of(&mesh.vertex_colours),
        base_colour: mesh.base_colour,
        shapes: mesh.shapes.iter().map(shape).collect(),
        uvs: old.iter().filter_map(|v| mesh.uvs.get(*v).copied()).collect(),
        textured: mesh.textured.iter().filter_map(run).collect(),
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of triangles from x to x + wide, its vertices coloured by their place.
    fn band(mesh: &mut Mesh, x: f32, wide: f32) {
        let first = mesh.positions.len() as u32;
        for i in 0..4 {
            mesh.positions.push([x + wide * i as f32 / 3.0, (i % 2) as f32 * 0.01, 0.0]);
        }
        mesh.triangles.extend([[first, first + 1, first + 2], [first + 1, first + 2, first + 3]]);
        mesh.vertex_colours = mesh.positions.iter().map(|p| [p[0].abs(); 3]).collect();
        mesh.uvs = mesh.positions.iter().map(|p| [p[0], p[1]]).collect();
    }

    fn eyes(bands: &[(f32, f32)]) -> Avatar {
        let mut mesh = Mesh { name: "Eyes".to_owned(), part: Part::EyeLeft, ..Mesh::default() };
        bands.iter().for_each(|(x, wide)| band(&mut mesh, *x, *wide));
        let deltas: Vec<[f32; 3]> = mesh.positions.iter().map(|p| [p[0], 0.0, 0.001]).collect();
        mesh.shapes = vec![SparseShape::from_dense(&deltas), SparseShape::default()];
        mesh.textured = vec![Textured { triangles: 1..mesh.triangles.len(), texture: 0 }];
        Avatar { meshes: vec![Mesh::default(), mesh], ..Avatar::default() }
    }

    #[test]
    fn two_eyes_with_their_irises_become_two_meshes() {
        let whole = eyes(&[(-0.043, 0.024), (0.019, 0.024), (0.025, 0.012), (-0.037, 0.012)]);
        let mut parted = whole.clone();
        assert_eq!(part_eyes(&mut parted), ["Eyes"]);
        let [_, left, right] = parted.meshes.as_slice() else { panic!("{parted:?}") };
        assert_eq!((left.part, left.name.as_str()), (Part::EyeLeft, "Eyes_L"));
        assert_eq!((right.part, right.name.as_str()), (Part::EyeRight, "Eyes_R"));
        // Moved by the shape, both sides together are what the whole was, and each keeps its own.
        for (mesh, sign, triangles) in [(left, 1.0, 0..4), (right, -1.0, 1..4)] {
            assert!(mesh.positions.iter().all(|p| p[0] * sign > 0.01), "{:?}", mesh.positions);
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (8, 4));
            assert_eq!(mesh.textured, [Textured { triangles, texture: 0 }]);
            for (v, p) in mesh.posed(&[1.0, 1.0]).iter().enumerate() {
                let rest = mesh.positions[v];
                assert_eq!(*p, [rest[0] * 2.0, rest[1], 0.001]);
                assert_eq!(mesh.vertex_colours[v], [rest[0].abs(); 3]);
                assert_eq!(mesh.uvs[v], [rest[0], rest[1]]);
            }
        }
    }

    #[test]
    fn one_eye_stays_one_wherever_it_lies() {
        for bands in [
            &[(0.019, 0.024), (0.025, 0.012)][..],
            &[(-0.012, 0.024)],
            // A corner of tissue beside the ball.
            &[(0.019, 0.024), (0.014, 0.006), (0.0445, 0.003)],
            &[],
        ] {
            let whole = eyes(bands);
            let mut same = whole.clone();
            assert_eq!(part_eyes(&mut same), [""; 0]);
            assert_eq!(same, whole);
        }
        let mut skin = eyes(&[(-0.043, 0.024), (0.019, 0.024)]);
        skin.meshes[1].part = Part::Skin;
        assert_eq!(part_eyes(&mut skin), [""; 0]);
    }
}
