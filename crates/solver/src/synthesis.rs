//! From weights to the vertices of the skin, many frames at a time.

use crate::dense::widest;
use crate::skin_mesh::SkinMesh;

/// Coordinates that are summed together, in registers: two of the widest vectors that we use.
const TILE: usize = 16;

/// Frames that share what is loaded of the shapes.
const FRAMES: usize = 4;

/// Tiles whose shapes stay in a processor's second memory while all the frames pass: some 80 KiB.
const BLOCK_TILES: usize = 32;

/// The neutral and the shapes of a skin, cut into tiles of some five vertices; each has the shapes
/// that move it and no others.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    shape_count: usize,
    coordinates: usize,
    /// The 3S coordinates, filled up with zeros to whole tiles.
    neutral: Vec<[f32; TILE]>,
    /// Entries of tile t are `starts[t]..starts[t + 1]` of `shapes` and `deltas`.
    starts: Vec<usize>,
    shapes: Vec<u32>,
    deltas: Vec<[f32; TILE]>,
}

impl Synthesis {
    /// Prepare a mesh that passes [`SkinMesh::check`]. Single precision: what is drawn.
    pub fn new(mesh: &SkinMesh) -> Synthesis {
        let coordinates = 3 * mesh.positions.len();
        let mut neutral = vec![[0.0; TILE]; coordinates.div_ceil(TILE)];
        for (i, &x) in mesh.positions.as_flattened().iter().enumerate() {
            neutral[i / TILE][i % TILE] = x as f32;
        }
        let mut tiles: Vec<Vec<(u32, [f32; TILE])>> = vec![Vec::new(); neutral.len()];
        for (k, shape) in mesh.shapes.iter().enumerate() {
            for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                for (axis, &x) in delta.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                    let i = 3 * v as usize + axis;
                    let tile = &mut tiles[i / TILE];
                    if tile.last().is_none_or(|last| last.0 != k as u32) {
                        tile.push((k as u32, [0.0; TILE]));
                    }
                    if let Some((_, deltas)) = tile.last_mut() {
                        deltas[i % TILE] = x as f32;
                    }
                }
            }
        }
        let mut starts = vec![0];
        starts.extend(tiles.iter().scan(0, |sum, tile| {
            *sum += tile.len();
            Some(*sum)
        }));
        Synthesis {
            shape_count: mesh.shapes.len(),
            coordinates,
            neutral,
            starts,
            shapes: tiles.iter().flatten().map(|e| e.0).collect(),
            deltas: tiles.iter().flatten().map(|e| e.1).collect(),
        }
    }

    /// 3S: the coordinates of a frame.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// neutral + sum of weight times shape, shapes in their order: `weights` is frames x N, `out`
    /// begins with frames x 3S coordinates (x, y, z of vertex 0, then of vertex 1...), metres.
    ///
    /// # Panics
    /// If `weights` is not whole frames or `out` is too short for them.
    pub fn pose(&self, weights: &[f64], out: &mut [f32]) {
        let n = self.shape_count;
        assert!(n > 0 && weights.len().is_multiple_of(n), "a frame has N weights");
        let out = &mut out[..weights.len() / n * self.coordinates];
        // Weights of four frames side by side, shape by shape.
        let groups: Vec<Vec<[f32; FRAMES]>> = (weights.chunks(FRAMES * n))
            .map(|frames| {
                let weight = |f: usize, k: usize| frames.get(f * n + k).map_or(0.0, |&w| w as f32);
                (0..n).map(|k| std::array::from_fn(|f| weight(f, k))).collect()
            })
            .collect();
        for first in (0..self.neutral.len()).step_by(BLOCK_TILES) {
            let last = (first + BLOCK_TILES).min(self.neutral.len());
            for (group, out) in groups.iter().zip(out.chunks_mut(FRAMES * self.coordinates)) {
                for tile in first..last {
                    let entries = self.starts[tile]..self.starts[tile + 1];
                    let mut sums = [self.neutral[tile]; FRAMES];
                    let (shapes, deltas) = (&self.shapes[entries.clone()], &self.deltas[entries]);
                    add_shapes(shapes, deltas, group, &mut sums);
                    let start = tile * TILE;
                    let width = TILE.min(self.coordinates - start);
                    for (frame, sum) in out.chunks_exact_mut(self.coordinates).zip(&sums) {
                        frame[start..start + width].copy_from_slice(&sum[..width]);
                    }
                }
            }
        }
    }
}

widest! {
    /// sums += weight times deltas of every shape that any of the frames has.
    fn add_shapes(
        shapes: &[u32],
        deltas: &[[f32; TILE]],
        weights: &[[f32; FRAMES]],
        sums: &mut [[f32; TILE]; FRAMES]
    ) {
        let mut own = *sums;
        for (&shape, delta) in shapes.iter().zip(deltas) {
            let w = weights[shape as usize];
            if w != [0.0; FRAMES] {
                for f in 0..FRAMES {
                    for i in 0..TILE {
                        own[f][i] += w[f] * delta[i];
                    }
                }
            }
        }
        *sums = own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::numbers;
    use crate::skin_mesh::SparseDeltas;

    #[test]
    fn vertices_are_neutral_plus_weighted_shapes() {
        for (count, frames) in [(1, 1), (7, 3), (16, 4), (700, 9)] {
            let triples =
                |seed: f64, count: usize| numbers(3 * count, seed).as_chunks::<3>().0.to_vec();
            let positions = triples(0.1, count);
            let shapes: Vec<SparseDeltas> = (0..5)
                .map(|k| {
                    let vertices: Vec<u32> =
                        (0..count as u32).filter(|v| (v / 11 + k) % 3 != 0).collect();
                    let deltas = triples(f64::from(k), vertices.len());
                    SparseDeltas { vertices, deltas }
                })
                .collect();
            let mut weights = numbers(5 * frames, 9.0);
            weights[2] = 0.0;
            let mesh = SkinMesh { positions, triangles: vec![], shapes };
            let synthesis = Synthesis::new(&mesh);
            let mut out = vec![f32::NAN; frames * synthesis.coordinates()];
            synthesis.pose(&weights, &mut out);
            for (c, out) in weights.chunks(5).zip(out.chunks(3 * count)) {
                let mut expected = mesh.positions.clone();
                for (shape, w) in mesh.shapes.iter().zip(c) {
                    for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                        (0..3).for_each(|a| expected[v as usize][a] += w * d[a]);
                    }
                }
                for (x, y) in expected.as_flattened().iter().zip(out) {
                    assert!((x - f64::from(*y)).abs() < 2e-6, "{count} {frames}: {x} {y}");
                }
            }
        }
    }
}
