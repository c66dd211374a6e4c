//! Memory layouts shared with the shaders. Each names the shader that reads it; a field's order
//! and size here is the field's order and size there.

use bytemuck::{Pod, Zeroable};

/// Blendshapes that [`Pose`] holds.
pub(crate) const MAX_SHAPES: usize = 256;
/// Eyeballs that [`Pose`] holds.
pub(crate) const MAX_EYEBALLS: usize = 4;
/// Width of the tables with one entry a vertex (`deform.wgsl`, `surface.wgsl`, `shade.wgsl`).
pub(crate) const VERTEX_TABLE_WIDTH: u32 = 256;
/// Width of the tables of deltas and rings (`deform.wgsl`, `surface.wgsl`).
pub(crate) const LIST_TABLE_WIDTH: u32 = 1024;
/// Side of the key light's depth map (`surface.wgsl`, `shade.wgsl`).
pub(crate) const SHADOW_SIZE: u32 = 512;

/// `deform.wgsl`: struct `Pose`. What changes with every frame of a performance.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Pose {
    /// Four weights a row.
    pub weights: [[f32; 4]; MAX_SHAPES / 4],
    pub eyeballs: [EyeballPose; MAX_EYEBALLS],
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
    pub gaze: [Gaze; MAX_EYEBALLS],
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
