//! The first 512 bytes of a C3D file.

use super::number::{Processor, Words};
use crate::ReadError;
use crate::formats::source::Prefix;

/// Bytes of a block: sections start at multiples of it.
pub(crate) const BLOCK: usize = 512;

/// What the header says; the parameters may overrule it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Header {
    pub(crate) processor: Processor,
    /// Byte where the parameter section starts; `None` where there is none.
    pub(crate) parameters_at: Option<usize>,
    pub(crate) points: usize,
    /// Analog numbers in a frame of points, all channels and samples.
    pub(crate) analog_per_frame: usize,
    pub(crate) first_frame: u64,
    pub(crate) last_frame: u64,
    /// Millimetres (or what the unit is) of one integer; negative: data are floats.
    pub(crate) scale: f32,
    /// Byte where the data start; 0 where the header does not say.
    pub(crate) data_at: usize,
    pub(crate) analog_samples: usize,
    pub(crate) rate_hz: f32,
}

impl Header {
    /// Read it. The processor stands in the parameter section; where that is missing, the one
    /// whose numbers make sense is taken.
    pub(crate) fn read(file: &mut Prefix<'_>, notes: &mut Vec<String>) -> Result<Self, ReadError> {
        let length = file.length();
        let Some(bytes) = file.get(0..BLOCK)?.and_then(|head| head.first_chunk::<BLOCK>()) else {
            return Err(ReadError::at_byte(
                length,
                "header",
                format!("the file ends after {length} bytes of a 512-byte header"),
                "copy or export the file again, it is cut short",
            ));
        };
        let bytes = *bytes;
        let parameters_at = usize::from(bytes[0])
            .checked_sub(1)
            .map(|block| block * BLOCK)
            .filter(|&at| at >= BLOCK && at as u64 + 4 <= length);
        let code = match parameters_at {
            None => None,
            Some(at) => file.get(at..at + 4)?.map(|head| head[3]),
        };
        let named = code.and_then(Processor::from_code);
        let processor = match named {
            Some(processor) => processor,
            None => {
                let likely = [Processor::Intel, Processor::Mips, Processor::Dec]
                    .into_iter()
                    .find(|&p| Self::with(&bytes, p, None).is_plausible());
                let Some(processor) = likely else {
                    return Err(ReadError::at_byte(
                        parameters_at.map_or(0, |at| at as u64 + 3),
                        "header",
                        match code {
                            Some(code) => format!("processor {code} is not 84, 85 or 86"),
                            None => format!("parameter block {} is not in the file", bytes[0]),
                        },
                        "export the file again with its parameter section",
                    ));
                };
                notes.push(format!(
                    "no processor named in the parameter section: {processor:?} numbers make sense"
                ));
                processor
            }
        };
        Ok(Self::with(&bytes, processor, parameters_at))
    }

    /// Decode a header.
    fn with(bytes: &[u8; BLOCK], processor: Processor, parameters_at: Option<usize>) -> Self {
        let words = Words { bytes, processor };
        let word = |at| words.u16(at).unwrap_or(0);
        let float = |at| words.f32(at).unwrap_or(0.0);
        Self {
            processor,
            parameters_at,
            points: usize::from(word(2)),
            analog_per_frame: usize::from(word(4)),
            first_frame: u64::from(word(6)),
            last_frame: u64::from(word(8)),
            scale: float(12),
            data_at: usize::from(word(16)).saturating_sub(1) * BLOCK,
            analog_samples: usize::from(word(18)),
            rate_hz: float(20),
        }
    }

    /// Whether the numbers can be those of a recording.
    fn is_plausible(&self) -> bool {
        (1.0..=100_000.0).contains(&self.rate_hz)
            && (1e-9..1e6).contains(&self.scale.abs())
            && self.last_frame >= self.first_frame
            && self.data_at >= BLOCK
    }
}
