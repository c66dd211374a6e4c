//! The skin as one surface without seams: what the thin shell is made of and markers sit on.
//!
//! Exporters split a vertex wherever texture coordinates or normals jump; the thin shell would
//! take such a seam for a border (H changes by a tenth), so split vertices become one again.

use std::collections::HashMap;

use crate::{Avatar, Part, SparseShape};

/// The welded skin: S vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// Neutral positions, metres (S).
    pub positions: Vec<[f32; 3]>,
    /// Triangles, indices into `positions`; those that welding flattened are gone.
    pub triangles: Vec<[u32; 3]>,
    /// The N blendshapes on the welded vertices.
    pub shapes: Vec<SparseShape>,
    /// Welded vertex of each vertex of the skin meshes, one mesh after the other.
    pub welded_from_file: Vec<u32>,
}

impl Skin {
    /// Welds the skin meshes of an avatar. Vertices become one where position and every
    /// displacement agree to a micrometre: lips that merely touch stay apart, because they part.
    ///
    /// Welded vertices keep the order in which they first appear.
    pub fn of(avatar: &Avatar) -> Self {
        let meshes: Vec<_> = avatar.meshes.iter().filter(|m| m.part == Part::Skin).collect();
        let positions: Vec<[f32; 3]> =
            meshes.iter().flat_map(|m| m.positions.iter().copied()).collect();
        let motion = motion_keys(&meshes, positions.len(), avatar.shape_names.len());

        let mut first: HashMap<([i64; 3], u64), u32> = HashMap::new();
        let mut welded = Vec::new();
        let mut kept = Vec::new();
        for (v, p) in positions.iter().enumerate() {
            let next = kept.len() as u32;
            let id = *first.entry((p.map(micrometres), motion[v])).or_insert(next);
            if id == next {
                kept.push(v);
            }
            welded.push(id);
        }

        let mut triangles = Vec::new();
        let mut shapes = vec![SparseShape::default(); avatar.shape_names.len()];
        let mut offset = 0usize;
        for mesh in &meshes {
            triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| welded[offset + v as usize])));
            for (shape, source) in shapes.iter_mut().zip(&mesh.shapes) {
                for (&v, &delta) in source.vertices.iter().zip(&source.deltas) {
                    let v = offset + v as usize;
                    // Only the vertex that was kept speaks for its twins.
                    if kept[welded[v] as usize] == v {
                        shape.vertices.push(welded[v]);
                        shape.deltas.push(delta);
                    }
                }
            }
            offset += mesh.positions.len();
        }
        triangles.retain(|t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
        Self {
            positions: kept.iter().map(|&v| positions[v]).collect(),
            triangles,
            shapes,
            welded_from_file: welded,
        }
    }

    /// The vertex nearest to `point` (metres) and its distance; `None` for an empty skin.
    pub fn nearest(&self, point: [f64; 3]) -> Option<(u32, f64)> {
        let square =
            |p: &[f32; 3]| -> f64 { (0..3).map(|a| (f64::from(p[a]) - point[a]).powi(2)).sum() };
        self.positions
            .iter()
            .enumerate()
            .map(|(v, p)| (v as u32, square(p)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(v, square)| (v, square.sqrt()))
    }
}

/// A fingerprint of every displacement of each vertex, in micrometres.
fn motion_keys(meshes: &[&crate::Mesh], vertices: usize, shapes: usize) -> Vec<u64> {
    let mut keys = vec![0u64; vertices];
    let mut offset = 0;
    for mesh in meshes {
        for (k, shape) in mesh.shapes.iter().enumerate().take(shapes) {
            for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                let q = delta.map(micrometres);
                if q != [0; 3] {
                    let key = &mut keys[offset + v as usize];
                    for word in [k as u64 + 1, q[0] as u64, q[1] as u64, q[2] as u64] {
                        // FNV-like mixing: a chance meeting of two motions is one in 2^64.
                        *key = (*key ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
                    }
                }
            }
        }
        offset += mesh.positions.len();
    }
    keys
}

fn micrometres(x: f32) -> i64 {
    (f64::from(x) * 1e6).round() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    /// Two triangles side by side, the shared edge split as exporters do, and a lip that touches.
    fn split() -> Avatar {
        let mesh = Mesh {
            positions: vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 1.0, 0.0],
                [1.0, 1.0, 0.0],
            ],
            triangles: vec![[0, 1, 2], [3, 5, 4], [3, 6, 4]],
            shapes: vec![SparseShape {
                vertices: vec![1, 3, 6],
                deltas: vec![[0.0, 0.0, 0.1], [0.0, 0.0, 0.1], [0.0, 0.0, 0.2]],
            }],
            ..Mesh::default()
        };
        Avatar { shape_names: vec!["s".into()], meshes: vec![mesh], ..Avatar::default() }
    }

    #[test]
    fn seams_close_and_parting_lips_stay_apart() {
        let skin = Skin::of(&split());
        assert_eq!(skin.welded_from_file, [0, 1, 2, 1, 2, 3, 4]);
        assert_eq!(skin.positions.len(), 5);
        assert_eq!(skin.triangles, [[0, 1, 2], [1, 3, 2], [1, 4, 2]]);
        assert_eq!(skin.shapes[0].vertices, [1, 4]);
    }

    #[test]
    fn nearest_gives_vertex_and_distance() {
        let skin = Skin::of(&split());
        let (v, d) = skin.nearest([1.0, 0.0, 0.25]).unwrap();
        assert_eq!((v, d), (1, 0.25));
        assert_eq!(Skin::of(&Avatar::default()).nearest([0.0; 3]), None);
    }
}
