//! Where a marker sits on the skin: at a vertex, or inside a triangle by barycentric coordinates
//! (Kouadio 4.3.1, eq. 4.8-4.11).

use mimique_geometry::{DVec3, Displacement, Point};

use crate::mesh::skin_mesh::SkinMesh;

/// A marker's place on a welded skin: P = sum of `weights[i]` times the vertex `corners[i]`.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerSite {
    /// The marker.
    pub label: String,
    /// Vertices of the welded mesh; a marker at a vertex names it three times.
    pub corners: [usize; 3],
    /// Barycentric coordinates (r, u, v): 0 to 1, adding up to 1.
    pub weights: [f64; 3],
}

/// The nearest point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The triangle's corners.
    pub corners: [usize; 3],
    /// Barycentric coordinates of the point.
    pub weights: [f64; 3],
    /// The point, metres.
    pub position: Point,
    /// How far it is from the point that was asked for, metres.
    pub distance: f64,
}

impl MarkerSite {
    /// A marker at a vertex.
    pub fn at_vertex(label: impl Into<String>, vertex: usize) -> MarkerSite {
        MarkerSite { label: label.into(), corners: [vertex; 3], weights: [1.0, 0.0, 0.0] }
    }

    /// The vertex that counts as the marker's own, which the thin shell leaves out: the corner that
    /// weighs most.
    pub fn vertex(&self) -> usize {
        let mut most = 0;
        for i in 1..3 {
            if self.weights[i] > self.weights[most] {
                most = i;
            }
        }
        self.corners[most]
    }

    /// The corners that count, with their weights: one for a marker at a vertex.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.corners.iter().copied().zip(self.weights).filter(|(_, w)| *w != 0.0)
    }

    /// Where it is on the neutral, metres.
    ///
    /// # Panics
    /// If a corner is not a vertex of the mesh.
    pub fn position(&self, mesh: &SkinMesh) -> Point {
        Point(weighted(self.parts().map(|(v, w)| (mesh.positions[v].0, w))))
    }

    /// What a shape does to it at weight 1, metres.
    pub fn delta(&self, mesh: &SkinMesh, shape: usize) -> Displacement {
        let shape = &mesh.shapes[shape];
        Displacement(weighted(self.parts().filter_map(|(v, w)| {
            let at = shape.vertices.binary_search(&(v as u32)).ok()?;
            Some((shape.deltas[at].0, w))
        })))
    }
}

/// Sum of w x; the very numbers where there is one with weight 1.
fn weighted(vectors: impl Iterator<Item = (DVec3, f64)>) -> DVec3 {
    vectors.fold(DVec3::ZERO, |sum, (x, w)| sum + w * x)
}

impl SkinMesh {
    /// The point of the surface nearest to `point` (metres), with its barycentric coordinates; none
    /// for a mesh without triangles. Looks at every triangle.
    pub fn nearest_on_surface(&self, point: Point) -> Option<SurfacePoint> {
        self.nearest_on_triangles(point, 0..self.triangles.len())
    }

    /// The same among some triangles, by their numbers.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn nearest_on_triangles(
        &self,
        point: Point,
        triangles: impl IntoIterator<Item = usize>,
    ) -> Option<SurfacePoint> {
        let mut best: Option<SurfacePoint> = None;
        for triangle in triangles {
            let corners = self.triangles[triangle].map(|v| v as usize);
            let triangle = corners.map(|v| self.positions[v]);
            let weights = nearest_in_triangle(point, triangle);
            let position = barycentric(triangle, weights);
            let distance = (position - point).length();
            if best.is_none_or(|b| distance < b.distance) {
                best = Some(SurfacePoint { corners, weights, position, distance });
            }
        }
        best
    }
}

/// The point of a triangle with these barycentric coordinates.
pub(crate) fn barycentric([a, b, c]: [Point; 3], [r, u, v]: [f64; 3]) -> Point {
    Point(r * a.0 + u * b.0 + v * c.0)
}

/// Barycentric coordinates of the point of a triangle nearest to `p` (Ericson 2005, 5.1.5): by the
/// region of the plane that p falls into. Corners of a triangle without area count as its edges.
pub(crate) fn nearest_in_triangle(p: Point, [a, b, c]: [Point; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let (v, w) = (vb / (va + vb + vc), vc / (va + vb + vc));
    [1.0 - v - w, v, w]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_point_of_a_triangle_beats_every_other_point_of_it() {
        let triangle = [[0.0, 0.0, 0.1], [0.3, 0.02, 0.0], [0.05, 0.2, -0.05]].map(Point::from);
        let numbers = crate::linear_algebra::dense::numbers(300, 0.4);
        for p in numbers.chunks_exact(3) {
            let p = Point::new(p[0] * 0.5, p[1] * 0.5, p[2] * 0.5);
            let found = nearest_in_triangle(p, triangle);
            assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(found.iter().all(|&w| w >= 0.0));
            let best = (barycentric(triangle, found) - p).length();
            for i in 0..=30 {
                for j in 0..=30 - i {
                    let (u, v) = (f64::from(i) / 30.0, f64::from(j) / 30.0);
                    let other = (barycentric(triangle, [1.0 - u - v, u, v]) - p).length();
                    assert!(best <= other + 1e-12, "{p:?}: {best} > {other}");
                }
            }
        }
    }

    #[test]
    fn sites_give_points_and_deltas_by_their_coordinates() {
        let mesh = SkinMesh {
            positions: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(Point::from)
                .to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            shapes: vec![crate::SparseDeltas {
                vertices: vec![1, 2],
                deltas: vec![Displacement::new(0.0, 0.0, 0.4), Displacement::new(0.0, 0.0, 0.8)],
            }],
        };
        let found = mesh.nearest_on_surface(Point::new(0.25, 0.5, 0.3)).unwrap();
        assert_eq!((found.corners, found.distance), ([0, 2, 3], 0.25));
        let found = mesh.nearest_on_surface(Point::new(0.25, 0.5, 0.1)).unwrap();
        assert_eq!((found.corners, found.position), ([0, 1, 2], Point::new(0.25, 0.5, 0.0)));
        let (corners, weights) = (found.corners, found.weights);
        let site = MarkerSite { label: "m".into(), corners, weights };
        assert_eq!(site.vertex(), 2);
        assert_eq!(site.delta(&mesh, 0), [0.0, 0.0, 0.25 * 0.4 + 0.5 * 0.8]);
        let vertex = MarkerSite::at_vertex("m", 2);
        let bits = vertex.position(&mesh).to_array().map(f64::to_bits);
        assert_eq!(bits, [0.0_f64, 1.0, 0.0].map(f64::to_bits));
        assert_eq!(vertex.delta(&mesh, 0), [0.0, 0.0, 0.8]);
    }
}
