//! Kouadio's associations of the face's points with the markers (4.3.1), reduced to what a frame
//! needs.
//!
//! A vertex v is pulled by some markers with weights w_vm that add up to 1:
//!
//! - [`VertexAssociation::Points`], eq. 4.3: the vertex of a marker follows it, no other does;
//! - [`VertexAssociation::Zones`], eq. 4.4-4.7: every marker within sigma, exp(-r^2 / sigma^2) normalised;
//! - [`VertexAssociation::Triangles`], eq. 4.8-4.11: the corners of the nearest triangle of the mask, by the
//!   barycentric coordinates of the vertex's projection.
//!
//! The bank is fitted to the mean of those pulls: minimise sum over v of |B_v c - sum over m of
//! w_vm d_m|^2. As the w_vm of a vertex add up to 1, this is, up to a constant,
//! sum over m of sum over v of w_vm |B_v c - d_m|^2: a sum over *markers*. So a marker's importance
//! (A_i of eq. 4.6) multiplies its term, and a lost marker's term is dropped: the mean is then over
//! the others and the row counts by what is left of it. Nothing of size S is kept.

use mimique_geometry::{Displacement, Point};

use crate::kouadio::marker_triangles::triangulate_markers;
use crate::linear_algebra::dense::packed_len;
use crate::mesh::marker_site::{MarkerSite, barycentric, nearest_in_triangle};
use crate::mesh::skin_mesh::SkinMesh;

/// Which points of the face a marker moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VertexAssociation {
    /// Its own alone.
    Points,
    /// All within a radius, by a Gaussian of their distance.
    Zones {
        /// Radius and standard deviation, metres.
        sigma: f64,
    },
    /// Those over the triangles between it and its neighbours.
    Triangles,
}

/// The associated rows of the bank, summed by marker.
#[derive(Debug, Clone, PartialEq)]
pub struct AssociatedRows {
    /// How they are associated.
    pub association: VertexAssociation,
    /// How many vertices (for [`VertexAssociation::Points`] markers) are associated with at least one marker.
    pub vertex_count: usize,
    /// For each marker the upper triangle of sum over v of w_vm B_v^T B_v, row by row:
    /// P x N(N+1)/2, m^2.
    pub grams: Vec<f64>,
    /// For each marker sum over v of w_vm B_v: 3P x N, marker-major rows, metres.
    pub sums: Vec<f64>,
}

impl AssociatedRows {
    /// Link the vertices of a mesh to markers; distances are Euclidean, on the neutral.
    pub fn build(
        mesh: &SkinMesh,
        sites: &[MarkerSite],
        association: VertexAssociation,
    ) -> AssociatedRows {
        let n = mesh.shapes.len();
        let mut rows = AssociatedRows {
            association,
            vertex_count: 0,
            grams: vec![0.0; sites.len() * packed_len(n)],
            sums: vec![0.0; 3 * sites.len() * n],
        };
        let markers: Vec<Point> = sites.iter().map(|s| s.position(mesh)).collect();
        let deltas = deltas_by_vertex(mesh);
        match association {
            VertexAssociation::Points => {
                for (m, site) in sites.iter().enumerate() {
                    let moves: Vec<(usize, Displacement)> =
                        (0..n).map(|k| (k, site.delta(mesh, k))).collect();
                    rows.add(&moves, &[(m, 1.0)], n);
                }
            }
            VertexAssociation::Zones { sigma } => {
                for (p, moves) in mesh.positions.iter().zip(&deltas) {
                    rows.add(moves, &zones(*p, &markers, sigma), n);
                }
            }
            VertexAssociation::Triangles => {
                let triangles = triangulate_markers(&markers);
                for (p, moves) in mesh.positions.iter().zip(&deltas) {
                    rows.add(moves, &corners(*p, &markers, &triangles), n);
                }
            }
        }
        rows
    }

