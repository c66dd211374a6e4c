//! From weights to the vertices of the skin, many frames at a time.

use mimique_geometry::coordinates;

use crate::linear_algebra::dense::widest;
use crate::mesh::skin_mesh::SkinMesh;

/// Coordinates that are summed together, in registers: four of the widest vectors there are.
const BLOCK: usize = 64;

/// 64 coordinates, where the processor's lines begin.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
struct Block([f32; BLOCK]);

/// The neutral and the shapes of a skin, cut into blocks of some 21 vertices; each has the shapes
/// that move it and no others.
///
/// A frame costs what its weights that are not 0 move. The sums have the bits of
/// neutral + w_0 d_0 + w_1 d_1 + ... in single precision, one after the other, each product added
/// before it is rounded (fused): the same on every processor, slow on those that must do it in
/// software.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    shape_count: usize,
    coordinates: usize,
    /// The 3S coordinates, filled up with zeros to whole blocks.
    neutral: Vec<Block>,
    /// For each block a bit for each shape that moves it, in words of 64 shapes.
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
        let count = 3 * mesh.positions.len();
        let shape_count = mesh.shapes.len();
        let words = shape_count.div_ceil(64);
        let mut neutral = vec![Block([0.0; BLOCK]); count.div_ceil(BLOCK)];
        for (i, &x) in coordinates(&mesh.positions).iter().enumerate() {
            neutral[i / BLOCK].0[i % BLOCK] = x as f32;
        }
        let mut blocks: Vec<Vec<(usize, Block)>> = vec![Vec::new(); neutral.len()];
        for (k, shape) in mesh.shapes.iter().enumerate() {
            for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                for (axis, x) in delta.to_array().into_iter().enumerate().filter(|(_, x)| *x != 0.0)
                {
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
        Synthesis { shape_count, coordinates: count, neutral, moved_by, starts, places, deltas }
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
        let pose = if has_wide_registers() { pose_frames_wide } else { pose_frames };
        let frames = weights.chunks(Self::FRAMES * n);
        for (weights, out) in frames.zip(out.chunks_mut(Self::FRAMES * self.coordinates)) {
            pose(self, weights, out);
        }
    }
}

widest! {
    ["avx512f"]
    /// [`pose_frames`] for the 32 wide registers of AVX-512: four frames at a time, for which the
    /// shapes are read once.
    fn pose_frames_wide(shapes: &Synthesis, weights: &[f64], out: &mut [f32]) {
        pose_groups::<4>(shapes, weights, out);
    }
}

widest! {
    ["fma"]
    /// Some frames, one at a time.
    fn pose_frames(shapes: &Synthesis, weights: &[f64], out: &mut [f32]) {
        pose_groups::<1>(shapes, weights, out);
    }
}

/// The weights of G frames.
struct Group<const G: usize> {
    /// The shapes that any of the frames has, in words of 64 shapes.
    any: Vec<u64>,
    /// The weights of each shape; 0 where there are fewer frames.
    weights: Vec<[f32; G]>,
}

impl<const G: usize> Group<G> {
    fn of(weights: &[f64], n: usize) -> Self {
        let weight = |g: usize, k: usize| weights.get(g * n + k).map_or(0.0, |&w| w as f32);
        let weights: Vec<[f32; G]> =
            (0..n).map(|k| std::array::from_fn(|g| weight(g, k))).collect();
        let mut any = vec![0; n.div_ceil(64)];
        for (k, _) in weights.iter().enumerate().filter(|(_, w)| **w != [0.0; G]) {
            any[k / 64] |= 1_u64 << (k % 64);
        }
        Self { any, weights }
    }
}

/// Block after block, so that its shapes stay in a processor's first memory while the frames pass.
#[inline(always)]
fn pose_groups<const G: usize>(shapes: &Synthesis, weights: &[f64], out: &mut [f32]) {
    let n = shapes.shape_count;
    let groups: Vec<Group<G>> = weights.chunks(G * n).map(|own| Group::of(own, n)).collect();
    for b in 0..shapes.neutral.len() {
        for (group, out) in groups.iter().zip(out.chunks_mut(G * shapes.coordinates)) {
            pose_block(shapes, b, group, out);
        }
    }
}

/// One block of some frames. A weight of 0 adds nothing.
#[inline(always)]
fn pose_block<const G: usize>(shapes: &Synthesis, b: usize, group: &Group<G>, out: &mut [f32]) {
    let n = shapes.shape_count;
    let words = group.any.len();
    let moved_by = &shapes.moved_by[b * words..][..words];
    let places = &shapes.places[b * n..][..n];
    let deltas = &shapes.deltas[shapes.starts[b]..shapes.starts[b + 1]];
    let start = b * BLOCK;
    let width = BLOCK.min(shapes.coordinates - start);
    let mut sums = [shapes.neutral[b].0; G];
    for (word, (moved_by, any)) in moved_by.iter().zip(&group.any).enumerate() {
        let mut rest = moved_by & any;
        while rest != 0 {
            let k = 64 * word + rest.trailing_zeros() as usize;
            rest &= rest - 1;
            // Always there; without the possibility of a panic the sums stay in registers.
            let (Some(weights), Some(&place)) = (group.weights.get(k), places.get(k)) else {
                continue;
            };
            let Some(Block(delta)) = deltas.get(place as usize) else { continue };
            for g in 0..G {
                for i in 0..BLOCK {
                    sums[g][i] = weights[g].mul_add(delta[i], sums[g][i]);
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

/// Whether four frames at a time fit into the registers.
fn has_wide_registers() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx512f");
    #[cfg(not(target_arch = "x86_64"))]
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_geometry::Displacement;

    use crate::linear_algebra::dense::numbers;
    use crate::mesh::skin_mesh::SparseDeltas;

    /// Shapes that move parts of a skin of `count` vertices.
    fn skin(count: usize, shapes: usize) -> SkinMesh {
        fn triples<T: From<[f64; 3]>>(seed: f64, count: usize) -> Vec<T> {
            numbers(3 * count, seed).as_chunks::<3>().0.iter().map(|&p| T::from(p)).collect()
        }
        let shapes = (0..shapes)
            .map(|k| {
                let vertices: Vec<u32> = (0..count as u32)
                    .filter(|v| !(*v as usize / 11 + k).is_multiple_of(3))
                    .collect();
                let mut deltas: Vec<Displacement> = triples(k as f64, vertices.len());
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
            for pose in [pose_frames, pose_frames_wide] {
                let mut again = vec![f32::NAN; out.len()];
                pose(&synthesis, &weights, &mut again);
                assert_eq!(again, out);
            }
            for (c, out) in weights.chunks(shapes).zip(out.chunks_exact(3 * count)) {
                let mut expected: Vec<f32> =
                    coordinates(&mesh.positions).iter().map(|&x| x as f32).collect();
                for (shape, &w) in mesh.shapes.iter().zip(c) {
                    for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                        for a in 0..3 {
                            let sum = &mut expected[3 * v as usize + a];
                            *sum = (w as f32).mul_add(d[a] as f32, *sum);
                        }
                    }
                }
                assert_eq!(expected, out, "{count} vertices, {frames} frames, {shapes} shapes");
            }
        }
    }
}
