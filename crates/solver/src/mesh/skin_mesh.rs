//! The surface that the thin shell is made of: triangles and sparse shape deltas, and its welding.

use std::collections::HashMap;

use mimique_geometry::{DVec3, Displacement, Point};

/// One blendshape on the skin: the vertices that it moves, and by how much at weight 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SparseDeltas {
    /// Vertex indices, ascending.
    pub vertices: Vec<u32>,
    /// Displacement of each, metres.
    pub deltas: Vec<Displacement>,
}

/// The skin alone: no eyeballs, teeth nor lashes, which would move the result by 0.2 mm.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SkinMesh {
    /// The S neutral positions, metres.
    pub positions: Vec<Point>,
    /// Triangles, indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// The N shapes.
    pub shapes: Vec<SparseDeltas>,
}

/// A mesh whose seams are closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Welded {
    /// The mesh without the doubled vertices.
    pub mesh: SkinMesh,
    /// For each vertex of the original, its index in `mesh`.
    pub index_of: Vec<u32>,
}

/// What is wrong with a [`SkinMesh`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// There is nothing to build on.
    #[error("skin: {what}; give the mesh of the face's skin with its blendshapes")]
    Empty {
        /// "no vertex", "no triangle", "no blendshape".
        what: &'static str,
    },
    /// A triangle names a vertex that is not there.
    #[error("skin, triangle {triangle}: vertex {vertex} of {count}; re-export the mesh")]
    TriangleVertex {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// A shape names a vertex that is not there, or not in ascending order, or misses deltas.
    #[error(
        "skin, blendshape {shape}: {what}; give ascending vertex indices below {count}, a delta each"
    )]
    ShapeVertex {
        /// Index of the shape.
        shape: usize,
        /// What is wrong.
        what: String,
        /// How many vertices there are.
        count: usize,
    },
    /// A number is not finite.
    #[error("skin, {place}: a number is not finite; re-export the mesh")]
    NotFinite {
        /// Which vertex or blendshape.
        place: String,
    },
}

