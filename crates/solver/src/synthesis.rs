//! From weights to the vertices of the skin, many frames at a time.

use crate::dense::widest;
use crate::skin_mesh::SkinMesh;

/// Coordinates that are summed together, in registers: four of the widest vectors there are.
const BLOCK: usize = 64;

/// Blocks whose shapes, some 11 KiB each, stay in a processor's second memory while all the frames
/// pass.
const BLOCKS: usize = 16;

/// Frames that pass a block while its shapes are in a processor's first memory: more would be more
/// places to write to than it follows.
const FRAMES: usize = 8;

/// 64 coordinates, where the processor's lines begin.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
struct Block([f32; BLOCK]);

/// The neutral and the shapes of a skin, cut into blocks of some 21 vertices; each has the shapes
/// that move it and no others.
///
/// A frame costs what its weights that are not 0 move. The sums have the same bits as
/// neutral + w_0 d_0 + w_1 d_1 + ... in single precision, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    shape_count: usize,
    coordinates: usize,
    /// The 3S coordinates, filled up with zeros to whole blocks.
    neutral: Vec<Block>,
    /// For each block a bit for each shape that moves it, in [`mask_words`] words.
    moved_by: Vec<u64>,
    /// Deltas of block b are `starts[b]..starts[b + 1]` of `deltas`.
    starts: Vec<usize>,
    /// Among them, the place of each shape that moves the block; blocks x N.
    places: Vec<u32>,
    deltas: Vec<Block>,
}

impl Synthesis {
    /// Frames a call of [`Synthesis::pose`] that are a good number: the shapes are read once for all of
    /// them, and what is written for a face of 11,000 vertices, 2 MiB, stays near the processor until
    /// somebody reads it.
    pub const FRAMES: usize = 16;

    /// Prepare a mesh that passes [`SkinMesh::check`]. Single precision: what is drawn.
    pub fn new(mesh: &SkinMesh) -> Synthesis {
        let coordinates = 3 * mesh.positions.len();
        let shape_count = mesh.shapes.len();
        let words = mask_words(shape_count);
        let mut neutral = vec![Block([0.0; BLOCK]); coordinates.div_ceil(BLOCK)];
        for (i, &x) in mesh.positions.as_flattened().iter().enumerate() {
            neutral[i / BLOCK].0[i % BLOCK] = x as f32;
        }
        let mut blocks: Vec<Vec<(usize, Block)>> = vec![Vec::new(); neutral.len()];
        for (k, shape) in mesh.shapes.iter().enumerate() {
            for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                for (axis, &x) in delta.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                    let i = 3 * v as usize + axis;
                    let block = &mut blocks[i / BLOCK];
                    if block.last().is_none_or(|last| last.0 != k) {
                        block.push((k, Block([0.0; BLOCK])));
                    }
                    if let Some((_, deltas)) = block.last_mut() {
                        deltas.0[i % BLOCK] = x as f32;
                    }
                }
            }
        }
        let mut moved_by = vec![0; words * blocks.len()];
        let mut places = vec![0; shape_count * blocks.len()];
        let mut starts = vec![0];
        let mut deltas = Vec::with_capacity(blocks.iter().map(Vec::len).sum());
        for (b, block) in blocks.into_iter().enumerate() {
            for (place, (k, delta)) in block.into_iter().enumerate() {
                moved_by[b * words + k / 64] |= 1 << (k % 64);
                places[b * shape_count + k] = place as u32;
                deltas.push(delta);
            }
            starts.push(deltas.len());
        }
        Synthesis { shape_count, coordinates, neutral, moved_by, starts, places, deltas }
    }

    /// 3S: the coordinates of a frame.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// neutral + sum of weight times shape, shapes in their order: `weights` is frames x N, `out`
    /// begins with frames x 3S coordinates (x, y, z of vertex 0, then of vertex 1...), metres.
    ///
    /// The shapes are read once for all the frames of a call: [`Synthesis::FRAMES`] are a good number.
    ///
    /// # Panics
    /// If `weights` is not whole frames or `out` is too short for them.
    pub fn pose(&self, weights: &[f64], out: &mut [f32]) {
        let n = self.shape_count;
        assert!(n > 0 && weights.len().is_multiple_of(n), "a frame has N weights");
        let out = &mut out[..weights.len() / n * self.coordinates];
        let weights: Vec<f32> = weights.iter().map(|&w| w as f32).collect();
        let words = mask_words(n);
        let active = active(&weights, n);
        let pose = if has_wide_registers() { pose_blocks_wide } else { pose_blocks };
        for first in (0..self.neutral.len()).step_by(BLOCKS) {
            let last = (first + BLOCKS).min(self.neutral.len());
            let frames = weights.chunks(FRAMES * n).zip(active.chunks(FRAMES * words));
            for ((weights, active), out) in frames.zip(out.chunks_mut(FRAMES * self.coordinates)) {
                pose(self, [first, last], weights, active, out);
            }
        }
    }
}

