//! Pictures on surfaces: from the bytes that travel to pixels, the same bits on every machine.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::{Image, MOST_TEXTURE_SIDE, Texture};

/// A picture that cannot be decoded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}; export the picture again")]
pub struct TextureError(
    /// What is wrong with it.
    pub String,
);

impl Image {
    /// Decodes a texture.
    ///
    /// # Errors
    /// [`TextureError`] when it is no JPEG, damaged, or larger than [`MOST_TEXTURE_SIDE`].
    pub fn decode(texture: &Texture) -> Result<Self, TextureError> {
        let mut image = Self::of_jpeg(&texture.jpeg, MOST_TEXTURE_SIDE)?;
        let (width, height) = (image.width, image.height);
        if !texture.mask_jpeg.is_empty() {
            let mask = decode_jpeg(&texture.mask_jpeg, ColorSpace::Luma, MOST_TEXTURE_SIDE)?;
            if (mask.0, mask.1) != (width, height) {
                let what =
                    format!("a mask of {} x {} on a picture of {width} x {height}", mask.0, mask.1);
                return Err(TextureError(what));
            }
            let pixels = image.rgba.chunks_exact_mut(4);
            pixels.zip(&mask.2).for_each(|(to, open)| to[3] = *open);
        }
        Ok(image)
    }

    /// Decodes the bytes of a JPEG file, opaque.
    ///
    /// # Errors
    /// [`TextureError`] when they are none, damaged, or a side is longer than `longest_side` pixels.
    pub fn of_jpeg(bytes: &[u8], longest_side: usize) -> Result<Self, TextureError> {
        let (width, height, rgb) = decode_jpeg(bytes, ColorSpace::RGB, longest_side)?;
        let mut rgba = vec![255u8; 4 * width * height];
        rgba.chunks_exact_mut(4).zip(rgb.chunks_exact(3)).for_each(|(to, from)| {
            to[..3].copy_from_slice(from);
        });
        Ok(Self { width, height, rgba })
    }

    /// Whether a file of `bytes` can hold so many samples: even a plain picture packs no thousand
    /// samples in a byte. No room is made for what a damaged header promises beyond that.
    pub fn is_plausible(samples: usize, bytes: usize) -> bool {
        samples <= (4 << 20) + 1100 * bytes
    }
}

/// Width, height and samples of a JPEG file that is at most `most` pixels wide and high.
fn decode_jpeg(
    bytes: &[u8],
    space: ColorSpace,
    most: usize,
) -> Result<(usize, usize, Vec<u8>), TextureError> {
    let failed = |e: String| TextureError(format!("a JPEG picture that cannot be decoded: {e}"));
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(space)
        .set_max_width(most)
        .set_max_height(most);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| failed(format!("{e:?}")))?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    if !Image::is_plausible(width * height * space.num_components(), bytes.len()) {
        return Err(failed(format!("{width} x {height} pixels in {} bytes", bytes.len())));
    }
    let samples = decoder.decode().map_err(|e| failed(format!("{e:?}")))?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    if width == 0 || height == 0 || samples.len() != width * height * space.num_components() {
        return Err(failed(format!("{} samples for {width} x {height}", samples.len())));
    }
    Ok((width, height, samples))
}
