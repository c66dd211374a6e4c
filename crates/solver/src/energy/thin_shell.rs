//! The thin shell on blendshapes: A = -k_s L + k_b L L (eq. 5.17), AB (eq. 5.29), and its Gram
//! matrix H over the vertices without a marker (eq. 5.28-5.30).

use std::ops::Range;

use crate::energy::shell_patch::{DeltasByVertex, ShellPatch};
use crate::linear_algebra::dense::widest;
use crate::mesh::laplacian::Laplacian;
use crate::mesh::skin_mesh::SkinMesh;

/// Vertices whose part of H is summed by itself; the parts are then added in their order. A
/// constant, so that the bits do not depend on how many threads share the mesh.
const CHUNK_VERTICES: usize = 2048;

/// Vertices whose rows of AB are made before they are summed: 48 rows of 53 shapes are 20 KiB,
/// which the processor's nearest memory holds.
const BATCH_VERTICES: usize = 16;

/// A applied to one scalar field: -k_s L f + k_b L (L f), S numbers.
///
/// # Panics
/// If `f` does not have one entry per vertex.
pub fn apply_shell(laplacian: &Laplacian, k_s: f64, k_b: f64, f: &[f64]) -> Vec<f64> {
    let lf = laplacian.apply(f);
    let llf = laplacian.apply(&lf);
    lf.iter().zip(&llf).map(|(l, ll)| k_b * ll - k_s * l).collect()
}

/// H = sum over vertices without a face marker of AB^T AB, N x N, row-major, m^2 (for weights
/// without a unit).
///
/// `marker_vertices` are the vertices left out. Costs O(S) time; beside the mesh itself, memory
/// for an index of 8 bytes a delta and for one patch of the mesh a thread. Everything after it
/// costs nothing in S.
pub fn shell_gram(
    mesh: &SkinMesh,
    laplacian: &Laplacian,
    k_s: f64,
    k_b: f64,
    marker_vertices: &[usize],
) -> Vec<f64> {
    let n = mesh.shapes.len();
    let count = mesh.positions.len();
    let mut has_marker = vec![false; count];
    for &v in marker_vertices {
        has_marker[v] = true;
    }
    let deltas = DeltasByVertex::new(mesh);
    let one = |chunk: usize| {
        let start = chunk * CHUNK_VERTICES;
        let vertices = start..(start + CHUNK_VERTICES).min(count);
        let patch = ShellPatch::new(mesh, &deltas, laplacian, vertices.clone())?;
        Some(patch_gram(&patch, vertices, &has_marker, k_s, k_b))
    };
    let chunks = 0..count.div_ceil(CHUNK_VERTICES);
    #[cfg(feature = "parallel")]
    let parts: Vec<Option<PatchGram>> = {
        use rayon::prelude::*;
        chunks.into_par_iter().map(one).collect()
    };
    #[cfg(not(feature = "parallel"))]
    let parts = chunks.map(one);

    let mut gram = vec![0.0; n * n];
    for part in parts.into_iter().flatten() {
        let width = part.shapes.len().next_multiple_of(4);
        for (a, &i) in part.shapes.iter().enumerate() {
            for (b, &j) in part.shapes.iter().enumerate().skip(a) {
                gram[i * n + j] += part.upper[a * width + b];
            }
        }
    }
    for i in 0..n {
        for j in 0..i {
            gram[i * n + j] = gram[j * n + i];
        }
    }
    gram
}

/// A patch's part of H.
struct PatchGram {
    shapes: Vec<usize>,
    /// Row-major, rows of the number of shapes filled up to a multiple of four; what is left of the
    /// diagonal means nothing.
    upper: Vec<f64>,
}

fn patch_gram(
    patch: &ShellPatch<'_>,
    vertices: Range<usize>,
    has_marker: &[bool],
    k_s: f64,
    k_b: f64,
) -> PatchGram {
    let width = patch.padded;
    let mut upper = vec![0.0; width * width];
    let mut rows = vec![0.0; BATCH_VERTICES * 3 * width];
    let mut free = vertices.filter(|&v| !has_marker[v]).peekable();
    let mut moving = Vec::with_capacity(width / 4);
    while free.peek().is_some() {
        let mut filled = 0;
        // In this order: the other one would take a vertex too many.
        for (row, vertex) in rows.chunks_exact_mut(3 * width).zip(free.by_ref()) {
            patch.ab_row(vertex, k_s, k_b, row);
            filled += row.len();
        }
        moving.clear();
        moving.extend((0..width).step_by(4).filter(|&column| {
            rows[..filled].chunks_exact(width).any(|r| r[column..column + 4] != [0.0; 4])
        }));
        add_grams(&rows[..filled], width, &moving, &mut upper);
    }
    PatchGram { shapes: patch.shapes.clone(), upper }
}

widest! {
    /// upper += rows^T rows, a block of 4 x 8 numbers at a time, each number by itself in the order
    /// of the rows. `moving` has the first columns of the fours of columns that are not all 0.
    fn add_grams(rows: &[f64], width: usize, moving: &[usize], upper: &mut [f64]) {
        for (at, &i) in moving.iter().enumerate() {
            for pair in moving[at..].chunks(2) {
                let j = [pair[0], pair[pair.len() - 1]];
                let mut sums = [[[0.0; 4]; 2]; 4];
                for r in 0..4 {
                    for h in 0..2 {
                        let from = (i + r) * width + j[h];
                        sums[r][h].copy_from_slice(&upper[from..from + 4]);
                    }
                }
                for row in rows.chunks_exact(width) {
                    let a: [f64; 4] = [row[i], row[i + 1], row[i + 2], row[i + 3]];
                    for h in 0..2 {
                        let b: &[f64] = &row[j[h]..j[h] + 4];
                        for r in 0..4 {
                            for c in 0..4 {
                                sums[r][h][c] += a[r] * b[c];
                            }
                        }
                    }
                }
                for r in 0..4 {
                    for h in 0..pair.len() {
                        let to = (i + r) * width + j[h];
                        upper[to..to + 4].copy_from_slice(&sums[r][h]);
                    }
                }
            }
        }
    }
}
