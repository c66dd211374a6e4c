//! Pictures on surfaces: from the bytes that travel to pixels, the same bits on every machine.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::Texture;

/// Longest side of a [`Texture`], pixels: what every WebGL2 takes.
pub const MOST_TEXTURE_SIDE: usize = 2048;

/// A decoded picture: sRGB with the opening in the fourth byte, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}

/// A picture that cannot be decoded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}; export the picture again")]
pub struct TextureError(pub(crate) String);

impl Image {
    /// Decodes a texture.
    ///
    /// # Errors
    /// [`TextureError`] when it is no JPEG, damaged, or larger than [`MOST_TEXTURE_SIDE`].
    pub fn decode(texture: &Texture) -> Result<Self, TextureError> {
        let (width, height, rgb) = decode_jpeg(&texture.jpeg, ColorSpace::RGB, MOST_TEXTURE_SIDE)?;
        let mut rgba = vec![255u8; 4 * width * height];
        rgba.chunks_exact_mut(4).zip(rgb.chunks_exact(3)).for_each(|(to, from)| {
            to[..3].copy_from_slice(from);
        });
        if !texture.mask_jpeg.is_empty() {
            let mask = decode_jpeg(&texture.mask_jpeg, ColorSpace::Luma, MOST_TEXTURE_SIDE)?;
            if (mask.0, mask.1) != (width, height) {
                let what =
                    format!("a mask of {} x {} on a picture of {width} x {height}", mask.0, mask.1);
                return Err(TextureError(what));
            }
            rgba.chunks_exact_mut(4).zip(&mask.2).for_each(|(to, open)| to[3] = *open);
        }
        Ok(Self { width, height, rgba })
    }

    /// The colour at a place of the picture, linear, 0 to 1: that of the nearest pixel.
    pub fn linear_at(&self, uv: [f32; 2]) -> [f32; 3] {
        let index = |x: f32, count: usize| {
            let inside = x - x.floor();
            ((inside * count as f32) as usize).min(count - 1)
        };
        let at = 4 * (index(uv[1], self.height) * self.width + index(uv[0], self.width));
        std::array::from_fn(|c| linear_of_srgb(self.rgba[at + c]))
    }

    /// The picture at half the size, averaged in linear light; odd rows and columns are kept by
    /// the last average of three.
    pub fn half(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let light: Vec<f32> = (0..=255).map(linear_of_srgb).collect();
        let span = |i: usize, half: usize, full: usize| {
            let end = if i + 1 == half { full } else { 2 * i + 2 };
            2 * i..end
        };
        let mut rgba = Vec::with_capacity(4 * width * height);
        for y in 0..height {
            for x in 0..width {
                let (mut sum, mut count) = ([0f32; 4], 0f32);
                for row in span(y, height, self.height) {
                    for column in span(x, width, self.width) {
                        let at = 4 * (row * self.width + column);
                        for c in 0..3 {
                            sum[c] += light[usize::from(self.rgba[at + c])];
                        }
                        sum[3] += f32::from(self.rgba[at + 3]);
                        count += 1.0;
                    }
                }
                rgba.extend((0..3).map(|c| srgb_of_linear(sum[c] / count)));
                rgba.push((sum[3] / count).round() as u8);
            }
        }
        Self { width, height, rgba }
    }
}

/// Width, height and samples of a JPEG file that is at most `most` pixels wide and high.
pub(crate) fn decode_jpeg(
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
    if !plausible(width * height * space.num_components(), bytes.len()) {
        return Err(failed(format!("{width} x {height} pixels in {} bytes", bytes.len())));
    }
    let samples = decoder.decode().map_err(|e| failed(format!("{e:?}")))?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    if width == 0 || height == 0 || samples.len() != width * height * space.num_components() {
        return Err(failed(format!("{} samples for {width} x {height}", samples.len())));
    }
    Ok((width, height, samples))
}

/// Whether a file of `bytes` can hold so many samples: even a plain picture packs no thousand
/// samples in a byte. What a damaged header promises beyond that is not made room for.
pub(crate) fn plausible(samples: usize, bytes: usize) -> bool {
    samples <= (4 << 20) + 1100 * bytes
}

/// IEC 61966-2-1.
fn linear_of_srgb(byte: u8) -> f32 {
    let c = f32::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

fn srgb_of_linear(c: f32) -> u8 {
    let c = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (255.0 * c).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_average_light_not_bytes() {
        let rgba = [[0, 0, 0, 255], [255, 255, 255, 255], [255, 255, 255, 0], [0, 0, 0, 255]];
        let image = Image { width: 2, height: 2, rgba: rgba.concat() };
        // Half of the light is sRGB 188, not 128.
        assert_eq!(image.half().rgba, [188, 188, 188, 191]);
        let row = Image { width: 3, height: 1, rgba: [[9, 9, 9, 9]; 3].concat() };
        assert_eq!(row.half(), Image { width: 1, height: 1, rgba: vec![9; 4] });
    }

    #[test]
    fn every_byte_survives_the_way_to_light_and_back() {
        for byte in 0..=255 {
            assert_eq!(srgb_of_linear(linear_of_srgb(byte)), byte);
        }
    }

    #[test]
    fn places_repeat_beyond_the_picture() {
        let rgba = vec![0, 0, 0, 255, 255, 255, 255, 255];
        let image = Image { width: 2, height: 1, rgba };
        for (u, light) in [(0.2, 0.0), (0.7, 1.0), (1.0, 0.0), (-0.2, 1.0), (5.6, 1.0)] {
            assert_eq!(image.linear_at([u, 0.4]), [light; 3], "{u}");
        }
    }
}
