//! Memory layouts shared with the shaders. Each names the shader that reads it; a field's order
//! and size here is the field's order and size there.

use bytemuck::{Pod, Zeroable};
use mimique_avatar::{MOST_EYEBALLS, MOST_SHAPES};

/// Width of the tables with one entry per vertex (`deform.wgsl`, `surface.wgsl`, `shade.wgsl`).
pub(crate) const VERTEX_TABLE_WIDTH: u32 = 256;
/// Width of the tables of deltas and rings (`deform.wgsl`, `surface.wgsl`).
pub(crate) const LIST_TABLE_WIDTH: u32 = 1024;
/// Side of the key light's depth map (`surface.wgsl`, `shade.wgsl`).
pub(crate) const SHADOW_SIZE: u32 = 512;

/// `deform.wgsl`: struct `Pose`. What changes with every frame of a performance.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Pose {
    /// Columns of the head's rotation; the fourth number of the first is the height from which it turns whole.
    pub head: [[f32; 4]; 3],
    /// What it turns about; the height below which it does not.
    pub pivot: [f32; 4],
    pub eyeballs: [EyeballPose; MOST_EYEBALLS],
    /// Four weights a row.
    pub weights: [[f32; 4]; MOST_SHAPES / 4],
}

/// Constants that WebGL2 gives a shader at least, bytes; no frame may need more.
const LEAST_CONSTANTS: usize = 16 << 10;
const _: () = assert!(size_of::<Pose>() <= LEAST_CONSTANTS && MOST_SHAPES.is_multiple_of(4));

impl Pose {
    /// The bytes that `shapes` weights take from the start; what is behind them stays 0.
    pub fn bytes(&self, shapes: usize) -> &[u8] {
        let rows = shapes.div_ceil(4).min(self.weights.len());
        let end = std::mem::offset_of!(Self, weights) + rows * size_of_val(&self.weights[0]);
        &bytemuck::bytes_of(self)[..end]
    }
}

/// `deform.wgsl`: struct `EyeballPose`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct EyeballPose {
    /// Columns of the rotation; the fourth numbers pad.
    pub rotation: [[f32; 4]; 3],
    pub centre: [f32; 4],
}

/// `scene.wgsl`: struct `Scene`. What changes with camera, look and gaze.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Scene {
    pub clip_from_world: [[f32; 4]; 4],
    pub light_from_world: [[f32; 4]; 4],
    pub camera: [f32; 4],
    /// Midpoint of the eyes; the eyes' span.
    pub eyes_middle: [f32; 4],
    /// Midpoint of the lips; depth of the face behind them at which the mouth is dark.
    pub mouth: [f32; 4],
    /// Where the lips part in the middle (x, y), half the mouth's width, how much higher its corners
    /// are; width 0 where no lips are to be painted.
    pub lips: [f32; 4],
    /// Tint; roughness.
    pub skin: [f32; 4],
    /// Colour; 1 where painted.
    pub brows: [f32; 4],
    /// Exposure.
    pub light: [f32; 4],
    /// How red the skin is, how wet; 0 to 1.
    pub body: [f32; 4],
    pub gaze: [Gaze; MOST_EYEBALLS],
}

/// `scene.wgsl`: struct `Gaze`. Rows that take a point about the eye's centre to the eye's own
/// frame (z through the pupil) in units of its radius; the centre in the fourth numbers.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Gaze {
    pub rows: [[f32; 4]; 3],
    /// Colour of the iris.
    pub iris: [f32; 4],
}

/// `shade.wgsl`: constants `MATERIAL_...`; the fourth number of a vertex's colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Material {
    Skin = 0,
    PaintedSkin = 1,
    Teeth = 2,
    Tongue = 3,
    Socket = 4,
    Hair = 5,
    Cloth = 6,
    Lashes = 7,
    /// The first eye; the second is one more.
    Eye = 8,
}
