//! Depth from a two-dimensional capture (Kouadio 4.3.1, eq. 4.12): a point of the skin that moves
//! in the image keeps to the plane of the triangle towards which it moves.
//!
//! The equation says that the displacement is orthogonal to the triangle's normal n:
//! n . (P' - P) = 0, so dz = -(n_x dx + n_y dy) / n_z. It holds for small motions of wide, smooth
//! regions (forehead, cheeks), less for lips and the corners of eyes and nose.

use crate::mesh::marker_site::MarkerSite;
use crate::mesh::skin_mesh::SkinMesh;

/// A triangle steeper than this to the image (n_z over the length of n) tells no depth: a tenth
/// of a millimetre beside would be a millimetre of depth.
const STEEPEST: f64 = 0.1;

/// For each of P markers the triangles around it, as the image sees them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceDepth {
    /// One list per marker; empty where no triangle faces the image: the depth then stays.
    pub fans: Vec<Vec<FanTriangle>>,
}

/// One triangle at a marker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FanTriangle {
    /// Its two edges from the marker, in the image's x and y, metres; zeros where the marker is
    /// inside the triangle, which then lies in every direction.
    pub edges: [[f64; 2]; 2],
    /// dz for dx = 1 and for dy = 1.
    pub slope: [f64; 2],
}

impl SurfaceDepth {
    /// Of a skin's neutral, +Z towards the camera, and the places of the markers on it.
    pub fn of(mesh: &SkinMesh, sites: &[MarkerSite]) -> SurfaceDepth {
        let fan = |site: &MarkerSite| {
            let parts: Vec<usize> = site.parts().map(|(v, _)| v).collect();
            let mut fan = Vec::new();
            for t in &mesh.triangles {
                let t = t.map(|v| v as usize);
                // Of a marker inside a triangle that one, of one on an edge its two sides.
                if !parts.iter().all(|v| t.contains(v)) {
                    continue;
                }
                let [a, b, c] = t.map(|v| mesh.positions[v]);
                let n = (b - a).cross(c - a);
                if !(n.z > STEEPEST * n.length()) {
                    continue;
                }
                let edges = match parts[..] {
                    [v] => {
                        let at = t.iter().position(|&w| w == v).unwrap_or(0);
                        let p = mesh.positions[v];
                        [1, 2].map(|k| {
                            let q = mesh.positions[t[(at + k) % 3]];
                            [q.x - p.x, q.y - p.y]
                        })
                    }
                    _ => [[0.0; 2]; 2],
                };
                fan.push(FanTriangle { edges, slope: [-n.x / n.z, -n.y / n.z] });
            }
            fan
        };
        SurfaceDepth { fans: sites.iter().map(fan).collect() }
    }

    /// dz of one marker that moves by (dx, dy), metres.
    ///
    /// # Panics
    /// If there is no such marker.
    pub fn depth(&self, marker: usize, [dx, dy]: [f64; 2]) -> f64 {
        // How far the motion is inside the wedge of the two edges: positive inside.
        let inside = |triangle: &FanTriangle| {
            let [p, q] = triangle.edges;
            let length = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
            let (lp, lq) = (length(p), length(q));
            if lp == 0.0 || lq == 0.0 {
                return f64::INFINITY;
            }
            let from_p = (p[0] * dy - p[1] * dx) / lp;
            let to_q = (dx * q[1] - dy * q[0]) / lq;
            from_p.min(to_q)
        };
        let mut best: Option<(f64, &FanTriangle)> = None;
        for triangle in &self.fans[marker] {
            let measure = inside(triangle);
            if best.is_none_or(|(most, _)| measure > most) {
                best = Some((measure, triangle));
            }
        }
        best.map_or(0.0, |(_, t)| t.slope[0] * dx + t.slope[1] * dy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::skin_mesh::SparseDeltas;
    use mimique_geometry::Point;

    /// A pyramid over the square from -1 to 1, its top at the middle, 1 high; its foot is a wall.
    fn pyramid() -> SkinMesh {
        SkinMesh {
            positions: [
                [0.0, 0.0, 1.0],
                [-1.0, -1.0, 0.0],
                [1.0, -1.0, 0.0],
                [1.0, 1.0, 0.0],
                [-1.0, 1.0, 0.0],
                [1.0, 0.0, -5.0],
            ]
            .map(Point::from)
            .to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [2, 5, 3]],
            shapes: vec![SparseDeltas::default()],
        }
    }

    #[test]
    fn a_point_keeps_to_the_triangle_that_it_moves_towards() {
        let mesh = pyramid();
        let inside = MarkerSite { label: "f".into(), corners: [0, 2, 3], weights: [0.5, 0.2, 0.3] };
        let depth = SurfaceDepth::of(&mesh, &[MarkerSite::at_vertex("top", 0), inside]);
        assert_eq!(depth.fans[0].len(), 4);
        assert_eq!(depth.fans[1].len(), 1);
        // From the top every way leads down, one for one along the axes.
        for (d, dz) in [
            ([0.1, 0.0], -0.1),
            ([-0.1, 0.02], -0.1),
            ([0.03, 0.2], -0.2),
            ([0.0, -0.3], -0.3),
            ([0.0, 0.0], 0.0),
        ] {
            assert!((depth.depth(0, d) - dz).abs() < 1e-15, "{d:?}");
        }
        // On the right face x alone leads down, and back up.
        assert!((depth.depth(1, [0.1, 0.4]) + 0.1).abs() < 1e-15);
        assert!((depth.depth(1, [-0.1, 0.0]) - 0.1).abs() < 1e-15);
        assert!(depth.depth(1, [f64::NAN, 0.0]).is_nan());
    }

    #[test]
    fn walls_tell_no_depth() {
        let depth = SurfaceDepth::of(&pyramid(), &[MarkerSite::at_vertex("foot", 5)]);
        assert_eq!(depth.fans[0], []);
        assert_eq!(depth.depth(0, [0.1, 0.1]), 0.0);
    }
}