/// For each frame the set of the shapes whose weight is not 0.
fn active(weights: &[f32], n: usize) -> Vec<u64> {
    let words = mask_words(n);
    let mut active = vec![0; weights.len() / n * words];
    for (mask, weights) in active.chunks_exact_mut(words).zip(weights.chunks_exact(n)) {
        for (k, _) in weights.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            mask[k / 64] |= 1_u64 << (k % 64);
        }
    }
    active
}

/// Words of a set of shapes.
fn mask_words(shape_count: usize) -> usize {
    shape_count.div_ceil(64)
}

widest! {
    ["avx512f"]
    /// [`pose_blocks`] for the 32 wide registers of AVX-512: two frames at a time, whose shapes are
    /// read once.
    fn pose_blocks_wide(
        shapes: &Synthesis,
        blocks: [usize; 2],
        weights: &[f32],
        active: &[u64],
        out: &mut [f32]
    ) {
        let (n, words) = (shapes.shape_count, mask_words(shapes.shape_count));
        let frames = weights.chunks(2 * n).zip(active.chunks(2 * words));
        for b in blocks[0]..blocks[1] {
            let frames = frames.clone().zip(out.chunks_mut(2 * shapes.coordinates));
            for ((weights, active), out) in frames {
                if weights.len() == n {
                    pose_block::<1>(shapes, b, weights, active, out);
                } else {
                    pose_block::<2>(shapes, b, weights, active, out);
                }
            }
        }
    }
}

widest! {
    /// Blocks first..last of some frames.
    fn pose_blocks(
        shapes: &Synthesis,
        blocks: [usize; 2],
        weights: &[f32],
        active: &[u64],
        out: &mut [f32]
    ) {
        let (n, words) = (shapes.shape_count, mask_words(shapes.shape_count));
        let frames = weights.chunks_exact(n).zip(active.chunks_exact(words));
        for b in blocks[0]..blocks[1] {
            let frames = frames.clone().zip(out.chunks_exact_mut(shapes.coordinates));
            for ((weights, active), out) in frames {
                pose_block::<1>(shapes, b, weights, active, out);
            }
        }
    }
}

