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
    match asked_for(path, |write| matches!(write, Write::Capture(_))) {
        Some(Write::Capture(write)) => write(capture, &name),
        _ => Err(unknown(path, |write| matches!(write, Write::Capture(_)))),
    }
}

/// The files that a table of weights becomes in the format that the file's name asks for, each with
/// its path: `path` itself is the last. Columns that the format has and the table has not are 0; see
/// [`written_columns`].
///
/// # Errors
/// [`WriteError::Extension`]: no such format is written.
pub fn weights_files(
    table: &WeightsTable,
    path: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>, WriteError> {
    match asked_for(path, holds_weights) {
        Some(Write::Weights { columns: None, write }) => Ok(write(table, path)),
        Some(Write::Weights { columns: Some(columns), write }) => {
            Ok(write(&under(table, columns), path))
        }
        _ => Err(unknown(path, holds_weights)),
    }
}

/// The columns of files of weights in the format that the file's name asks for; `None` where it takes any
/// (or is none that is written). A table whose shapes have other names is to be joined to these first.
pub fn written_columns(path: &Path) -> Option<&'static [&'static str]> {
    match asked_for(path, holds_weights)? {
        Write::Weights { columns, .. } => *columns,
        Write::Capture(_) => None,
    }
}

fn holds_weights(write: &Write) -> bool {
    matches!(write, Write::Weights { .. })
}

/// The writer of that kind that the file's name asks for: the one with the longest ending, the first of
/// these in the table.
fn asked_for(path: &Path, kind: impl Fn(&Write) -> bool) -> Option<&'static Write> {
    let writers = formats().iter().rev().filter_map(|format| {
        let write = format.write.as_ref().filter(|write| kind(write))?;
        Some((format.asked_for_by(path)?, write))
    });
    writers.max_by_key(|(length, _)| *length).map(|(_, write)| write)
}

/// A table with those columns, by their names.
fn under(table: &WeightsTable, columns: &[&str]) -> WeightsTable {
    let of = |column: &&str| table.shape_names.iter().position(|name| name == column);
    let from: Vec<Option<usize>> = columns.iter().map(of).collect();
    let weights = (0..table.frames.len()).flat_map(|row| {
        let row = table.row(row);
        from.iter().map(move |k| k.map_or(0.0, |k| row[k]))
    });
    WeightsTable {
        weights: weights.collect(),
        shape_names: columns.iter().map(|name| (*name).to_owned()).collect(),
        ..table.clone()
    }
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
