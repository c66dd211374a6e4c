//! An avatar on the GPU: its tables, and what one frame needs to know of its eyes and landmarks.

use glam::{Mat3, Vec3};
use mimique_face::{Avatar, Image, MOST_EYEBALLS};
use wgpu::util::DeviceExt;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, Device, Queue, TextureFormat, TextureView,
};

use crate::StageError;
use crate::framing::Landmarks;
use crate::geometry::{Draw, Eye, Geometry};
use crate::layouts::{EyeballPose, Gaze, LIST_TABLE_WIDTH, Pose, Scene, VERTEX_TABLE_WIDTH};
use crate::pipelines::{OCCLUSION_FORMAT, Pipelines};
use crate::tables;
use crate::textures::Textures;

/// An avatar ready to be drawn by the renderer that loaded it.
pub struct Head {
    pub(crate) landmarks: Landmarks,
    pub(crate) shape_count: usize,
    pub(crate) eyes: Vec<Eye>,
    pub(crate) draws: Vec<Draw>,
    pub(crate) indices: Buffer,
    pub(crate) colours: Buffer,
    pub(crate) uvs: Buffer,
    /// One picture a draw.
    pub(crate) picture_groups: Vec<BindGroup>,
    pub(crate) pose_buffer: Buffer,
    pub(crate) scene_buffer: Buffer,
    pub(crate) positions: TextureView,
    pub(crate) surfaces: TextureView,
    /// `surfaces` with the visibility softened an odd number of times.
    pub(crate) softened: TextureView,
    pub(crate) occlusions: TextureView,
    pub(crate) deform_group: BindGroup,
    pub(crate) light_group: BindGroup,
    pub(crate) surface_group: BindGroup,
    /// From `surfaces` to `softened`, and back.
    pub(crate) soften_groups: [BindGroup; 2],
    pub(crate) occlusion_group: BindGroup,
    pub(crate) shade_group: BindGroup,
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
        let wide = VERTEX_TABLE_WIDTH;
        let float = TextureFormat::Rgba32Float;
        let neutral = tables::upload(device, queue, "vertices", float, wide, &geometry.neutral)?;
        let vertices = tables::upload(
            device,
            queue,
            "vertices",
            TextureFormat::Rgba32Uint,
            wide,
            &geometry.vertices,
        )?;
        let entries =
            tables::upload(device, queue, "deltas", float, LIST_TABLE_WIDTH, &geometry.entries)?;
        let rings = tables::upload(
            device,
            queue,
            "corners",
            TextureFormat::Rg32Uint,
            LIST_TABLE_WIDTH,
            &geometry.rings,
        )?;
        let high = tables::rows(geometry.neutral.len(), wide);
        let positions = tables::target(device, "positions", float, wide, high);
        let surfaces = tables::target(device, "surfaces", float, wide, high);
        let softened = tables::target(device, "softened", float, wide, high);
        let occlusions = tables::target(device, "occlusions", OCCLUSION_FORMAT, wide, high);
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let pose_buffer = buffer("pose", &vec![0; size_of::<Pose>()], uniform);
        let scene_buffer = buffer("scene", &vec![0; size_of::<Scene>()], uniform);
        let (pose, scene) = (pose_buffer.as_entire_binding(), scene_buffer.as_entire_binding());
        let view = BindingResource::TextureView;
        let sampler = BindingResource::Sampler(shadow.1);
        let group = |layout, resources: &[BindingResource<'_>]| group(device, layout, resources);
        let deform_group = group(
            &pipelines.deform_layout,
            &[pose, view(&neutral), view(&vertices), view(&entries)],
        );
        let light_group = group(&pipelines.light_layout, &[scene.clone(), view(&positions)]);
        let surface_group = group(
            &pipelines.surface_layout,
            &[
                scene.clone(),
                view(&vertices),
                view(&rings),
                view(&positions),
                view(shadow.0),
                sampler.clone(),
            ],
        );
        let soften_groups = [&surfaces, &softened].map(|from| {
            group(&pipelines.soften_layout, &[view(&vertices), view(&rings), view(from)])
        });
        let occlusion_group = group(
            &pipelines.occlusion_layout,
            &[scene.clone(), view(&positions), view(shadow.0), sampler, view(&surfaces)],
        );
        let shade_group = group(
            &pipelines.shade_layout,
            &[scene, view(&positions), view(&surfaces), view(&neutral), view(&occlusions)],
        );
        let textures = Textures::new(device, queue, pictures);
        let picture = |draw: &Draw| {
            let texture = view(textures.view(draw.texture));
            group(
                &pipelines.picture_layout,
                &[texture, BindingResource::Sampler(textures.sampler())],
            )
        };
        let picture_groups = geometry.draws.iter().map(picture).collect();
        Ok(Self {
            landmarks,
            picture_groups,
            shape_count: geometry.shape_count,
            eyes: geometry.eyes,
            draws: geometry.draws,
            indices: buffer(
                "indices",
                bytemuck::cast_slice(&geometry.indices),
                wgpu::BufferUsages::INDEX,
            ),
            colours: buffer(
                "colours",
                bytemuck::cast_slice(&geometry.colours),
                wgpu::BufferUsages::VERTEX,
            ),
            uvs: buffer(
                "places in pictures",
                bytemuck::cast_slice(&geometry.uvs),
                wgpu::BufferUsages::VERTEX,
            ),
            pose_buffer,
            scene_buffer,
            positions,
            surfaces,
            softened,
            deform_group,
            light_group,
            occlusions,
            surface_group,
            soften_groups,
            occlusion_group,
            shade_group,
        })
    }

