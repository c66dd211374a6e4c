//! From a file of any known format to a capture.

use crate::{Capture, Format, LengthUnit, ReadError, Recording, WeightTake, c3d, format, text};
use std::path::Path;

/// What the caller knows better than the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of the coordinates. `None`: what the file says, else guessed by magnitude and noted.
    pub unit: Option<LengthUnit>,
    /// Frames a second. `None`: what the file says.
    pub rate_hz: Option<f64>,
}

/// Read a capture file, its format recognised by content.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read(path: &Path) -> Result<Capture, ReadError> {
    let bytes = std::fs::read(path)
        .map_err(|source| ReadError::Open { path: path.to_path_buf(), source })?;
    read_bytes(&path.to_string_lossy(), &bytes)
}

/// Read a capture from bytes; `name` (a file name) only decides between formats that look alike.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_bytes(name: &str, bytes: &[u8]) -> Result<Capture, ReadError> {
    read_recording(name, bytes, &ReadOptions::default()).map(|recording| recording.capture)
}

/// Read a capture with everything else its file says; `options` override the file.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_recording(
    _name: &str,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<Recording, ReadError> {
    if format::is_c3d(bytes) {
        return c3d::read(bytes, options);
    }
    let document = text::Document::decode(bytes);
    match format::recognise_text(&document) {
        Some(Format::WideCsv) => text::wide_csv::read(&document, options),
        Some(Format::Bvh) => text::bvh::read(&document, options),
        Some(Format::LongCsv) => text::long_csv::read(&document, options),
        Some(Format::Trc) => text::trc::read(&document, options),
        Some(Format::QtmTsv) => text::qtm_tsv::read(&document, options),
        Some(Format::MotiveCsv) => text::motive_csv::read(&document, options),
        Some(Format::ViconCsv) => text::vicon_csv::read(&document, options),
        Some(Format::LiveLinkCsv) => {
            let take = text::live_link::read(&document)?;
            Err(ReadError::WeightsNotMarkers { columns: take.names.len() })
        }
        Some(Format::C3d) | None => Err(ReadError::Unrecognised { found: beginning(bytes) }),
    }
}

/// Read a performance recorded as weights (Live Link Face CSV).
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_weights(_name: &str, bytes: &[u8]) -> Result<WeightTake, ReadError> {
    let document = text::Document::decode(bytes);
    match format::recognise_text(&document) {
        Some(Format::LiveLinkCsv) => text::live_link::read(&document),
        _ => Err(ReadError::NotWeights { found: beginning(bytes) }),
    }
}

/// The first bytes of a file, fit to print.
fn beginning(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "the file is empty".to_owned();
    }
    let head: String =
        bytes.iter().take(24).flat_map(|b| b.escape_ascii()).map(char::from).collect();
    format!("it starts with \"{head}\"")
}
