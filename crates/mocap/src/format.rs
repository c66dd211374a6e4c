//! The formats this crate reads, and how each is recognised by its content.

use crate::ReadError;
use crate::text::{self, Delimiter, Lines};

/// A file format of motion capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// C3D, binary: Intel, DEC or MIPS byte order, integer or float.
    C3d,
    /// CSV with a column a coordinate: `frame,time,LABEL_x,LABEL_y,LABEL_z`.
    WideCsv,
    /// CSV with a row a marker and frame: `frame,time,marker,x,y,z`.
    LongCsv,
    /// Motion Analysis and OpenSim TRC.
    Trc,
    /// Qualisys Track Manager TSV.
    QtmTsv,
    /// OptiTrack Motive CSV.
    MotiveCsv,
    /// Vicon Nexus CSV.
    ViconCsv,
    /// BVH: joints of a skeleton.
    Bvh,
    /// Live Link Face CSV: weights, not markers.
    LiveLinkCsv,
}

impl Format {
    /// The name people use.
    pub fn name(self) -> &'static str {
        match self {
            Self::C3d => "C3D",
            Self::WideCsv => "CSV, a column a coordinate",
            Self::LongCsv => "CSV, a row a marker and frame",
            Self::Trc => "TRC",
            Self::QtmTsv => "QTM TSV",
            Self::MotiveCsv => "Motive CSV",
            Self::ViconCsv => "Vicon CSV",
            Self::Bvh => "BVH",
            Self::LiveLinkCsv => "Live Link Face CSV (weights)",
        }
    }
}

/// Whether the bytes open like a C3D file: the key `0x50` in the second byte of a binary header.
pub(crate) fn is_c3d(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(512)];
    let utf16 = head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]);
    head.len() > 24 && head[1] == 0x50 && !utf16 && head.contains(&0)
}

/// Recognise a text format by its first line that is neither blank nor a comment; `None` when no
/// reader knows it.
///
/// # Errors
/// [`ReadError::Read`].
pub(crate) fn recognise_text(mut lines: Lines<'_>) -> Result<Option<Format>, ReadError> {
    loop {
        match lines.next_filled() {
            Ok(Some((_, line))) if line.starts_with('#') => {}
            Ok(Some((_, line))) => return Ok(format_of(line)),
            // What has no end of a line for megabytes is no text.
            Ok(None) | Err(ReadError::Text { .. }) => return Ok(None),
            Err(error) => return Err(error),
        }
    }
}

/// The format that starts with a line.
fn format_of(header: &str) -> Option<Format> {
    let delimiter = Delimiter::of(header);
    if text::trc::is_first_line(header) {
        Some(Format::Trc)
    } else if text::bvh::is_first_line(header) {
        Some(Format::Bvh)
    } else if text::qtm_tsv::is_first_line(header) {
        Some(Format::QtmTsv)
    } else if text::motive_csv::is_first_line(header) {
        Some(Format::MotiveCsv)
    } else if text::vicon_csv::is_first_line(header) {
        Some(Format::ViconCsv)
    } else if text::live_link::is_header(header) {
        Some(Format::LiveLinkCsv)
    } else if text::long_csv::is_header(header, delimiter) {
        Some(Format::LongCsv)
    } else if text::wide_csv::is_header(header, delimiter) {
        Some(Format::WideCsv)
    } else if text::qtm_tsv::is_row(header) {
        Some(Format::QtmTsv)
    } else {
        None
    }
}
