//! The skin of an avatar as the solver wants it: one welded surface in f64.

use mimique_avatar::{Avatar, Mesh, Part};
use mimique_geometry::{Displacement, Point};
use mimique_solver::{Group, MeshError, MethodSpec, SkinMesh, SparseDeltas};

/// An avatar's skin, its seams closed, and the way back to the file's vertices.
#[derive(Debug, Clone)]
pub struct AvatarSkin {
    /// The avatar's name.
    pub name: String,
    /// The N shapes of the face, in the avatar's order.
    pub shape_names: Vec<String>,
    /// The welded surface, S vertices.
    pub mesh: SkinMesh,
    /// Centres of the left and the right eyeball, metres; none unless the avatar has both.
    pub eyes: Option<[Point; 2]>,
    /// Welded vertex of each vertex of the skin meshes, in the file's order.
    pub welded_from_file: Vec<u32>,
}

impl AvatarSkin {
    /// Joins and welds every mesh of an avatar that is skin.
    ///
    /// # Errors
    /// [`MeshError`] when there is no skin, or a damaged one.
    pub fn of(avatar: &Avatar) -> Result<Self, MeshError> {
        let mut open = SkinMesh {
            shapes: vec![SparseDeltas::default(); avatar.face_shapes().len()],
            ..SkinMesh::default()
        };
        avatar.meshes.iter().filter(|m| m.part == Part::Skin).for_each(|m| append(&mut open, m));
        let welded = open.weld()?;
        Ok(Self {
            name: avatar.name.clone(),
            shape_names: avatar.face_shapes().to_vec(),
            mesh: welded.mesh,
            eyes: eyes(avatar),
            welded_from_file: welded.index_of,
        })
    }

    /// The vertex nearest to `point` (metres) and its distance; `None` for an empty skin.
    pub fn nearest(&self, point: Point) -> Option<(usize, f64)> {
        self.nearest_where(point, |_| true)
    }

    /// The same among the vertices that `may` be it.
    pub fn nearest_where(&self, point: Point, may: impl Fn(usize) -> bool) -> Option<(usize, f64)> {
        self.mesh
            .positions
            .iter()
            .map(|p| (*p - point).length_squared())
            .enumerate()
            .filter(|(v, _)| may(*v))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(v, square)| (v, square.sqrt()))
    }
}

/// Centres of both eyeballs.
fn eyes(avatar: &Avatar) -> Option<[Point; 2]> {
    let centre = |part: Part| {
        let eye = avatar.eyeballs.iter().find(|eye| avatar.meshes[eye.mesh].part == part)?;
        Some(Point::from(eye.centre.map(f64::from)))
    };
    Some([centre(Part::EyeLeft)?, centre(Part::EyeRight)?])
}

/// Adds shapes to those that a method holds at 0, where the method solves for shapes at all.
pub fn lock_shapes(spec: &mut MethodSpec, shapes: &[String]) {
    if spec.method.uses(Group::Shapes) {
        let new: Vec<String> =
            shapes.iter().filter(|s| !spec.locked.contains(s)).cloned().collect();
        spec.locked.extend(new);
    }
}

fn append(skin: &mut SkinMesh, mesh: &Mesh) {
    let first = skin.positions.len() as u32;
    skin.positions.extend(mesh.positions.iter().map(|p| Point::from(p.map(f64::from))));
    skin.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    for (shape, more) in skin.shapes.iter_mut().zip(&mesh.shapes) {
        shape.vertices.extend(more.vertices.iter().map(|v| v + first));
        shape.deltas.extend(more.deltas.iter().map(|d| Displacement::from(d.map(f64::from))));
    }
}
