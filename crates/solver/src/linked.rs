//! Kouadio's Gaussian zones (eq. 4.4-4.7), reduced to what a frame needs.
//!
//! A vertex v is linked to the markers within sigma of it; marker m pulls it with
//! w_vm = exp(-r^2 / sigma^2), normalised to 1 over the vertex's markers. The bank is fitted to
//! the mean of those pulls: minimise sum over v of |B_v c - sum over m of w_vm d_m|^2. As the w_vm
//! of a vertex add up to 1, this is, up to a constant,
//! sum over m of sum over v of w_vm |B_v c - d_m|^2: a sum over *markers*. So a marker's importance
//! (A_i of eq. 4.6) multiplies its term, and a lost marker's term is dropped: the mean is then over
//! the others and the row counts by what is left of it. Nothing of size S is kept.

use crate::dense::packed_len;
use crate::skin_mesh::SkinMesh;

/// The linked rows of the bank, summed by marker.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkedRows {
    /// Radius of a zone, metres.
    pub sigma: f64,
    /// How many vertices are linked to at least one marker.
    pub vertex_count: usize,
    /// For each marker the upper triangle of sum over v of w_vm B_v^T B_v, row by row:
    /// P x N(N+1)/2, m^2.
    pub grams: Vec<f64>,
    /// For each marker sum over v of w_vm B_v: 3P x N, marker-major rows, metres.
    pub sums: Vec<f64>,
}

impl LinkedRows {
    /// Link the vertices of a mesh to the markers at `marker_vertices`, Euclidean distance on the
    /// neutral, `sigma` in metres.
    pub fn build(mesh: &SkinMesh, marker_vertices: &[usize], sigma: f64) -> LinkedRows {
        let n = mesh.shapes.len();
        let mut grams = vec![0.0; marker_vertices.len() * packed_len(n)];
        let mut sums = vec![0.0; 3 * marker_vertices.len() * n];
        let mut vertex_count = 0;
        let mut pulls: Vec<(usize, f64)> = Vec::new();
        let deltas = deltas_by_vertex(mesh);
        for (p, moves) in mesh.positions.iter().zip(&deltas) {
            pulls.clear();
            for (m, &vertex) in marker_vertices.iter().enumerate() {
                let q = mesh.positions[vertex];
                let r2 = (0..3).fold(0.0, |s, a| s + (p[a] - q[a]) * (p[a] - q[a]));
                if r2.sqrt() <= sigma {
                    pulls.push((m, libm::exp(-r2 / (sigma * sigma))));
                }
            }
            if pulls.is_empty() {
                continue;
            }
            vertex_count += 1;
            let total: f64 = pulls.iter().map(|p| p.1).sum();
            for &(m, pull) in &pulls {
                let w = pull / total;
                let gram = &mut grams[m * packed_len(n)..(m + 1) * packed_len(n)];
                for (at, &(i, di)) in moves.iter().enumerate() {
                    for (a, x) in di.iter().enumerate() {
                        sums[(3 * m + a) * n + i] += w * x;
                    }
                    for &(j, dj) in &moves[at..] {
                        gram[packed_index(n, i, j)] +=
                            w * (di[0] * dj[0] + di[1] * dj[1] + di[2] * dj[2]);
                    }
                }
            }
        }
        LinkedRows { sigma, vertex_count, grams, sums }
    }

    /// The same over some of the n shapes.
    pub(crate) fn restricted(&self, shapes: &[usize], n: usize) -> LinkedRows {
        let mut grams = Vec::new();
        for gram in self.grams.chunks_exact(packed_len(n)) {
            for (at, &i) in shapes.iter().enumerate() {
                grams.extend(shapes[at..].iter().map(|&j| gram[packed_index(n, i, j)]));
            }
        }
        let sums =
            (self.sums.chunks_exact(n)).flat_map(|row| shapes.iter().map(|&k| row[k])).collect();
        LinkedRows { sums, grams, ..*self }
    }
}

/// Index of (i, j), i <= j, in a packed upper triangle.
pub(crate) fn packed_index(n: usize, i: usize, j: usize) -> usize {
    i * (2 * n - i + 1) / 2 + j - i
}

/// For each vertex the shapes that move it, ascending, with their deltas.
fn deltas_by_vertex(mesh: &SkinMesh) -> Vec<Vec<(usize, [f64; 3])>> {
    let mut out = vec![Vec::new(); mesh.positions.len()];
    for (k, shape) in mesh.shapes.iter().enumerate() {
        for (&v, &d) in shape.vertices.iter().zip(&shape.deltas) {
            if d != [0.0; 3] {
                out[v as usize].push((k, d));
            }
        }
    }
    out
}
