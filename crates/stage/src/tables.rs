//! Tables as textures, the one form of random access that WebGL2 has too.

use wgpu::{
    Device, Extent3d, Queue, Texture, TextureDimension, TextureFormat, TextureUsages, TextureView,
};

use crate::StageError;

/// Rows that a table of `count` entries takes, never none.
pub(crate) fn rows(count: usize, width: u32) -> u32 {
    (count.div_ceil(width as usize) as u32).max(1)
}

/// A texture of `width` and as many rows as `entries` need, filled with them.
///
/// # Errors
/// [`StageError::TooLarge`] when this machine's textures are not high enough.
pub(crate) fn upload<T: bytemuck::Pod>(
    device: &Device,
    queue: &Queue,
    name: &'static str,
    format: TextureFormat,
    width: u32,
    entries: &[T],
) -> Result<TextureView, StageError> {
    let height = rows(entries.len(), width);
    let most = device.limits().max_texture_dimension_2d;
    if height > most {
        return Err(StageError::TooLarge {
            table: name,
            found: entries.len(),
            most: (most * width) as usize,
        });
    }
    let mut padded = entries.to_vec();
    padded.resize((height * width) as usize, T::zeroed());
    let texture = empty(
        device,
        name,
        format,
        width,
        height,
        TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
    );
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&padded),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(width * size_of::<T>() as u32),
            rows_per_image: Some(height),
        },
        Extent3d { width, height, depth_or_array_layers: 1 },
    );
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// A table that a pass fills.
pub(crate) fn target(
    device: &Device,
    name: &'static str,
    format: TextureFormat,
    width: u32,
    height: u32,
) -> TextureView {
    let mut usage = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
    // The tests look at what the passes computed.
    usage.set(TextureUsages::COPY_SRC, cfg!(test));
    empty(device, name, format, width, height, usage)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// An empty texture with one level and one sample.
pub(crate) fn empty(
    device: &Device,
    name: &str,
    format: TextureFormat,
    width: u32,
    height: u32,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