impl SkinMesh {
    /// Check that indices are in range and numbers finite.
    ///
    /// # Errors
    /// [`MeshError`] with the first thing that is wrong.
    pub fn check(&self) -> Result<(), MeshError> {
        let count = self.positions.len();
        for (what, empty) in [
            ("no vertex", count == 0),
            ("no triangle", self.triangles.is_empty()),
            ("no blendshape", self.shapes.is_empty()),
        ] {
            if empty {
                return Err(MeshError::Empty { what });
            }
        }
        for (i, p) in self.positions.iter().enumerate() {
            if !p.is_finite() {
                return Err(MeshError::NotFinite { place: format!("vertex {i}") });
            }
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(MeshError::TriangleVertex { triangle, vertex, count });
            }
        }
        for (shape, deltas) in self.shapes.iter().enumerate() {
            let wrong = |what: String| Err(MeshError::ShapeVertex { shape, what, count });
            if deltas.vertices.len() != deltas.deltas.len() {
                let (v, d) = (deltas.vertices.len(), deltas.deltas.len());
                return wrong(format!("{v} vertices but {d} deltas"));
            }
            if let Some(pair) = deltas.vertices.windows(2).find(|p| p[0] >= p[1]) {
                return wrong(format!("vertex {} after vertex {}", pair[1], pair[0]));
            }
            if let Some(&last) = deltas.vertices.last()
                && last as usize >= count
            {
                return wrong(format!("vertex {last} of {count}"));
            }
            if !deltas.deltas.iter().all(|d| d.is_finite()) {
                return Err(MeshError::NotFinite { place: format!("blendshape {shape}") });
            }
        }
        Ok(())
    }

    /// Diagonal of the box round the positions, metres.
    fn size(&self) -> f64 {
        let low = self.positions.iter().fold(DVec3::INFINITY, |low, p| low.min(p.0));
        let high = self.positions.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(p.0));
        (high - low).length()
    }

    /// Which vertices no shape moves by more than `tolerance` metres at weight 1.
    pub fn unmoved(&self, tolerance: f64) -> Vec<bool> {
        let mut out = vec![true; self.positions.len()];
        for (v, d) in self.shapes.iter().flat_map(|s| s.vertices.iter().zip(&s.deltas)) {
            if d.length() > tolerance {
                out[*v as usize] = false;
            }
        }
        out
    }

    /// Close seams: vertices with exactly the same position and the same deltas, within a millionth of
    /// the model's size, become one, as exporters split them where textures meet (and round the
    /// deltas of each twin by itself). Open seams change H by 10 %.
    ///
    /// The order of the vertices that remain is that of their first occurrence; triangles that
    /// collapse go. Vertices at one place that move differently (lips that touch) stay apart.
    ///
    /// # Errors
    /// [`MeshError`] as of [`SkinMesh::check`].
    pub fn weld(&self) -> Result<Welded, MeshError> {
        self.check()?;
        // For each vertex the last one before it at the same place; itself where there is none.
        let mut last_at: HashMap<[u64; 3], usize> = HashMap::with_capacity(self.positions.len());
        let before: Vec<usize> = (self.positions.iter().enumerate())
            .map(|(vertex, p)| last_at.insert(p.to_array().map(bits), vertex).unwrap_or(vertex))
            .collect();
        let mut shared = vec![false; before.len()];
        for (vertex, &other) in before.iter().enumerate().filter(|(vertex, other)| vertex != *other)
        {
            (shared[vertex], shared[other]) = (true, true);
        }
        let (moves, most) = (Moves::new(self, &shared), SEAM_TOLERANCE * self.size());
        let mut index_of: Vec<u32> = Vec::with_capacity(self.positions.len());
        let mut positions = Vec::new();
        for (vertex, p) in self.positions.iter().enumerate() {
            let (mut at, mut same) = (vertex, None);
            while before[at] != at {
                at = before[at];
                if moves.alike(at, vertex, most) {
                    same = Some(index_of[at]);
                }
            }
            index_of.push(same.unwrap_or(positions.len() as u32));
            if same.is_none() {
                positions.push(*p);
            }
        }
        let triangles = (self.triangles.iter())
            .map(|t| t.map(|v| index_of[v as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let shapes = self.shapes.iter().map(|s| welded_shape(s, &index_of)).collect();
        Ok(Welded { mesh: SkinMesh { positions, triangles, shapes }, index_of })
    }
}

/// How far the deltas of one place may lie apart, in sizes of the model: a third of a micrometre on a
/// head, which 32-bit numbers reach when an exporter scales or turns; lips that touch part by more.
const SEAM_TOLERANCE: f64 = 1e-6;

/// For each vertex that shares its place its non-zero deltas and their shapes; nothing for others.
struct Moves {
    starts: Vec<usize>,
    entries: Vec<(u32, Displacement)>,
}

impl Moves {
    fn new(mesh: &SkinMesh, shared: &[bool]) -> Moves {
        let moving = |shape: &SparseDeltas| {
            let pairs = shape.vertices.iter().copied().zip(shape.deltas.iter().copied());
            pairs
                .filter(|(v, d)| shared[*v as usize] && *d != Displacement::ZERO)
                .collect::<Vec<_>>()
        };
        let mut starts = vec![0_usize; mesh.positions.len() + 1];
        let shapes: Vec<_> = mesh.shapes.iter().map(moving).collect();
        for (v, _) in shapes.iter().flatten() {
            starts[*v as usize + 1] += 1;
        }
        for i in 0..mesh.positions.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, Displacement::ZERO); starts[mesh.positions.len()]];
        for (k, shape) in shapes.iter().enumerate() {
            for (v, d) in shape {
                entries[next[*v as usize]] = (k as u32, *d);
                next[*v as usize] += 1;
            }
        }
        Moves { starts, entries }
    }

    fn of(&self, vertex: usize) -> &[(u32, Displacement)] {
        &self.entries[self.starts[vertex]..self.starts[vertex + 1]]
    }

    /// Whether no coordinate of any delta of the two differs by more than `most`; a shape that moves
    /// one of them only moves the other by nothing.
    fn alike(&self, a: usize, b: usize, most: f64) -> bool {
        let (mut a, mut b) = (self.of(a), self.of(b));
        loop {
            let shape = |list: &[(u32, Displacement)]| list.first().map_or(u32::MAX, |e| e.0);
            let first = shape(a).min(shape(b));
            let take = |list: &mut &[(u32, Displacement)]| match list.split_first() {
                Some((entry, rest)) if entry.0 == first => {
                    *list = rest;
                    entry.1
                }
                _ => Displacement::ZERO,
            };
            let (d, e) = (take(&mut a), take(&mut b));
            if (d - e).abs().cmpgt(DVec3::splat(most)).any() {
                return false;
            }
            if a.is_empty() && b.is_empty() {
                return true;
            }
        }
    }
}

/// Bits that are equal when the numbers are (-0 as 0).
fn bits(x: f64) -> u64 {
    (x + 0.0).to_bits()
}

fn welded_shape(shape: &SparseDeltas, index_of: &[u32]) -> SparseDeltas {
    let mut entries: Vec<(u32, Displacement)> = (shape.vertices.iter().zip(&shape.deltas))
        .filter(|(_, d)| **d != Displacement::ZERO)
        .map(|(&v, &d)| (index_of[v as usize], d))
        .collect();
    entries.sort_by_key(|e| e.0);
    entries.dedup_by_key(|e| e.0);
    SparseDeltas {
        vertices: entries.iter().map(|e| e.0).collect(),
        deltas: entries.iter().map(|e| e.1).collect(),
    }
}
