//! The data section of a C3D file: frames of points, each followed by its analog samples.

use super::number::Processor;
use crate::ReadError;
use crate::formats::source::{CHUNK, Source, fill};
use mimique_geometry::Point;
use std::io::SeekFrom;

/// How the data section is laid out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// Byte where the data start.
    pub(crate) start: u64,
    /// Points a frame.
    pub(crate) points: usize,
    /// Analog numbers per frame.
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
    /// Bytes of a frame, at least 1.
    fn stride(&self) -> u64 {
        let word = match self.storage {
            Storage::Float => 4,
            Storage::Integer(_) => 2,
        };
        ((4 * self.points as u64 + self.analog as u64) * word).max(1)
    }

    /// Whole frames in the bytes from `start` on.
    pub(crate) fn frames_present(&self, file_length: u64) -> u64 {
        file_length.saturating_sub(self.start) / self.stride()
    }

    /// Bytes of the file after `frames` frames; `None` where it does not hold them.
    pub(crate) fn bytes_after(&self, frames: u64, file_length: u64) -> Option<u64> {
        let bytes = frames.checked_mul(self.stride())?;
        file_length.checked_sub(self.start)?.checked_sub(bytes)
    }

    /// Read `frames` frames of the points where `kept` is true; a missing marker is NaN. The
    /// frames must be present.
    pub(crate) fn positions(
        &self,
        source: &mut dyn Source,
        processor: Processor,
        frames: usize,
        kept: &[bool],
    ) -> Result<Vec<Point>, ReadError> {
        let markers = kept.iter().filter(|k| **k).count();
        // Frames that are present: their bytes fit in memory's addresses.
        let stride = self.stride() as usize;
        let mut positions = Vec::with_capacity(frames * markers);
        let mut chunk = vec![0; stride * (CHUNK / stride).clamp(1, frames.max(1))];
        source.seek(SeekFrom::Start(self.start)).map_err(ReadError::Read)?;
        let mut left = frames;
        while left > 0 {
            let wanted = left.min(chunk.len() / stride);
            let read = fill(source, &mut chunk[..wanted * stride])?;
            if read < wanted * stride {
                let frame = frames - left + read / stride;
                return Err(ReadError::at_byte(
                    self.start + ((frames - left) * stride + read) as u64,
                    "data section",
                    format!("the file ends in frame {} of {frames}", frame + 1),
                    "copy or export the file again, it is cut short",
                ));
            }
            for frame in chunk[..read].chunks_exact(stride) {
                self.frame(frame, processor, kept, &mut positions);
            }
            left -= wanted;
        }
        Ok(positions)
    }

    /// The points of one frame.
    fn frame(&self, frame: &[u8], processor: Processor, kept: &[bool], positions: &mut Vec<Point>) {
        match self.storage {
            Storage::Float => {
                let points = frame.as_chunks::<16>().0.iter().zip(kept).filter(|(_, k)| **k);
                positions.extend(points.map(|(four, _)| float_point(four, processor)));
            }
            Storage::Integer(scale) => {
                let points = frame.as_chunks::<8>().0.iter().zip(kept).filter(|(_, k)| **k);
                positions.extend(points.map(|(four, _)| integer_point(four, processor, scale)));
            }
        }
    }
}

/// x, y, z and a fourth float: camera mask and residual, negative where the point is invalid.
fn float_point(bytes: &[u8; 16], processor: Processor) -> Point {
    let [x, y, z, residual] = std::array::from_fn(|i| {
        processor.f32([bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]])
    });
    if residual < 0.0 { Point::UNSEEN } else { [x, y, z].map(f64::from).into() }
}

/// Three integers to be scaled and a fourth word: camera mask and residual bytes, the sign bit set
/// where the point is invalid.
fn integer_point(bytes: &[u8; 8], processor: Processor, scale: f64) -> Point {
    let [x, y, z, residual] =
        std::array::from_fn(|i| processor.u16([bytes[2 * i], bytes[2 * i + 1]]) as i16);
    if residual < 0 { Point::UNSEEN } else { [x, y, z].map(|v| f64::from(v) * scale).into() }
}
