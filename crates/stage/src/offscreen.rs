//! Pictures without a window: for golden images, contact sheets and the preview's command line.

use mimique_avatar::Avatar;
use wgpu::{Device, Queue, TextureFormat, TextureUsages};

use crate::{Look, Renderer, StageError, View, tables};

/// An adapter and its device, to draw any number of pictures with.
pub struct Offscreen {
    device: Device,
    queue: Queue,
    adapter: String,
}

/// A picture: 8-bit sRGB with alpha, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}

/// Formats of pictures: the second as of canvases that store bytes as they are.
const FORMATS: [TextureFormat; 2] = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm];

impl Offscreen {
    /// Takes an adapter of this machine. With `software` one that computes on the processor, which
    /// gives the same bits on machines alike; else the best there is.
    ///
    /// # Errors
    /// [`StageError::NoAdapter`] when there is none.
    pub fn new(software: bool) -> Result<Self, StageError> {
        let no_adapter = |what: String| StageError::NoAdapter { what };
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let options =
            wgpu::RequestAdapterOptions { force_fallback_adapter: software, ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| no_adapter(e.to_string()))?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("offscreen"),
            required_limits: wgpu::Limits::downlevel_webgl2_defaults()
                .using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| no_adapter(e.to_string()))?;
        let info = adapter.get_info();
        Ok(Self { device, queue, adapter: format!("{} ({:?})", info.name, info.backend) })
    }

    /// Name of the adapter and of its interface.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// A renderer on this device, for many pictures of one size.
    pub fn renderer(&self, size: [u32; 2], look: Look) -> Renderer {
        Renderer::new(&self.device, &self.queue, FORMATS[0], size, look)
    }

    /// The same, drawing as on a canvas that does not encode sRGB by itself.
    pub fn renderer_as_on_canvas(&self, size: [u32; 2], look: Look) -> Renderer {
        Renderer::new(&self.device, &self.queue, FORMATS[1], size, look)
    }

    /// Draws one picture of an avatar.
    ///
    /// # Errors
    /// [`StageError`] when the avatar cannot be drawn or the picture not be read back.
    pub fn render(
        &self,
        avatar: &Avatar,
        look: Look,
        view: View,
        weights: &[f32],
        size: [u32; 2],
    ) -> Result<Picture, StageError> {
        let renderer = self.renderer(size, look);
        let head = renderer.load(avatar)?;
        self.picture(&renderer, &head, view, weights)
    }

    /// Draws one picture with a renderer and a head of this device.
    ///
    /// # Errors
    /// [`StageError::Readback`] when the device is lost on the way.
    pub fn picture(
        &self,
        renderer: &Renderer,
        head: &crate::Head,
        view: View,
        weights: &[f32],
    ) -> Result<Picture, StageError> {
        let [width, height] = renderer.size();
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let texture =
            tables::empty(&self.device, "picture", renderer.target_format(), width, height, usage);
        renderer.render(
            &texture.create_view(&wgpu::TextureViewDescriptor::default()),
            head,
            view,
            weights,
        );

        Ok(Picture { width, height, rgba: self.read(&texture)? })
    }

    /// The bytes of a texture, rows from the top.
    pub(crate) fn read(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, StageError> {
        let (width, height) = (texture.width(), texture.height());
        let line = width * texture.format().block_copy_size(None).unwrap_or(4);
        let row = line.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        let lost = |what: String| StageError::Readback { what };
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only when the wait below failed, which says more.
            let _ = sender.send(result);
        });
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| lost(e.to_string()))?;
        let mapped = receiver.recv().map_err(|e| lost(e.to_string()))?;
        mapped.map_err(|e| lost(e.to_string()))?;
        let bytes = buffer.get_mapped_range(..).map_err(|e| lost(e.to_string()))?;
        Ok(bytes
            .chunks(row as usize)
            .flat_map(|padded| &padded[..line as usize])
            .copied()
            .collect())
    }
}

impl Picture {
    /// The picture as a PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let written = encoder.write_header().and_then(|mut w| w.write_image_data(&self.rgba));
        debug_assert!(written.is_ok(), "a memory buffer takes every byte");
        out
    }
}
