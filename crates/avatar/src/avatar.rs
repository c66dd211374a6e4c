//! The vocabulary of avatars: meshes, parts, sparse blendshapes, eyeballs.
//!
//! Everything is in metres, +Y up, +Z out of the face, +X to the *left* side of the person (the
//! glTF convention); readers convert on the way in and say from which unit.

use std::ops::Range;

use crate::shape_names::shows_body;

/// Most blendshapes of an avatar: so many weights and turns fit into the 16 KiB of constants that
/// every browser gives a shader.
pub const MOST_SHAPES: usize = 2048;
/// Most meshes of an avatar that are eyeballs, or parts of one that turn with it.
pub const MOST_EYEBALLS: usize = 16;

/// A head: its meshes, and the blendshapes that deform all of them together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Avatar {
    /// Name shown to people and written into marker maps.
    pub name: String,
    /// The N blendshape names, in the file's own order. Weights are always in this order; those of the
    /// shapes at the end may be left out, and are 0.
    pub shape_names: Vec<String>,
    /// The meshes; each has exactly N entries in [`Mesh::shapes`].
    pub meshes: Vec<Mesh>,
    /// Eyeballs that turn about their centre with the eye-look shapes.
    pub eyeballs: Vec<Eyeball>,
    /// Pictures on the meshes' surfaces.
    pub textures: Vec<Texture>,
    /// Expressions that the file defines as shares of shapes, whose names recorded weights may have in the place of those of
    /// shapes. Packs do not carry them.
    pub expressions: Vec<Expression>,
}

/// A named expression of an avatar.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    /// Its name: `happy`, `aa`.
    pub name: String,
    /// Shapes, each with the weight that it has where the expression is whole.
    pub shares: Vec<(String, f64)>,
}

/// One mesh of an avatar.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Name in the file.
    pub name: String,
    /// What it is of a face.
    pub part: Part,
    /// Neutral positions, metres.
    pub positions: Vec<[f32; 3]>,
    /// Counter-clockwise triangles, indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Linear RGB base colour per vertex, 0 to 1; empty = [`Mesh::base_colour`] everywhere.
    pub vertex_colours: Vec<[f32; 3]>,
    /// Linear RGB base colour, 0 to 1.
    pub base_colour: [f32; 3],
    /// Blendshape deltas, one entry per blendshape of the avatar (empty where it moves nothing here).
    pub shapes: Vec<SparseShape>,
    /// Where each vertex lies in its picture, (0, 0) at the upper left, (1, 1) at the lower right,
    /// repeated beyond; empty where nothing is textured.
    pub uvs: Vec<[f32; 2]>,
    /// Runs of `triangles` with a picture, ascending, without overlap. The picture's colours are
    /// multiplied with the vertices' colours.
    pub textured: Vec<Textured>,
}

/// Triangles that carry a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Textured {
    /// Indices into [`Mesh::triangles`].
    pub triangles: Range<usize>,
    /// Index into [`Avatar::textures`].
    pub texture: usize,
}

/// A picture, compressed as it travels: sRGB base colour, and what is open in it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Texture {
    /// A JPEG file, sRGB.
    pub jpeg: Vec<u8>,
    /// A grey JPEG file of the same size: 0 where nothing is, 255 where the surface is whole;
    /// empty = whole everywhere.
    pub mask_jpeg: Vec<u8>,
}

/// The displacement of one blendshape at weight 1, on the vertices that it moves.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SparseShape {
    /// Vertex indices, ascending.
    pub vertices: Vec<u32>,
    /// Displacement of each, metres.
    pub deltas: Vec<[f32; 3]>,
}

/// What a mesh is of a face. The solver sees only [`Part::Skin`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Part {
    /// The skin: the surface that the thin shell is made of.
    #[default]
    Skin,
    /// The person's left eyeball.
    EyeLeft,
    /// The person's right eyeball.
    EyeRight,
    /// Teeth.
    Teeth,
    /// Gums and tongue.
    Tongue,
    /// Inside of mouth and eye sockets.
    Socket,
    /// Eyelashes.
    Lashes,
    /// Eyebrows, hair and beard.
    Hair,
    /// Wet and shading layers over the eye.
    EyeOverlay,
    /// Anything else (clothes, accessories).
    Other,
}

impl Part {
    /// Every part.
    pub const ALL: [Self; 10] = [
        Self::Skin,
        Self::EyeLeft,
        Self::EyeRight,
        Self::Teeth,
        Self::Tongue,
        Self::Socket,
        Self::Lashes,
        Self::Hair,
        Self::EyeOverlay,
        Self::Other,
    ];

    /// Whether it is an eyeball, which turns and does not deform.
    pub fn is_eye(self) -> bool {
        matches!(self, Self::EyeLeft | Self::EyeRight)
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Skin => "skin",
            Self::EyeLeft => "eyeLeft",
            Self::EyeRight => "eyeRight",
            Self::Teeth => "teeth",
            Self::Tongue => "tongue",
            Self::Socket => "socket",
            Self::Lashes => "lashes",
            Self::Hair => "hair",
            Self::EyeOverlay => "eyeOverlay",
            Self::Other => "other",
        }
    }
}

/// An eyeball turns rigidly: eye-look shapes do not move its vertices, they turn it.
#[derive(Debug, Clone, PartialEq)]
pub struct Eyeball {
    /// Index of the eyeball's mesh in [`Avatar::meshes`].
    pub mesh: usize,
    /// Centre of rotation, metres.
    pub centre: [f32; 3],
    /// The shapes that turn it: each adds `weight * radians` about `axis`.
    pub looks: Vec<Look>,
}

/// One eye-look shape's rotation of an eyeball.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Index into [`Avatar::shape_names`].
    pub shape: usize,
    /// Unit axis.
    pub axis: [f32; 3],
    /// Angle at weight 1.
    pub radians: f32,
}

impl Avatar {
    /// Index of the blendshape of that name.
    pub fn shape_index(&self, name: &str) -> Option<usize> {
        self.shape_names.iter().position(|n| n == name)
    }

    /// The shapes that show expressions: all but those of the body ([`crate::BODY_SHAPES`]) at the end, which
    /// no marker tells. Methods solve for these.
    pub fn face_shapes(&self) -> &[String] {
        let body = self.shape_names.iter().rev().take_while(|name| shows_body(name)).count();
        &self.shape_names[..self.shape_names.len() - body]
    }

    /// The first skin mesh, on which markers are placed.
    pub fn skin(&self) -> Option<&Mesh> {
        self.meshes.iter().find(|m| m.part == Part::Skin)
    }
}

impl SparseShape {
    /// Keeps the displacements that are not zero.
    pub fn from_dense(deltas: &[[f32; 3]]) -> Self {
        let moved = || deltas.iter().enumerate().filter(|(_, d)| **d != [0.0; 3]);
        Self {
            vertices: moved().map(|(v, _)| v as u32).collect(),
            deltas: moved().map(|(_, d)| *d).collect(),
        }
    }
}

impl Mesh {
    /// Positions of the mesh at the given weights, metres: neutral + sum of w times delta. Shapes without a
    /// weight rest.
    pub fn posed(&self, weights: &[f64]) -> Vec<[f32; 3]> {
        let mut out = self.positions.clone();
        for (shape, &w) in self.shapes.iter().zip(weights) {
            let w = w as f32;
            if w == 0.0 {
                continue;
            }
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                let p = &mut out[v as usize];
                for a in 0..3 {
                    p[a] += w * d[a];
                }
            }
        }
        out
    }
}
