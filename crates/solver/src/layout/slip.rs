//! What a marker measures that was not put exactly on its vertex.
//!
//! Put s to the side along the skin, a marker moves with the skin there: its displacement differs from the
//! vertex's by s times the gradient of the displacement along the skin. With weights c of second moment
//! E\[cc^T\] and a slip of standard deviation `slip` along each of two orthogonal directions, that adds
//! slip^2 sum over k of g_k E\[cc^T\] g_k^T to the covariance of the measurement, g_k (3 x N) the gradient
//! along direction k.

use mimique_geometry::{DVec3, Displacement, Point};

use crate::linear_algebra::dense::dot;
use crate::mesh::skin_mesh::SkinMesh;

/// Two edges that span less than this share of a square are one direction.
const FLAT: f64 = 1e-9;

/// The gradients of a bank's displacements along its skin.
#[derive(Debug, Clone)]
pub struct SkinGradients {
    normals: Vec<DVec3>,
    /// Vertices that share an edge with each, ascending.
    neighbours: Vec<Vec<usize>>,
    positions: Vec<Point>,
}

impl SkinGradients {
    /// Of a mesh that passes [`SkinMesh::check`].
    pub fn new(mesh: &SkinMesh) -> Self {
        let count = mesh.positions.len();
        let mut neighbours = vec![Vec::new(); count];
        for t in &mesh.triangles {
            for k in 0..3 {
                let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
                neighbours[a].push(b);
                neighbours[b].push(a);
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self { normals: normals(mesh), neighbours, positions: mesh.positions.clone() }
    }

    /// Two orthogonal unit vectors along the skin at a vertex; none at a vertex of no triangle.
    pub fn tangents(&self, vertex: usize) -> Option<[Displacement; 2]> {
        let normal = self.normals[vertex].try_normalize()?;
        let (u, v) = normal.any_orthonormal_pair();
        Some([Displacement(u), Displacement(v)])
    }

    /// The unit normal of the skin at a vertex, outwards; none at a vertex of no triangle.
    pub fn normal(&self, vertex: usize) -> Option<Displacement> {
        self.normals[vertex].try_normalize().map(Displacement)
    }

    /// The vertices that share an edge with one, ascending.
    pub fn neighbours(&self, vertex: usize) -> &[usize] {
        &self.neighbours[vertex]
    }

    /// g_1 and g_2 of a vertex, each 3 x N row-major, without unit: the slope along the two tangents of the
    /// field that is nearest to the displacements of the neighbours in least squares.
    ///
    /// `deltas` is vertices x 3 x N, metres. A vertex whose edges all lie in one direction has a slope in
    /// that direction alone.
    pub fn gradients(&self, vertex: usize, deltas: &[f64], shape_count: usize) -> [Vec<f64>; 2] {
        let width = 3 * shape_count;
        let mut gradients = [vec![0.0; width], vec![0.0; width]];
        let Some(tangents) = self.tangents(vertex) else { return gradients };
        let edges: Vec<[f64; 2]> = (self.neighbours[vertex].iter())
            .map(|&j| {
                let edge = self.positions[j] - self.positions[vertex];
                tangents.map(|t| edge.dot(t))
            })
            .collect();
        let [mut uu, mut uv, mut vv] = [0.0; 3];
        for [u, v] in &edges {
            uu += u * u;
            uv += u * v;
            vv += v * v;
        }
        let Some(inverse) = inverse([uu, uv, vv]) else { return gradients };
        let own = &deltas[vertex * width..(vertex + 1) * width];
        for (&j, [u, v]) in self.neighbours[vertex].iter().zip(&edges) {
            let [xx, xy, yy] = inverse;
            let slopes = [xx * u + xy * v, xy * u + yy * v];
            let there = &deltas[j * width..(j + 1) * width];
            for (gradient, slope) in gradients.iter_mut().zip(slopes) {
                for ((g, to), from) in gradient.iter_mut().zip(there).zip(own) {
                    *g += slope * (to - from);
                }
            }
        }
        gradients
    }

    /// The covariance of what a marker at a vertex measures beside the vertex's own motion, 3 x 3, square
    /// metres: noise^2 on the diagonal and the slip's part.
    ///
    /// `noise` and `slip` are standard deviations, metres; `second_moment` is E\[cc^T\], N x N.
    ///
    /// # Panics
    /// If sizes disagree.
    pub fn measurement_covariance(
        &self,
        vertex: usize,
        deltas: &[f64],
        second_moment: &[f64],
        [noise, slip]: [f64; 2],
    ) -> [[f64; 3]; 3] {
        let n = second_moment.len().isqrt();
        let mut covariance = [[0.0; 3]; 3];
        for gradient in self.gradients(vertex, deltas, n) {
            // M g^T: the second moment is symmetric.
            let products: Vec<Vec<f64>> = (gradient.chunks_exact(n))
                .map(|row| second_moment.chunks_exact(n).map(|m| dot(m, row)).collect())
                .collect();
            for (a, row) in gradient.chunks_exact(n).enumerate() {
                for (b, product) in products.iter().enumerate() {
                    covariance[a][b] += slip * slip * dot(row, product);
                }
            }
        }
        (0..3).for_each(|a| covariance[a][a] += noise * noise);
        covariance
    }
}

/// Sum of the triangles' cross products at each vertex: the normal times twice the area around it.
fn normals(mesh: &SkinMesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        let cross = (b - a).cross(c - a).0;
        t.iter().for_each(|&v| sums[v as usize] += cross);
    }
    sums
}

/// The inverse of the symmetric matrix ((a, b), (b, c)), or its pseudo-inverse where it has rank one; none
/// where it is 0. Three numbers, as given.
fn inverse([a, b, c]: [f64; 3]) -> Option<[f64; 3]> {
    let (determinant, trace) = (a * c - b * b, a + c);
    if !(trace > 0.0) {
        return None;
    }
    if determinant > FLAT * trace * trace {
        return Some([c / determinant, -b / determinant, a / determinant]);
    }
    let square = trace * trace;
    Some([a / square, b / square, c / square])
}
