//! The thin shell on blendshapes: A = -k_s L + k_b L L (eq. 5.17), AB (eq. 5.29), and its Gram
//! matrix H over the vertices without a marker (eq. 5.28-5.30).

use crate::laplacian::Laplacian;
use crate::skin_mesh::SkinMesh;

/// A applied to one scalar field: -k_s L f + k_b L (L f), S numbers.
///
/// # Panics
/// If `f` does not have one entry a vertex.
pub fn apply_shell(laplacian: &Laplacian, k_s: f64, k_b: f64, f: &[f64]) -> Vec<f64> {
    let lf = laplacian.apply(f);
    let llf = laplacian.apply(&lf);
    lf.iter().zip(&llf).map(|(l, ll)| k_b * ll - k_s * l).collect()
}

/// The rows of AB: call `row(vertex, &values)` for each vertex in order, with 3N values, coordinate
/// first (`values[axis * n + shape]`).
pub(crate) fn for_each_ab_row(
    mesh: &SkinMesh,
    laplacian: &Laplacian,
    k_s: f64,
    k_b: f64,
    mut row: impl FnMut(usize, &[f64]),
) {
    let n = mesh.shapes.len();
    let width = 3 * n;
    let by_vertex = EntriesByVertex::new(mesh);
    let mut first = vec![0.0; mesh.positions.len() * width];
    for (i, out) in first.chunks_exact_mut(width).enumerate() {
        for (j, w) in laplacian.row(i) {
            for &(column, value) in by_vertex.row(j) {
                out[column as usize] += w * value;
            }
            for &(column, value) in by_vertex.row(i) {
                out[column as usize] -= w * value;
            }
        }
    }
    let mut out = vec![0.0; width];
    for i in 0..mesh.positions.len() {
        let here = &first[i * width..(i + 1) * width];
        for (o, h) in out.iter_mut().zip(here) {
            *o = -k_s * h;
        }
        for (j, w) in laplacian.row(i) {
            let there = &first[j * width..(j + 1) * width];
            let w = k_b * w;
            for ((o, t), h) in out.iter_mut().zip(there).zip(here) {
                *o += w * (t - h);
            }
        }
        row(i, &out);
    }
}

/// H = sum over vertices without a face marker of AB^T AB, N x N, row-major, m^2 (for weights
/// without a unit).
///
/// `marker_vertices` are the vertices left out. Costs O(S); everything after it costs nothing in S.
pub fn shell_gram(
    mesh: &SkinMesh,
    laplacian: &Laplacian,
    k_s: f64,
    k_b: f64,
    marker_vertices: &[usize],
) -> Vec<f64> {
    let n = mesh.shapes.len();
    let mut has_marker = vec![false; mesh.positions.len()];
    for &v in marker_vertices {
        has_marker[v] = true;
    }
    let mut gram = vec![0.0; n * n];
    let mut nonzero = Vec::with_capacity(n);
    for_each_ab_row(mesh, laplacian, k_s, k_b, |vertex, values| {
        if has_marker[vertex] {
            return;
        }
        for axis in values.chunks_exact(n) {
            nonzero.clear();
            nonzero.extend((0..n).filter(|&k| axis[k] != 0.0));
            for (at, &i) in nonzero.iter().enumerate() {
                let row = &mut gram[i * n..(i + 1) * n];
                for &j in &nonzero[at..] {
                    row[j] += axis[i] * axis[j];
                }
            }
        }
    });
    for i in 0..n {
        for j in 0..i {
            gram[i * n + j] = gram[j * n + i];
        }
    }
    gram
}

/// The shapes' deltas vertex by vertex: entries (axis * n + shape, value).
struct EntriesByVertex {
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl EntriesByVertex {
    fn new(mesh: &SkinMesh) -> EntriesByVertex {
        let n = mesh.shapes.len();
        let mut starts = vec![0_usize; mesh.positions.len() + 1];
        for &v in mesh.shapes.iter().flat_map(|s| &s.vertices) {
            starts[v as usize + 1] += 3;
        }
        for i in 0..mesh.positions.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0.0); starts[mesh.positions.len()]];
        for (k, shape) in mesh.shapes.iter().enumerate() {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                for (axis, &value) in d.iter().enumerate() {
                    entries[next[v as usize]] = ((axis * n + k) as u32, value);
                    next[v as usize] += 1;
                }
            }
        }
        EntriesByVertex { starts, entries }
    }

    fn row(&self, vertex: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[vertex]..self.starts[vertex + 1]]
    }
}
