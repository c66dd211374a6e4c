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
pub(crate) use read::read;
pub use write::{C3dOptions, C3dStorage, write_c3d};
