//! From a capture or a table of weights to a file of the format that its name asks for.

use std::path::{Path, PathBuf};

use crate::formats::{Write, formats};
use crate::{Capture, WeightsTable, WriteError};

/// The bytes of a capture in the format that the file's name asks for.
///
/// # Errors
/// [`WriteError`]: no such format is written, or it cannot hold the capture.
pub fn capture_file(capture: &Capture, path: &Path) -> Result<Vec<u8>, WriteError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let writer = formats().iter().find_map(|format| match format.write {
        Some(Write::Capture(write)) if format.has_extension_of(path) => Some(write),
        _ => None,
    });
    let write = writer.ok_or_else(|| unknown(path, |write| matches!(write, Write::Capture(_))))?;
    write(capture, &name)
}

/// The files that a table of weights becomes in the format that the file's name asks for, each with
/// its path: `path` itself is the last.
///
/// # Errors
/// [`WriteError::Extension`]: no such format is written.
pub fn weights_files(
    table: &WeightsTable,
    path: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>, WriteError> {
    let writer = formats().iter().find_map(|format| match format.write {
        Some(Write::Weights(write)) if format.has_extension_of(path) => Some(write),
        _ => None,
    });
    let write = writer.ok_or_else(|| unknown(path, |write| matches!(write, Write::Weights(_))))?;
    Ok(write(table, path))
}

fn unknown(path: &Path, kind: impl Fn(&Write) -> bool) -> WriteError {
    let written = formats().iter().filter(|format| format.write.as_ref().is_some_and(&kind));
    WriteError::Extension {
        found: path.extension().unwrap_or_default().to_string_lossy().into_owned(),
        extensions: written.map(|format| format!(".{}", format.extensions[0])).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LengthUnit, read_bytes, recognise};

    #[test]
    fn the_name_of_the_file_asks_for_the_format() {
        let positions = vec![[1.0, 2.0, 3.0], [1.5, 2.5, 3.5]];
        let capture =
            Capture::new(vec!["chin".to_owned()], 60.0, LengthUnit::Millimetre, positions);
        for (name, id) in [("a.c3d", "c3d"), ("a.TRC", "trc"), ("a.b.csv", "wide-csv")] {
            let bytes = capture_file(&capture, Path::new(name)).unwrap();
            assert_eq!(recognise(&bytes).map(|format| format.id), Some(id));
            assert_eq!(read_bytes(&bytes).unwrap().positions, capture.positions, "{name}");
        }
        for name in ["a.bvh", "a", "a.npz"] {
            let error = capture_file(&capture, Path::new(name)).unwrap_err().to_string();
            assert!(error.ends_with("end it in .c3d or .trc or .csv"), "{error}");
        }
    }
}
