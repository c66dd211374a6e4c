//! Draws one frame of a head into a texture view.

use glam::Vec3;
use mimique_avatar::{Avatar, Image};
use wgpu::{Device, LoadOp, Operations, Queue, StoreOp, TextureFormat, TextureUsages, TextureView};

use crate::framing::{Camera, View};
use crate::head::Head;
use crate::layouts::{SHADOW_SIZE, Scene};
use crate::pipelines::{DEPTH_FORMAT, Pipelines};
use crate::tables;
use crate::targets::{self, Encoder, Targets};
use crate::{Look, StageError};

/// Towards the key light; `scene.wgsl`, constant `KEY`.
const TOWARDS_KEY: Vec3 = Vec3::new(-0.4364, 0.5455, 0.7155);

/// How often the key light's visibility is softened, there and back between two tables: twice spreads
/// a step over about four triangles.
const SOFTENINGS: u32 = 2;

/// Pipelines, targets and the look: draws any head that it loaded.
pub struct Renderer {
    device: Device,
    queue: Queue,
    pipelines: Pipelines,
    look: Look,
    #[cfg(feature = "native")]
    target_format: TextureFormat,
    /// Format of the samples.
    format: TextureFormat,
    size: [u32; 2],
    encoder: Option<Encoder>,
    targets: Targets,
    shadow: TextureView,
    shadow_sampler: wgpu::Sampler,
}