/// One block of G frames: the shapes that any of them has. A weight of 0 adds nothing.
#[inline(always)]
fn pose_block<const G: usize>(
    shapes: &Synthesis,
    b: usize,
    weights: &[f32],
    active: &[u64],
    out: &mut [f32],
) {
    let n = shapes.shape_count;
    let words = mask_words(n);
    let moved_by = &shapes.moved_by[b * words..][..words];
    let places = &shapes.places[b * n..][..n];
    let deltas = &shapes.deltas[shapes.starts[b]..shapes.starts[b + 1]];
    let start = b * BLOCK;
    let width = BLOCK.min(shapes.coordinates - start);
    let mut sums = [shapes.neutral[b].0; G];
    for (word, moved_by) in moved_by.iter().enumerate() {
        let any = active.iter().skip(word).step_by(words).fold(0, |any, active| any | active);
        let mut rest = moved_by & any;
        while rest != 0 {
            let k = 64 * word + rest.trailing_zeros() as usize;
            rest &= rest - 1;
            // Always there; without the possibility of a panic the sums stay in registers.
            let (Some(weights), Some(&place)) = (weights.get(k..), places.get(k)) else {
                continue;
            };
            let Some(Block(delta)) = deltas.get(place as usize) else { continue };
            let weights: [f32; G] =
                std::array::from_fn(|g| weights.get(g * n).copied().unwrap_or_default());
            for g in 0..G {
                for i in 0..BLOCK {
                    sums[g][i] += weights[g] * delta[i];
                }
            }
        }
    }
    for (sums, out) in sums.iter().zip(out.chunks_exact_mut(shapes.coordinates)) {
        let out = &mut out[start..start + width];
        match out.first_chunk_mut::<BLOCK>() {
            Some(out) => *out = *sums,
            None => out.copy_from_slice(&sums[..width]),
        }
    }
}

/// Whether two frames at a time fit into the registers.
fn has_wide_registers() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx512f");
    #[cfg(not(target_arch = "x86_64"))]
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::numbers;
    use crate::skin_mesh::SparseDeltas;

    /// Shapes that move parts of a skin of `count` vertices.
    fn skin(count: usize, shapes: usize) -> SkinMesh {
        let triples =
            |seed: f64, count: usize| numbers(3 * count, seed).as_chunks::<3>().0.to_vec();
        let shapes = (0..shapes)
            .map(|k| {
                let vertices: Vec<u32> = (0..count as u32)
                    .filter(|v| !(*v as usize / 11 + k).is_multiple_of(3))
                    .collect();
                let mut deltas = triples(k as f64, vertices.len());
                deltas.iter_mut().step_by(5).for_each(|d| d[k % 3] = 0.0);
                SparseDeltas { vertices, deltas }
            })
            .collect();
        SkinMesh { positions: triples(0.1, count), triangles: vec![], shapes }
    }

    #[test]
    fn vertices_have_the_bits_of_the_plain_sum() {
        for (count, frames, shapes) in
            [(1, 1, 5), (7, 3, 1), (64, 4, 53), (700, 9, 5), (190, 70, 131)]
        {
            let mesh = skin(count, shapes);
            let mut weights = numbers(shapes * frames, 9.0);
            weights.iter_mut().step_by(3).for_each(|w| *w = 0.0);
            let synthesis = Synthesis::new(&mesh);
            let mut out = vec![f32::NAN; frames * synthesis.coordinates() + 2];
            synthesis.pose(&weights, &mut out);
            assert!(out[frames * synthesis.coordinates()..].iter().all(|x| x.is_nan()));
            out.truncate(frames * synthesis.coordinates());
            // Both ways, whichever this processor is given.
            let single: Vec<f32> = weights.iter().map(|&w| w as f32).collect();
            let active = active(&single, shapes);
            for pose in [pose_blocks, pose_blocks_wide] {
                let mut again = vec![f32::NAN; out.len()];
                pose(&synthesis, [0, synthesis.neutral.len()], &single, &active, &mut again);
                assert_eq!(again, out);
            }
            for (c, out) in weights.chunks(shapes).zip(out.chunks_exact(3 * count)) {
                let mut expected: Vec<f32> =
                    mesh.positions.as_flattened().iter().map(|&x| x as f32).collect();
                for (shape, &w) in mesh.shapes.iter().zip(c) {
                    for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                        for a in 0..3 {
                            expected[3 * v as usize + a] += w as f32 * d[a] as f32;
                        }
                    }
                }
                assert_eq!(expected, out, "{count} vertices, {frames} frames, {shapes} shapes");
            }
        }
    }
}
