//! The pictures on surfaces, on the GPU, halved in linear light for their mipmaps. Whoever draws
//! decodes them: natively this project's own decoder, in a browser the browser's.

use mimique_avatar::Image;
use wgpu::{
    Device, Extent3d, Queue, Sampler, TextureDimension, TextureFormat, TextureUsages, TextureView,
};

/// An avatar's pictures.
pub(crate) struct Textures {
    /// What surfaces without a picture are multiplied with.
    white: TextureView,
    views: Vec<TextureView>,
    sampler: Sampler,
}

impl Textures {
    /// Uploads every picture.
    pub fn new(device: &Device, queue: &Queue, pictures: Vec<Image>) -> Self {
        let white = Image { width: 1, height: 1, rgba: vec![255; 4] };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("picture"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self {
            views: pictures.into_iter().map(|picture| upload(device, queue, picture)).collect(),
            white: upload(device, queue, white),
            sampler,
        }
    }

    /// The picture of that index, or white.
    pub fn view(&self, texture: Option<usize>) -> &TextureView {
        texture.and_then(|t| self.views.get(t)).unwrap_or(&self.white)
    }

    /// Between texels and levels, repeated beyond the picture.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }
}

/// A texture with all its levels.
fn upload(device: &Device, queue: &Queue, image: Image) -> TextureView {
    let levels = image.width.max(image.height).ilog2() + 1;
    let size = |image: &Image| Extent3d {
        width: image.width as u32,
        height: image.height as u32,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: size(&image),
        mip_level_count: levels,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut image = image;
    for level in 0..levels {
        if level > 0 {
            image = image.half();
        }
        queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() },
            &image.rgba,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * image.width as u32),
                rows_per_image: Some(image.height as u32),
            },
            size(&image),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
