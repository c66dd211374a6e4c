//! The mirror image of each vertex of a face.

use mimique_geometry::Point;
use mimique_solver::{MirrorError, MirrorPlane, SkinMesh};

/// A vertex whose mirror image is nearer to it than this is in the middle, metres.
const MIDDLE_M: f64 = 2e-4;
/// Most distance between a mirror image and the vertex that stands for it, metres.
pub const PARTNER_M: f64 = 0.002;

/// Which vertex is on the other side of each.
#[derive(Debug, Clone, PartialEq)]
pub struct MirrorVertices {
    /// The middle plane.
    pub plane: MirrorPlane,
    /// The vertex nearest to the mirror image of each.
    pub of: Vec<usize>,
    /// How far that vertex is from the mirror image, metres.
    pub apart: Vec<f64>,
    /// Signed distance of each vertex from the plane, positive on the left, metres; 0 for those in it.
    pub from_middle: Vec<f64>,
}

impl MirrorVertices {
    /// Of a skin.
    ///
    /// # Errors
    /// [`MirrorError`] for a face that is not symmetric.
    pub fn of(mesh: &SkinMesh) -> Result<Self, MirrorError> {
        let plane = MirrorPlane::of(mesh)?;
        let (of, apart): (Vec<usize>, Vec<f64>) =
            plane.partners(&mesh.positions).into_iter().unzip();
        let middle = |p: Point| {
            let distance = plane.distance(p);
            if distance.abs() < 0.5 * MIDDLE_M { 0.0 } else { distance }
        };
        let from_middle = mesh.positions.iter().map(|&p| middle(p)).collect();
        Ok(Self { plane, of, apart, from_middle })
    }

    /// Whether a vertex has a partner of its own.
    pub fn has_partner(&self, vertex: usize) -> bool {
        self.apart[vertex] <= PARTNER_M
    }
}
