//! An avatar on the GPU: its tables, and what one frame needs to know of its eyes and landmarks.

use glam::{Mat3, Vec3};
use mimique_avatar::{Avatar, Image, MOST_EYEBALLS};
use wgpu::util::DeviceExt;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, Device, Queue, TextureFormat, TextureView,
};

use crate::framing::Landmarks;
use crate::geometry::{Draw, Eye, Geometry};
use crate::layouts::{EyeballPose, Gaze, LIST_TABLE_WIDTH, Pose, Scene, VERTEX_TABLE_WIDTH};
use crate::neck::Neck;
use crate::pipelines::{Layouts, OCCLUSION_FORMAT, Pipelines, STRAIN_FORMAT};
use crate::tables;
use crate::textures::Textures;
use crate::{Look, StageError};

/// An avatar ready to be drawn by the renderer that loaded it.
pub struct Head {
    pub(crate) landmarks: Landmarks,
    pub(crate) shape_count: usize,
    pub(crate) eyes: Vec<Eye>,
    neck: Neck,
    /// Places of the shapes `flush` and `sweat`, where the avatar has them.
    body_shapes: [Option<usize>; 2],
    pub(crate) draws: Vec<Draw>,
    pub(crate) indices: Buffer,
    pub(crate) colours: Buffer,
    pub(crate) uvs: Buffer,
    /// One picture per draw.
    pub(crate) picture_groups: Vec<BindGroup>,
    pub(crate) pose_buffer: Buffer,
    pub(crate) scene_buffer: Buffer,
    pub(crate) positions: TextureView,
    pub(crate) surfaces: TextureView,
    /// `surfaces` with the visibility softened an odd number of times.
    pub(crate) softened: TextureView,
    pub(crate) strains: TextureView,
    pub(crate) occlusions: TextureView,
    pub(crate) groups: PassGroups,
}

/// What is bound to each pass.
pub(crate) struct PassGroups {
    pub(crate) deform: BindGroup,
    pub(crate) light: BindGroup,
    pub(crate) surface: BindGroup,
    /// From `surfaces` to `softened`, and back.
    pub(crate) soften: [BindGroup; 2],
    pub(crate) strain: BindGroup,
    pub(crate) occlusion: BindGroup,
    pub(crate) shade: BindGroup,
}

/// An avatar's tables: those that are uploaded, and those that the passes fill.
struct Tables {
    neutral: TextureView,
    vertices: TextureView,
    entries: TextureView,
    rings: TextureView,
    positions: TextureView,
    surfaces: TextureView,
    softened: TextureView,
    strains: TextureView,
    occlusions: TextureView,
}

impl Tables {
    fn new(device: &Device, queue: &Queue, geometry: &Geometry) -> Result<Self, StageError> {
        let (wide, long) = (VERTEX_TABLE_WIDTH, LIST_TABLE_WIDTH);
        let (float, integers) = (TextureFormat::Rgba32Float, TextureFormat::Rgba32Uint);
        let pairs = TextureFormat::Rg32Uint;
        let high = tables::rows(geometry.neutral.len(), wide);
        let target = |label, format| tables::target(device, label, format, wide, high);
        Ok(Self {
            neutral: tables::upload(device, queue, "vertices", float, wide, &geometry.neutral)?,
            vertices: tables::upload(
                device,
                queue,
                "vertices",
                integers,
                wide,
                &geometry.vertices,
            )?,
            entries: tables::upload(device, queue, "deltas", float, long, &geometry.entries)?,
            rings: tables::upload(device, queue, "corners", pairs, long, &geometry.rings)?,
            positions: target("positions", float),
            surfaces: target("surfaces", float),
            softened: target("softened", float),
            strains: target("strains", STRAIN_FORMAT),
            occlusions: target("occlusions", OCCLUSION_FORMAT),
        })
    }
}