impl Renderer {
    /// A renderer for pictures of `format` (encoded as sRGB whether the format does so by itself or
    /// not) and `size` pixels, width and height.
    pub fn new(
        device: &Device,
        queue: &Queue,
        format: TextureFormat,
        size: [u32; 2],
        look: Look,
    ) -> Self {
        let shadow_usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let shadow =
            tables::empty(device, "shadow", DEPTH_FORMAT, SHADOW_SIZE, SHADOW_SIZE, shadow_usage)
                .create_view(&wgpu::TextureViewDescriptor::default());
        let shadow_sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..wgpu::SamplerDescriptor::default()
        });
        let size = size.map(|s| s.max(1));
        let encoder = Encoder::new(device, format);
        let samples = targets::light_format(format);
        Self {
            #[cfg(feature = "native")]
            target_format: format,
            targets: Targets::new(device, samples, size, encoder.as_ref()),
            encoder,
            pipelines: Pipelines::new(device, samples),
            device: device.clone(),
            queue: queue.clone(),
            look,
            format: samples,
            size,
            shadow,
            shadow_sampler,
        }
    }

    /// Decodes an avatar's pictures and puts it on the GPU.
    ///
    /// # Errors
    /// [`StageError`] when the avatar is malformed or too large for this machine.
    #[cfg(feature = "native")]
    pub fn load(&self, avatar: &Avatar) -> Result<Head, StageError> {
        let pictures = avatar.textures.iter().enumerate().map(|(index, texture)| {
            Image::decode(texture).map_err(|e| StageError::Texture { index, what: e.to_string() })
        });
        self.load_with(avatar, pictures.collect::<Result<_, _>>()?)
    }

    /// Puts an avatar on the GPU, with its pictures decoded, one per texture.
    ///
    /// # Errors
    /// [`StageError`] when the avatar is malformed, too large for this machine, or lacks a picture.
    pub fn load_with(&self, avatar: &Avatar, pictures: Vec<Image>) -> Result<Head, StageError> {
        if pictures.len() != avatar.textures.len() {
            return Err(StageError::Texture {
                index: pictures.len().min(avatar.textures.len()),
                what: format!(
                    "{} pictures were decoded, the avatar has {}; load it again",
                    pictures.len(),
                    avatar.textures.len()
                ),
            });
        }
        let shadow = (&self.shadow, &self.shadow_sampler);
        let (device, queue) = (&self.device, &self.queue);
        let head = Head::new(device, queue, &self.pipelines, shadow, avatar, pictures)?;
        self.find_occlusions(&head);
        Ok(head)
    }

    /// The camera's clip-from-world matrix for a head, column by column: for what is drawn over the
    /// picture, such as markers.
    pub fn camera(&self, head: &Head, view: View) -> [f32; 16] {
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        Camera::portrait(&head.landmarks, view, aspect).clip_from_world.to_cols_array()
    }

    /// Changes the size of the pictures, pixels.
    pub fn resize(&mut self, size: [u32; 2]) {
        let size = size.map(|s| s.max(1));
        if size != self.size {
            self.size = size;
            self.targets = Targets::new(&self.device, self.format, size, self.encoder.as_ref());
        }
    }

    /// Size of the pictures, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Format of the targets.
    #[cfg(feature = "native")]
    pub(crate) fn target_format(&self) -> TextureFormat {
        self.target_format
    }

    /// Changes the look of the frames to come.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
    }

    /// Draws `head` at `weights` (one per blendshape; missing ones are 0) into `target`, which has
    /// the renderer's format and size. The frame is submitted. No buffer and no texture is made:
    /// what a frame takes (a command encoder, its passes, the way of the constants to the GPU) is
    /// given back once the GPU is done with it.
    pub fn render(&self, target: &TextureView, head: &Head, view: View, weights: &[f32]) {
        let pose = head.pose(weights);
        self.queue.write_buffer(&head.pose_buffer, 0, pose.bytes(head.shape_count));
        self.queue.write_buffer(
            &head.scene_buffer,
            0,
            bytemuck::bytes_of(&self.scene(head, view, weights)),
        );
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        let clear = LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let passes = &self.pipelines;
        fill_table(&mut encoder, &head.positions, &passes.deform, &head.groups.deform, clear);
        self.light_pass(&mut encoder, head);
        fill_table(&mut encoder, &head.surfaces, &passes.surface, &head.groups.surface, clear);
        let [onward, back] = &head.groups.soften;
        for _ in 0..SOFTENINGS {
            fill_table(&mut encoder, &head.softened, &passes.soften, onward, clear);
            fill_table(&mut encoder, &head.surfaces, &passes.soften, back, clear);
        }
        fill_table(&mut encoder, &head.strains, &passes.strain, &head.groups.strain, clear);
        match (&self.encoder, &self.targets.resolved) {
            (Some(encode), Some((resolved, group))) => {
                self.picture_pass(&mut encoder, head, resolved);
                fill_table(&mut encoder, target, &encode.pipeline, group, clear);
            }
            _ => self.picture_pass(&mut encoder, head, target),
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Looks at the neutral head from many sides and sums up where each vertex is seen from.
    fn find_occlusions(&self, head: &Head) {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("occlusions") };
        self.queue.write_buffer(&head.pose_buffer, 0, head.pose(&[]).bytes(head.shape_count));
        for (i, towards) in sky().enumerate() {
            let mut scene = self.scene(head, View::FRONT, &[]);
            scene.light_from_world = Camera::light(&head.landmarks, towards).to_cols_array_2d();
            self.queue.write_buffer(&head.scene_buffer, 0, bytemuck::bytes_of(&scene));
            let mut encoder = self.device.create_command_encoder(&descriptor);
            let clear = LoadOp::Clear(wgpu::Color::TRANSPARENT);
            let passes = &self.pipelines;
            if i == 0 {
                fill_table(
                    &mut encoder,
                    &head.positions,
                    &passes.deform,
                    &head.groups.deform,
                    clear,
                );
                fill_table(
                    &mut encoder,
                    &head.surfaces,
                    &passes.surface,
                    &head.groups.surface,
                    clear,
                );
            }
            self.light_pass(&mut encoder, head);
            let sum = if i == 0 { clear } else { LoadOp::Load };
            fill_table(
                &mut encoder,
                &head.occlusions,
                &passes.occlusion,
                &head.groups.occlusion,
                sum,
            );
            self.queue.submit([encoder.finish()]);
        }
    }

    fn light_pass(&self, encoder: &mut wgpu::CommandEncoder, head: &Head) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("light"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.shadow,
                depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipelines.light);
        pass.set_bind_group(0, &head.groups.light, &[]);
        pass.set_index_buffer(head.indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in head.draws.iter().filter(|d| d.casts_shadow) {
            pass.draw_indexed(draw.indices.clone(), 0, 0..1);
        }
    }

    fn picture_pass(&self, encoder: &mut wgpu::CommandEncoder, head: &Head, target: &TextureView) {
        let [r, g, b] = self.look.background.map(f64::from);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.targets.samples,
                depth_slice: None,
                resolve_target: Some(target),
                ops: Operations {
                    load: LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                    store: StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets.depth,
                depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &head.groups.shade, &[]);
        pass.set_vertex_buffer(0, head.colours.slice(..));
        pass.set_vertex_buffer(1, head.uvs.slice(..));
        pass.set_index_buffer(head.indices.slice(..), wgpu::IndexFormat::Uint32);
        for (draw, picture) in head.draws.iter().zip(&head.picture_groups) {
            pass.set_bind_group(1, picture, &[]);
            pass.set_pipeline(self.pipelines.picture(draw.layer));
            pass.draw_indexed(draw.indices.clone(), 0, 0..1);
        }
    }

    fn scene(&self, head: &Head, view: View, weights: &[f32]) -> Scene {
        let aspect = self.size[0] as f32 / self.size[1] as f32;
        let camera = Camera::portrait(&head.landmarks, view, aspect);
        let span = head.landmarks.eye_span();
        let eyes = head.landmarks.eyes_middle();
        let (mouth, nose) = (head.landmarks.mouth, head.landmarks.nose_tip);
        let with = |v: [f32; 3], w: f32| [v[0], v[1], v[2], w];
        Scene {
            clip_from_world: camera.clip_from_world.to_cols_array_2d(),
            light_from_world: Camera::light(&head.landmarks, TOWARDS_KEY).to_cols_array_2d(),
            camera: camera.position.extend(0.0).into(),
            eyes_middle: with(eyes, span),
            mouth: [mouth[0], mouth[1], nose[2] - 0.34 * span, 0.55 * span],
            lips: self.lips(head),
            skin: with(self.look.skin_tint, self.look.skin_roughness),
            brows: with(self.look.brows, if self.look.paint { 1.0 } else { 0.0 }),
            light: [self.look.exposure, 0.0, 0.0, 0.0],
            body: head.body(weights),
            gaze: head.gaze(weights, &self.look),
        }
    }

    fn lips(&self, head: &Head) -> [f32; 4] {
        let mouth = head.landmarks.mouth;
        match head.landmarks.mouth_corner {
            Some(corner) if self.look.paint => {
                [mouth[0], mouth[1], corner[0] - mouth[0], corner[1] - mouth[1]]
            }
            _ => [0.0; 4],
        }
    }
}

/// A pass over every vertex of a table.
fn fill_table(
    encoder: &mut wgpu::CommandEncoder,
    table: &TextureView,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
    load: LoadOp<wgpu::Color>,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("table"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: table,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load, store: StoreOp::Store },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}

/// Directions spread evenly over the sky in front of, above and beside a face (a spiral of the
/// golden angle without its rear part).
fn sky() -> impl Iterator<Item = Vec3> {
    const COUNT: u32 = 36;
    (0..COUNT)
        .map(|i| {
            let y = 1.0 - (2.0 * i as f32 + 1.0) / COUNT as f32;
            let (sin, cos) = (2.399_963_2 * i as f32).sin_cos();
            let radius = (1.0 - y * y).sqrt();
            Vec3::new(radius * cos, y, radius * sin)
        })
        .filter(|d| d.z > -0.25)
}
