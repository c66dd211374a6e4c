//! The formats this crate reads, and how each is recognised by its content.

use crate::text::{Delimiter, Document};

/// A file format of motion capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// C3D, binary: Intel, DEC or MIPS byte order, integer or float.
    C3d,
    /// CSV with a column a coordinate: `frame,time,LABEL_x,LABEL_y,LABEL_z`.
    WideCsv,
}

impl Format {
    /// The name people use.
    pub fn name(self) -> &'static str {
        match self {
            Self::C3d => "C3D",
            Self::WideCsv => "CSV, a column a coordinate",
        }
    }
}

/// Whether the bytes open like a C3D file: the key `0x50` in the second byte of a binary header.
pub(crate) fn is_c3d(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(512)];
    let utf16 = head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]);
    head.len() > 24 && head[1] == 0x50 && !utf16 && head.contains(&0)
}

/// Recognise a text format by the first lines of the document.
pub(crate) fn recognise_text(document: &Document<'_>) -> Option<Format> {
    let (_, header) =
        document.lines().find(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'))?;
    let delimiter = Delimiter::of(header);
    crate::text::wide_csv::is_header(header, delimiter).then_some(Format::WideCsv)
}
