//! The data section of a C3D file: frames of points, each followed by its analog samples.

use super::number::Words;

/// How the data section is laid out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// Byte where the data start.
    pub(crate) start: usize,
    /// Points a frame.
    pub(crate) points: usize,
    /// Analog numbers a frame.
    pub(crate) analog: usize,
    pub(crate) storage: Storage,
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Storage {
    /// 32-bit floats in the capture's unit.
    Float,
    /// 16-bit integers times this.
    Integer(f64),
}

impl Layout {
    /// Bytes of a frame.
    pub(crate) fn stride(&self) -> usize {
        let word = match self.storage {
            Storage::Float => 4,
            Storage::Integer(_) => 2,
        };
        (4 * self.points + self.analog) * word
    }

    /// Whole frames in the bytes from `start` on.
    pub(crate) fn frames_present(&self, file_length: usize) -> u64 {
        (file_length.saturating_sub(self.start) / self.stride().max(1)) as u64
    }

    /// Read `frames` frames of the points where `kept` is true; a missing marker is NaN. The
    /// frames must be present.
    pub(crate) fn positions(
        &self,
        words: Words<'_>,
        frames: usize,
        kept: &[bool],
    ) -> Vec<[f64; 3]> {
        let markers = kept.iter().filter(|k| **k).count();
        let mut positions = Vec::with_capacity(frames * markers);
        let data = words.bytes.get(self.start..).unwrap_or(&[]);
        for frame in data.chunks_exact(self.stride().max(1)).take(frames) {
            match self.storage {
                Storage::Float => {
                    for (four, _) in frame.as_chunks::<16>().0.iter().zip(kept).filter(|(_, k)| **k)
                    {
                        positions.push(float_point(four, words));
                    }
                }
                Storage::Integer(scale) => {
                    for (four, _) in frame.as_chunks::<8>().0.iter().zip(kept).filter(|(_, k)| **k)
                    {
                        positions.push(integer_point(four, words, scale));
                    }
                }
            }
        }
        positions
    }
}

/// x, y, z and a fourth float: camera mask and residual, negative where the point is invalid.
fn float_point(bytes: &[u8; 16], words: Words<'_>) -> [f64; 3] {
    let [x, y, z, residual] = std::array::from_fn(|i| {
        words.processor.f32([bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]])
    });
    if residual < 0.0 { [f64::NAN; 3] } else { [x, y, z].map(f64::from) }
}

/// Three integers to be scaled and a fourth word: camera mask and residual bytes, the sign bit set
/// where the point is invalid.
fn integer_point(bytes: &[u8; 8], words: Words<'_>, scale: f64) -> [f64; 3] {
    let [x, y, z, residual] =
        std::array::from_fn(|i| words.processor.u16([bytes[2 * i], bytes[2 * i + 1]]) as i16);
    if residual < 0 { [f64::NAN; 3] } else { [x, y, z].map(|v| f64::from(v) * scale) }
}
