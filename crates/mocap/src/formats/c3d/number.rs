//! Numbers of the three processors C3D files were written on.

/// Processor whose byte order and floats a C3D file uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Processor {
    /// Little-endian, IEEE floats.
    Intel,
    /// Little-endian integers, VAX F floats (DEC).
    Dec,
    /// Big-endian, IEEE floats (MIPS, SGI).
    Mips,
}

impl Processor {
    /// The byte that names it in the parameter section.
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::Intel => 84,
            Self::Dec => 85,
            Self::Mips => 86,
        }
    }

    /// The processor of that byte (some writers leave out the offset of 83).
    pub(crate) fn from_code(code: u8) -> Option<Self> {
        match code {
            84 | 1 => Some(Self::Intel),
            85 | 2 => Some(Self::Dec),
            86 | 3 => Some(Self::Mips),
            _ => None,
        }
    }

    /// A 16-bit word.
    pub(crate) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Intel | Self::Dec => u16::from_le_bytes(bytes),
            Self::Mips => u16::from_be_bytes(bytes),
        }
    }

    /// The bytes of a 16-bit word.
    pub(crate) fn u16_bytes(self, value: u16) -> [u8; 2] {
        match self {
            Self::Intel | Self::Dec => value.to_le_bytes(),
            Self::Mips => value.to_be_bytes(),
        }
    }

    /// The bytes of a 32-bit float.
    pub(crate) fn f32_bytes(self, value: f32) -> [u8; 4] {
        match self {
            Self::Intel => value.to_le_bytes(),
            Self::Mips => value.to_be_bytes(),
            Self::Dec => vax_of_f32(value),
        }
    }

    /// A 32-bit float.
    pub(crate) fn f32(self, bytes: [u8; 4]) -> f32 {
        match self {
            Self::Intel => f32::from_le_bytes(bytes),
            Self::Mips => f32::from_be_bytes(bytes),
            Self::Dec => f32_of_vax(bytes),
        }
    }
}

/// A VAX F float: two little-endian words, the more significant first; sign, 8 bits of exponent
/// with bias 128, 23 bits of a fraction 0.1f (the leading bit hidden). Sign without exponent is a
/// reserved operand: NaN.
fn f32_of_vax(bytes: [u8; 4]) -> f32 {
    let bits = u32::from_be_bytes([bytes[1], bytes[0], bytes[3], bytes[2]]);
    let exponent = (bits >> 23) & 0xff;
    if exponent == 0 {
        return if bits >> 31 == 1 { f32::NAN } else { 0.0 };
    }
    // 0.1f x 2^(e-128) = 1.f x 2^(e-129): the fraction as in an IEEE float of exponent 0, scaled.
    let fraction = f64::from(f32::from_bits((bits & 0x807f_ffff) | (127 << 23)));
    (fraction * 2.0_f64.powi(exponent as i32 - 129)) as f32
}

/// The VAX F float of a value: the exponent two higher than in IEEE. Below its range (2^-128) it
/// becomes 0; what it cannot hold (2^127 and more, not finite) the reserved operand.
fn vax_of_f32(value: f32) -> [u8; 4] {
    let bits = value.to_bits();
    let exponent = (bits >> 23) & 0xff;
    let vax = match exponent {
        0 => 0,
        1..=253 => bits + (2 << 23),
        _ => 1 << 31,
    };
    let [a, b, c, d] = vax.to_be_bytes();
    [b, a, d, c]
}

/// A byte slice read in one processor's numbers; positions past the end are `None`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Words<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) processor: Processor,
}

impl Words<'_> {
    /// The 16-bit word at a byte offset.
    pub(crate) fn u16(self, at: usize) -> Option<u16> {
        let pair = self.bytes.get(at..)?.first_chunk()?;
        Some(self.processor.u16(*pair))
    }

    /// The 32-bit float at a byte offset.
    pub(crate) fn f32(self, at: usize) -> Option<f32> {
        let four = self.bytes.get(at..)?.first_chunk()?;
        Some(self.processor.f32(*four))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vax_floats_of_known_bits() {
        // 1.0 is 0x4080 0000, -3.5 is 0xC160 0000, 0.1 is 0x3ECC CCCD; words least byte first.
        for (bytes, value) in [
            ([0x80, 0x40, 0, 0], 1.0),
            ([0x60, 0xc1, 0, 0], -3.5),
            ([0xcc, 0x3e, 0xcd, 0xcc], 0.1),
            ([0, 0, 0, 0], 0.0),
        ] {
            assert_eq!(Processor::Dec.f32(bytes), value);
        }
        assert!(Processor::Dec.f32([0, 0x80, 0, 0]).is_nan());
        assert!(Processor::Dec.f32(Processor::Dec.f32_bytes(f32::NAN)).is_nan());
    }

    #[test]
    fn every_processor_gives_back_what_it_wrote() {
        for processor in [Processor::Intel, Processor::Dec, Processor::Mips] {
            for value in [0.0, 1.0, -1.0, 1611.3685, 1e-30, -3.0e30, 65_535.0] {
                assert_eq!(processor.f32(processor.f32_bytes(value)), value, "{processor:?}");
            }
            assert_eq!(processor.u16(processor.u16_bytes(0xfe01)), 0xfe01);
        }
    }
}