    /// Weights and the eyeballs' turns, as `deform.wgsl` reads them. Missing weights are 0, so are
    /// weights that are no number; surplus ones are not read.
    pub(crate) fn pose(&self, weights: &[f32]) -> Pose {
        let mut pose: Pose = bytemuck::Zeroable::zeroed();
        for (k, &w) in weights.iter().take(self.shape_count).enumerate() {
            pose.weights[k / 4][k % 4] = if w.is_finite() { w } else { 0.0 };
        }
        for (slot, eye) in pose.eyeballs.iter_mut().zip(&self.eyes) {
            let turn = turn(eye, weights);
            let column = |c: Vec3| [c.x, c.y, c.z, 0.0];
            *slot = EyeballPose {
                rotation: [column(turn.x_axis), column(turn.y_axis), column(turn.z_axis)],
                centre: [eye.centre.x, eye.centre.y, eye.centre.z, 0.0],
            };
        }
        pose
    }

    /// The eyes' own frames at the given weights, as `shade.wgsl` reads them; `iris` colours those
    /// that came without a colour.
    pub(crate) fn gaze(&self, weights: &[f32], iris: [f32; 3]) -> [Gaze; MOST_EYEBALLS] {
        let mut out: [Gaze; MOST_EYEBALLS] = bytemuck::Zeroable::zeroed();
        for (slot, eye) in out.iter_mut().zip(&self.eyes) {
            let [r, g, b] = eye.iris.unwrap_or(iris);
            slot.iris = [r, g, b, 0.0];
            let head_from_eye = turn(eye, weights) * frame(eye.forward);
            for (row, (axis, c)) in
                [head_from_eye.x_axis, head_from_eye.y_axis, head_from_eye.z_axis]
                    .into_iter()
                    .zip(eye.centre.to_array())
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
mod tests {
    use glam::{Vec3, Vec4};
    use mimique_face::{Avatar, Eyeball, Look as EyeLook, Mesh, Part, SparseShape};

    use crate::offscreen::Offscreen;
    use crate::{Look, View};

    const ROWS: usize = 24;

    /// A sphere of 8 cm whose first and last meridian lie in one place, with a shape that grows it
    /// by a tenth and one that moves its upper half, and an eye that turns.
    fn planted() -> Avatar {
        let mut skin = sphere(Vec3::ZERO, 0.08);
        let all: Vec<u32> = (0..skin.positions.len() as u32).collect();
        let grow = SparseShape {
            deltas: skin.positions.iter().map(|p| p.map(|x| 0.1 * x)).collect(),
            vertices: all.clone(),
        };
        let upper: Vec<u32> =
            all.into_iter().filter(|&v| skin.positions[v as usize][1] > 0.01).collect();
        let lift = SparseShape { deltas: vec![[0.001, 0.002, 0.02]; upper.len()], vertices: upper };
        skin.shapes = vec![grow, lift, SparseShape::default()];
        let mut eye = sphere(Vec3::new(0.03, 0.02, 0.07), 0.012);
        eye.part = Part::EyeLeft;
        eye.shapes = vec![SparseShape::default(); 3];
        Avatar {
            name: "planted".to_owned(),
            shape_names: ["grow", "lift", "look"].map(str::to_owned).to_vec(),
            meshes: vec![skin, eye],
            eyeballs: vec![Eyeball {
                mesh: 1,
                centre: [0.03, 0.02, 0.07],
                looks: vec![EyeLook { shape: 2, axis: [0.0, 1.0, 0.0], radians: 0.6 }],
            }],
            ..Avatar::default()
        }
    }

    fn sphere(centre: Vec3, radius: f32) -> Mesh {
        let columns = 2 * ROWS;
        let mut mesh = Mesh::default();
        for i in 0..=ROWS {
            let (sin, cos) = (std::f32::consts::PI * i as f32 / ROWS as f32).sin_cos();
            for j in 0..=columns {
                let turn = std::f32::consts::TAU * (j % columns) as f32 / columns as f32;
                let unit = Vec3::new(sin * turn.sin(), cos, sin * turn.cos());
                mesh.positions.push((centre + radius * unit).into());
            }
        }
        let at = |i: usize, j: usize| (i * (columns + 1) + j) as u32;
        for (i, j) in (0..ROWS).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        mesh
    }

    /// The tables of positions and surfaces as the passes left them, skin first.
    fn tables(name: &str, avatar: &Avatar, weights: &[f32]) -> Option<(Vec<Vec4>, Vec<Vec4>)> {
        let stage = match Offscreen::new(true) {
            Ok(stage) => stage,
            Err(error) => {
                mimique_test_support::skip(name, &error.to_string());
                return None;
            }
        };
        let renderer = stage.renderer([16, 16], Look::STIMULUS);
        let head = renderer.load(avatar).expect("the avatar loads");
        stage.picture(&renderer, &head, View::FRONT, weights).expect("a picture");
        let table = |view: &wgpu::TextureView| -> Vec<Vec4> {
            let bytes = stage.read(view.texture()).expect("a table");
            bytemuck::cast_slice(&bytes).iter().map(|&t: &[f32; 4]| t.into()).collect()
        };
        Some((table(&head.positions), table(&head.surfaces)))
    }

    /// Positions and normals as the passes computed them, skin first.
    fn computed(name: &str, avatar: &Avatar, weights: &[f32]) -> Option<(Vec<Vec3>, Vec<Vec3>)> {
        let (positions, surfaces) = tables(name, avatar, weights)?;
        let directions = |table: Vec<Vec4>| table.into_iter().map(Vec4::truncate).collect();
        Some((directions(positions), directions(surfaces)))
    }

    #[test]
    fn positions_are_neutral_plus_weighted_deltas() {
        let avatar = planted();
        let weights = [0.7, 1.3, 0.0];
        let name = "positions_are_neutral_plus_weighted_deltas";
        let Some((positions, _)) = computed(name, &avatar, &weights) else { return };
        let expected = avatar.meshes[0].posed(&weights.map(f64::from));
        for (v, (found, expected)) in positions.iter().zip(expected).enumerate() {
            let off = found.distance(expected.into());
            assert!(off < 1e-7, "vertex {v}: {off} m off");
        }
    }

    #[test]
    fn eyeball_turns_rigidly_about_its_centre() {
        let avatar = planted();
        let name = "eyeball_turns_rigidly_about_its_centre";
        let Some((positions, _)) = computed(name, &avatar, &[0.0, 0.0, 0.5]) else { return };
        let skin = avatar.meshes[0].positions.len();
        let centre = Vec3::from(avatar.eyeballs[0].centre);
        let (sin, cos) = 0.3_f32.sin_cos();
        for (v, &p) in avatar.meshes[1].positions.iter().enumerate() {
            let arm = Vec3::from(p) - centre;
            let turned = Vec3::new(cos * arm.x + sin * arm.z, arm.y, cos * arm.z - sin * arm.x);
            let off = positions[skin + v].distance(centre + turned);
            assert!(off < 1e-7, "vertex {v}: {off} m off");
        }
    }

    #[test]
    fn normals_follow_the_deformed_surface_across_the_seam() {
        let avatar = planted();
        let name = "normals_follow_the_deformed_surface_across_the_seam";
        let Some((positions, normals)) = computed(name, &avatar, &[1.0, 0.0, 0.0]) else { return };
        let columns = 2 * ROWS;
        for i in 1..ROWS {
            for j in 0..=columns {
                let v = i * (columns + 1) + j;
                // A grown sphere is a sphere: Max's weights give its normals exactly.
                let lean = normals[v].angle_between(positions[v]);
                assert!(lean < 2e-3, "vertex {v}: {lean} rad off");
            }
            let (first, last) = (i * (columns + 1), i * (columns + 1) + columns);
            assert_eq!(normals[first], normals[last], "the seam shows in row {i}");
        }
        // The upper half moved forward leaves a shelf: its normals are no sphere's.
        let Some((_, lifted)) = computed(name, &avatar, &[0.0, 1.0, 0.0]) else { return };
        assert!(normals.iter().zip(&lifted).any(|(a, b)| a.distance(*b) > 0.3));
    }

    #[test]
    fn shadow_edge_spreads_over_coarse_triangles() {
        let name = "shadow_edge_spreads_over_coarse_triangles";
        let mut avatar = planted();
        // A ball between the key light and the front of the sphere, whose rows are 10 mm apart:
        // as wide as the light's own penumbra.
        let ball = sphere(Vec3::new(-0.06, 0.075, 0.1), 0.025);
        avatar.meshes.push(Mesh {
            part: Part::Hair,
            shapes: vec![SparseShape::default(); 3],
            ..ball
        });
        let Some((_, surfaces)) = tables(name, &avatar, &[0.0; 3]) else { return };
        let columns = 2 * ROWS;
        // The half of the sphere that faces the light, away from the eye.
        let key = Vec3::new(-0.4364, 0.5455, 0.7155);
        let lit = |v: &usize| surfaces[*v].truncate().dot(key) > 0.3;
        let (mut darkest, mut brightest, mut steepest) = (1.0_f32, 0.0_f32, 0.0_f32);
        for (i, j) in (2..ROWS - 2).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let at = |i: usize, j: usize| i * (columns + 1) + j;
            let here = at(i, j);
            for next in [at(i + 1, j), at(i, j + 1)].iter().filter(|v| lit(v) && lit(&here)) {
                let (a, b) = (surfaces[here].w, surfaces[*next].w);
                darkest = darkest.min(a);
                brightest = brightest.max(a);
                steepest = steepest.max((a - b).abs());
            }
        }
        assert!(brightest > 0.8, "nothing is lit: {brightest}");
        assert!(darkest < 0.3, "nothing is in shadow: {darkest}");
        assert!(steepest < 0.3, "a step of {steepest} from vertex to vertex");
        let (first, last) = (8 * (columns + 1), 8 * (columns + 1) + columns);
        assert_eq!(surfaces[first], surfaces[last], "the seam shows");
    }
}