impl PassGroups {
    fn new(
        device: &Device,
        layouts: &Layouts,
        shadow: (&TextureView, &wgpu::Sampler),
        tables: &Tables,
        [pose, scene]: [&Buffer; 2],
    ) -> Self {
        let Tables {
            neutral,
            vertices,
            entries,
            rings,
            positions,
            surfaces,
            strains,
            occlusions,
            ..
        } = tables;
        let view = BindingResource::TextureView;
        let sampler = || BindingResource::Sampler(shadow.1);
        let (pose, scene) = (pose.as_entire_binding(), || scene.as_entire_binding());
        let group = |layout, resources: &[BindingResource<'_>]| group(device, layout, resources);
        let to_surface =
            [scene(), view(vertices), view(rings), view(positions), view(shadow.0), sampler()];
        let to_occlusion = [scene(), view(positions), view(shadow.0), sampler(), view(surfaces)];
        let to_strain = [view(vertices), view(rings), view(positions), view(neutral)];
        let to_shade = [
            scene(),
            view(positions),
            view(surfaces),
            view(neutral),
            view(occlusions),
            view(strains),
        ];
        Self {
            deform: group(&layouts.deform, &[pose, view(neutral), view(vertices), view(entries)]),
            light: group(&layouts.light, &[scene(), view(positions)]),
            surface: group(&layouts.surface, &to_surface),
            soften: [surfaces, &tables.softened]
                .map(|from| group(&layouts.soften, &[view(vertices), view(rings), view(from)])),
            strain: group(&layouts.strain, &to_strain),
            occlusion: group(&layouts.occlusion, &to_occlusion),
            shade: group(&layouts.shade, &to_shade),
        }
    }
}

impl Head {
    /// Number of blendshapes, and of weights that a frame takes.
    pub fn shape_count(&self) -> usize {
        self.shape_count
    }

    /// The landmarks that frame it.
    pub fn landmarks(&self) -> &Landmarks {
        &self.landmarks
    }

    pub(crate) fn new(
        device: &Device,
        queue: &Queue,
        pipelines: &Pipelines,
        shadow: (&TextureView, &wgpu::Sampler),
        avatar: &Avatar,
        pictures: Vec<Image>,
    ) -> Result<Self, StageError> {
        let landmarks = Landmarks::find(avatar);
        let geometry = Geometry::new(avatar, &landmarks)?;
        let tables = Tables::new(device, queue, &geometry)?;
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let vertex = wgpu::BufferUsages::VERTEX;
        let pose_buffer = buffer("pose", &vec![0; size_of::<Pose>()], uniform);
        let scene_buffer = buffer("scene", &vec![0; size_of::<Scene>()], uniform);
        let groups = PassGroups::new(
            device,
            &pipelines.layouts,
            shadow,
            &tables,
            [&pose_buffer, &scene_buffer],
        );
        let textures = Textures::new(device, queue, pictures);
        let picture = |draw: &Draw| {
            let texture = BindingResource::TextureView(textures.view(draw.texture));
            let sampler = BindingResource::Sampler(textures.sampler());
            group(device, &pipelines.layouts.picture, &[texture, sampler])
        };
        let picture_groups = geometry.draws.iter().map(picture).collect();
        let Tables { positions, surfaces, softened, strains, occlusions, .. } = tables;
        Ok(Self {
            neck: Neck::of(avatar, &landmarks),
            landmarks,
            picture_groups,
            shape_count: geometry.shape_count,
            eyes: geometry.eyes,
            body_shapes: ["flush", "sweat"].map(|name| avatar.shape_index(name)),
            draws: geometry.draws,
            indices: buffer(
                "indices",
                bytemuck::cast_slice(&geometry.indices),
                wgpu::BufferUsages::INDEX,
            ),
            colours: buffer("colours", bytemuck::cast_slice(&geometry.colours), vertex),
            uvs: buffer("places in pictures", bytemuck::cast_slice(&geometry.uvs), vertex),
            pose_buffer,
            scene_buffer,
            positions,
            surfaces,
            softened,
            strains,
            occlusions,
            groups,
        })
    }

