//! What was deleted, kept beside a folder's backups so that none of them brings it back.

use std::path::Path;

use super::error::{BackupError, at};
use crate::durable_file;
use crate::records::Deletion;

/// The deletions beside a folder's backups: a JSON line each.
pub fn read_deletions(path: &Path) -> Result<Vec<Deletion>, BackupError> {
    let text = std::fs::read_to_string(path).map_err(|error| at(path, error))?;
    text.lines()
        .enumerate()
        .map(|(index, line)| {
            serde_json::from_str(line).map_err(|error| BackupError::Damaged {
                path: path.display().to_string(),
                line: index as u64 + 1,
                problem: error.to_string(),
            })
        })
        .collect()
}

/// Writes the deletions as [`read_deletions`] reads them.
pub fn write_deletions(path: &Path, deletions: &[Deletion]) -> Result<(), BackupError> {
    let mut text = String::new();
    for deletion in deletions {
        text.push_str(&serde_json::to_string(deletion).unwrap_or_default());
        text.push('\n');
    }
    durable_file::write(path, text.as_bytes()).map_err(|error| at(path, error))
}
