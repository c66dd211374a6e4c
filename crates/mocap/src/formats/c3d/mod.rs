//! C3D, the binary format of most systems: 512-byte header, parameter section, data section.
//!
//! Read: Intel, DEC and MIPS processors; integer and float storage; groups and parameters in any
//! order; more than 255 labels (`LABELS2`...); any first frame; more than 65,535 frames; a missing
//! or empty parameter section (labels and unit are then made up, and it is said). Analog data are
//! stepped over. A marker is missing where its fourth word is negative or a coordinate is NaN.

mod header;
mod number;
mod parameters;
mod points;
mod read;
mod write;

pub use number::Processor;
pub use write::{C3dOptions, C3dStorage, write_c3d};

use super::format::{Format, Read, Recognise, Write};

pub(super) static FORMAT: Format = Format {
    id: "c3d",
    name: "C3D",
    extensions: &["c3d"],
    recognised_by: "key byte and binary header",
    reads: "Intel, DEC, MIPS; integers and floats; parameters in any order; `LABELS2`; more than 65,535 frames; events, system, number of analog channels",
    recognise: Recognise::Beginning(is_c3d),
    read: Read::Binary(read::read),
    write: Some(Write::Capture(|capture, _| write_c3d(capture, &C3dOptions::default()))),
};

/// Whether the bytes open like a C3D file: the key `0x50` in the second byte of a binary header.
fn is_c3d(bytes: &[u8]) -> bool {
    let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    bytes.len() > 24 && bytes[1] == 0x50 && !utf16 && bytes.contains(&0)
}