    /// One point of the face, what the shapes do to it, and the markers that pull it; their weights
    /// are normalised here (eq. 4.5).
    fn add(&mut self, moves: &[(usize, Displacement)], pulls: &[(usize, f64)], n: usize) {
        if pulls.is_empty() {
            return;
        }
        self.vertex_count += 1;
        let total: f64 = pulls.iter().map(|p| p.1).sum();
        for &(m, pull) in pulls {
            let w = pull / total;
            let gram = &mut self.grams[m * packed_len(n)..(m + 1) * packed_len(n)];
            for (at, &(i, di)) in moves.iter().enumerate() {
                for (a, x) in di.to_array().into_iter().enumerate() {
                    self.sums[(3 * m + a) * n + i] += w * x;
                }
                for &(j, dj) in &moves[at..] {
                    gram[packed_index(n, i, j)] += w * di.dot(dj);
                }
            }
        }
    }

    /// The same over some of the n shapes.
    pub(crate) fn restricted(&self, shapes: &[usize], n: usize) -> AssociatedRows {
        let mut grams = Vec::new();
        for gram in self.grams.chunks_exact(packed_len(n)) {
            for (at, &i) in shapes.iter().enumerate() {
                grams.extend(shapes[at..].iter().map(|&j| gram[packed_index(n, i, j)]));
            }
        }
        let sums =
            (self.sums.chunks_exact(n)).flat_map(|row| shapes.iter().map(|&k| row[k])).collect();
        AssociatedRows { sums, grams, ..*self }
    }
}

/// Index of (i, j), i <= j, in a packed upper triangle.
pub(crate) fn packed_index(n: usize, i: usize, j: usize) -> usize {
    i * (2 * n - i + 1) / 2 + j - i
}

/// Eq. 4.6 with A_i = 1, over the markers whose zone holds the point.
fn zones(p: Point, markers: &[Point], sigma: f64) -> Vec<(usize, f64)> {
    let mut pulls = Vec::new();
    for (m, q) in markers.iter().enumerate() {
        let r2 = (p - *q).length_squared();
        if r2.sqrt() <= sigma {
            pulls.push((m, libm::exp(-r2 / (sigma * sigma))));
        }
    }
    pulls
}

/// Eq. 4.9: the corners of the nearest triangle of the mask, if the point lies over its inside and
/// no further off than half its longest edge. The others are Kouadio's free points.
fn corners(p: Point, markers: &[Point], triangles: &[[usize; 3]]) -> Vec<(usize, f64)> {
    let mut best: Option<([usize; 3], [f64; 3], f64)> = None;
    for &t in triangles {
        let [a, b, c] = t.map(|m| markers[m]);
        let weights = nearest_in_triangle(p, [a, b, c]);
        let distance = (p - barycentric([a, b, c], weights)).length();
        if best.is_none_or(|(_, _, least)| distance < least) {
            best = Some((t, weights, distance));
        }
    }
    let Some((t, weights, distance)) = best else { return Vec::new() };
    let [a, b, c] = t.map(|m| markers[m]);
    let edge = |x: Point, y: Point| (x - y).length();
    let longest = edge(a, b).max(edge(b, c)).max(edge(c, a));
    // A point that is nearest to the rim lies beside the mask, unless it is on the rim.
    let beside = weights.contains(&0.0) && distance > 1e-6 * longest;
    if beside || distance > 0.5 * longest {
        return Vec::new();
    }
    t.into_iter().zip(weights).filter(|(_, w)| *w > 0.0).collect()
}

/// For each vertex the shapes that move it, ascending, with their deltas.
fn deltas_by_vertex(mesh: &SkinMesh) -> Vec<Vec<(usize, Displacement)>> {
    let mut out = vec![Vec::new(); mesh.positions.len()];
    for (k, shape) in mesh.shapes.iter().enumerate() {
        for (&v, &d) in shape.vertices.iter().zip(&shape.deltas) {
            if d != Displacement::ZERO {
                out[v as usize].push((k, d));
            }
        }
    }
    out
}
