//! A picture as pixels: sizes and light.

/// Longest side of a [`Texture`](crate::Texture), pixels: what every WebGL2 takes.
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

impl Image {
    /// The picture of those pixels, rows of `width` from the top; none when they fill no rows, or a
    /// side is longer than [`MOST_TEXTURE_SIDE`].
    pub fn of_pixels(width: usize, rgba: Vec<u8>) -> Option<Self> {
        let height = rgba.len().checked_div(4 * width)?;
        let whole = height > 0 && rgba.len() == 4 * width * height;
        (whole && width.max(height) <= MOST_TEXTURE_SIDE).then_some(Self { width, height, rgba })
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