    /// Weights and the turns of head and eyeballs, as `deform.wgsl` reads them. Missing weights are 0, so are
    /// weights that are no number; surplus ones are not read.
    pub(crate) fn pose(&self, weights: &[f32]) -> Pose {
        let mut pose: Pose = bytemuck::Zeroable::zeroed();
        for (k, &w) in weights.iter().take(self.shape_count).enumerate() {
            pose.weights[k / 4][k % 4] = if w.is_finite() { w } else { 0.0 };
        }
        let column = |c: Vec3| [c.x, c.y, c.z, 0.0];
        let head = self.neck.rotation(weights);
        pose.head = [head.x_axis, head.y_axis, head.z_axis].map(column);
        pose.pivot = column(self.neck.pivot);
        [pose.head[0][3], pose.pivot[3]] = self.neck.heights;
        for (slot, eye) in pose.eyeballs.iter_mut().zip(&self.eyes) {
            let turn = turn(eye, weights);
            *slot = EyeballPose {
                rotation: [column(turn.x_axis), column(turn.y_axis), column(turn.z_axis)],
                centre: [eye.centre.x, eye.centre.y, eye.centre.z, 0.0],
            };
        }
        pose
    }

    /// How red and how wet the skin is at the given weights, as `shade.wgsl` reads it.
    pub(crate) fn body(&self, weights: &[f32]) -> [f32; 4] {
        let [flush, sweat] = self.body_shapes.map(|shape| {
            let weight = shape.and_then(|k| weights.get(k)).copied();
            weight.filter(|w| w.is_finite()).map_or(0.0, |w| w.clamp(0.0, 1.0))
        });
        [flush, sweat, 0.0, 0.0]
    }

    /// The eyes' own frames at the given weights, as `shade.wgsl` reads them. The look colours irises
    /// that came without a colour, and all where nothing is painted.
    pub(crate) fn gaze(&self, weights: &[f32], look: &Look) -> [Gaze; MOST_EYEBALLS] {
        let mut out: [Gaze; MOST_EYEBALLS] = bytemuck::Zeroable::zeroed();
        let head = self.neck.rotation(weights);
        for (slot, eye) in out.iter_mut().zip(&self.eyes) {
            let [r, g, b] = eye.iris.filter(|_| look.paint).unwrap_or(look.iris);
            slot.iris = [r, g, b, 0.0];
            let world_from_eye = head * turn(eye, weights) * frame(eye.forward);
            let centre = self.neck.turned(head, eye.centre);
            for (row, (axis, c)) in
                [world_from_eye.x_axis, world_from_eye.y_axis, world_from_eye.z_axis]
                    .into_iter()
                    .zip(centre.to_array())
                    .enumerate()
            {
                let scaled = axis / eye.radius;
                slot.rows[row] = [scaled.x, scaled.y, scaled.z, c];
            }
        }
        out
    }
}

/// Rotation of an eyeball: the looks' rotation vectors added, so that their order does not matter.
fn turn(eye: &Eye, weights: &[f32]) -> Mat3 {
    let vector = eye.looks.iter().fold(Vec3::ZERO, |sum, look| {
        let w = weights.get(look.shape).copied().filter(|w| w.is_finite()).unwrap_or(0.0);
        sum + Vec3::from(look.axis) * (look.radians * w)
    });
    let angle = vector.length();
    if angle < 1e-7 { Mat3::IDENTITY } else { Mat3::from_axis_angle(vector / angle, angle) }
}

/// Axes with z along `forward`, x to the person's left.
fn frame(forward: Vec3) -> Mat3 {
    let x = Vec3::Y.cross(forward).normalize_or(Vec3::X);
    Mat3::from_cols(x, forward.cross(x), forward)
}

/// Binds the resources one after another.
fn group(
    device: &Device,
    layout: &BindGroupLayout,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

#[cfg(all(test, feature = "native"))]
mod tests;
