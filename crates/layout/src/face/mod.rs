//! A face that markers are to be put on: its skin, what moves it, its landmarks and its two halves.

mod landmarks;
mod mirror;
mod openings;
mod profile;
mod regions;

pub use landmarks::Landmarks;
pub use mirror::{MirrorVertices, PARTNER_M};
pub use openings::{MissingOpening, Openings};
pub use regions::{Excluded, FacePart};

use mimique_geometry::Point;
use mimique_solver::{MirrorError, SkinGradients};
use mimique_stimulus::AvatarSkin;

/// An avatar's face.
#[derive(Debug, Clone)]
pub struct Face<'a> {
    /// The skin.
    pub skin: &'a AvatarSkin,
    /// The shapes' displacements: vertices x 3 x N, metres.
    pub deltas: Vec<f64>,
    /// How far the shape that moves it farthest moves each vertex, metres.
    pub reach: Vec<f64>,
    /// Normals and neighbours.
    pub gradients: SkinGradients,
    /// Where eyes and mouth are.
    pub openings: Openings,
    /// Its landmarks.
    pub landmarks: Landmarks,
    /// Its two halves.
    pub mirror: MirrorVertices,
}

/// Why an avatar has no face that markers could be put on.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FaceError {
    /// Neither a shape nor a border tells where something is.
    #[error(
        "avatar: no shape of ARKit's vocabulary or of the action units moves {}; name its shapes so, or map them in \
         the settings beside it", opening(*.0)
    )]
    Opening(MissingOpening),
    /// The middle plane does not cut a face.
    #[error(
        "avatar: its profile has no nose and chin between eyes and neck; give the skin of a head, upright and \
         facing +Z"
    )]
    Profile,
    /// There is no middle plane.
    #[error("avatar: {0}")]
    Mirror(#[from] MirrorError),
}

fn opening(missing: MissingOpening) -> &'static str {
    match missing {
        MissingOpening::LeftEye => "the lids of the left eye",
        MissingOpening::RightEye => "the lids of the right eye",
        MissingOpening::Mouth => "the lips",
    }
}

impl<'a> Face<'a> {
    /// Of an avatar's skin.
    ///
    /// # Errors
    /// [`FaceError`] where landmarks cannot be found.
    pub fn of(skin: &'a AvatarSkin) -> Result<Self, FaceError> {
        let mirror = MirrorVertices::of(&skin.mesh)?;
        let openings = Openings::of(skin, &mirror.plane).map_err(FaceError::Opening)?;
        let landmarks =
            Landmarks::of(&skin.mesh, &openings, &mirror.plane).map_err(|_| FaceError::Profile)?;
        let n = skin.shape_names.len();
        let mut deltas = vec![0.0; skin.mesh.positions.len() * 3 * n];
        let mut reach = vec![0.0_f64; skin.mesh.positions.len()];
        for (k, shape) in skin.mesh.shapes.iter().enumerate() {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                let v = v as usize;
                (0..3).for_each(|axis| deltas[(3 * v + axis) * n + k] = d[axis]);
                reach[v] = reach[v].max(d.length());
            }
        }
        let gradients = SkinGradients::new(&skin.mesh);
        Ok(Self { skin, deltas, reach, gradients, openings, landmarks, mirror })
    }

    /// N.
    pub fn shape_count(&self) -> usize {
        self.skin.shape_names.len()
    }

    /// The neutral place of a vertex, metres.
    pub fn place(&self, vertex: usize) -> Point {
        self.skin.mesh.positions[vertex]
    }

    /// The shapes' displacements of a vertex: 3 x N, metres.
    pub fn deltas_of(&self, vertex: usize) -> &[f64] {
        let width = 3 * self.shape_count();
        &self.deltas[vertex * width..(vertex + 1) * width]
    }

    /// The part of the face that a vertex belongs to.
    pub fn part(&self, vertex: usize) -> FacePart {
        FacePart::of(self, self.place(vertex))
    }
}
