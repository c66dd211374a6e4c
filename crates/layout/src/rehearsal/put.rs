//! Where a marker really sits that was meant for a vertex.

use mimique_geometry::Point;
use mimique_solver::{MarkerSite, SkinMesh};

use crate::draws::draws;
use crate::face::Face;

/// The triangles around each vertex.
#[derive(Debug, Clone)]
pub struct TrianglesAround {
    of: Vec<Vec<usize>>,
}

impl TrianglesAround {
    /// Of a mesh.
    pub fn of(mesh: &SkinMesh) -> Self {
        let mut of = vec![Vec::new(); mesh.positions.len()];
        for (number, t) in mesh.triangles.iter().enumerate() {
            t.iter().for_each(|&v| of[v as usize].push(number));
        }
        Self { of }
    }

    /// Triangles with a corner within a distance (metres) of a vertex, along the skin.
    fn within(&self, face: &Face<'_>, vertex: usize, distance: f64) -> Vec<usize> {
        let (mut seen, mut next) = (vec![vertex], vec![vertex]);
        while let Some(v) = next.pop() {
            for &other in face.gradients.neighbours(v) {
                let near = (face.place(other) - face.place(vertex)).length() <= distance;
                if near && !seen.contains(&other) {
                    seen.push(other);
                    next.push(other);
                }
            }
        }
        let mut found: Vec<usize> = seen.iter().flat_map(|&v| &self.of[v]).copied().collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// The place of a marker that is put beside a vertex by a hand with a standard deviation of `slip` metres along
/// each direction of the skin; `take` numbers the session, in which it is put anew.
pub fn put(
    face: &Face<'_>,
    around: &TrianglesAround,
    vertex: usize,
    slip: f64,
    seed: u64,
    take: usize,
) -> MarkerSite {
    let label = String::new();
    let tangents = face.gradients.tangents(vertex).filter(|_| slip > 0.0);
    let Some([u, v]) = tangents else { return MarkerSite::at_vertex(label, vertex) };
    let mut draws = draws(seed, &format!("put {take} {vertex}"));
    let (a, b) = (slip * draws.normal(), slip * draws.normal());
    let meant = face.place(vertex);
    let reach = 1.5 * a.hypot(b) + 0.002;
    let aim: Point = meant + u * a + v * b;
    let near = around.within(face, vertex, reach);
    match face.skin.mesh.nearest_on_triangles(aim, near) {
        Some(at) => MarkerSite { label, corners: at.corners, weights: at.weights },
        None => MarkerSite::at_vertex(label, vertex),
    }
}
