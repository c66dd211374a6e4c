//! What a picture is drawn into before it reaches its target: samples, depth, and, where the target
//! does not encode sRGB by itself, a picture that does and a pass that carries it over.

use wgpu::{BindGroup, Device, RenderPipeline, TextureFormat, TextureUsages, TextureView};

use crate::pipelines::{self, DEPTH_FORMAT, SAMPLES};
use crate::tables;

/// The format in which samples are kept: its bytes are sRGB, its arithmetic linear.
const LIGHT_FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;

/// Targets of one size.
pub(crate) struct Targets {
    pub samples: TextureView,
    pub depth: TextureView,
    /// Where the samples are resolved to, where not straight into the target.
    pub resolved: Option<(TextureView, BindGroup)>,
}

/// The pass that encodes, for target formats that do not.
pub(crate) struct Encoder {
    pub pipeline: RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

/// The format to draw in for a target of `format`.
pub(crate) fn light_format(format: TextureFormat) -> TextureFormat {
    if format.is_srgb() { format } else { LIGHT_FORMAT }
}

impl Encoder {
    /// For a target of `format`; `None` where it encodes by itself.
    pub fn new(device: &Device, format: TextureFormat) -> Option<Self> {
        if format.is_srgb() {
            return None;
        }
        let layout = pipelines::encode_layout(device);
        let pipeline = pipelines::encode_pass(device, &layout, format);
        Some(Self { pipeline, layout })
    }
}

impl Targets {
    /// Targets of `size` pixels for samples of `format`.
    pub fn new(
        device: &Device,
        format: TextureFormat,
        size: [u32; 2],
        encoder: Option<&Encoder>,
    ) -> Self {
        let [width, height] = size;
        let view = |label, format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: SAMPLES,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let resolved = encoder.map(|encoder| {
            let picture = tables::target(device, "resolved", format, width, height);
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("resolved"),
                layout: &encoder.layout,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&picture),
                }],
            });
            (picture, group)
        });
        Self { samples: view("samples", format), depth: view("depth", DEPTH_FORMAT), resolved }
    }
}
