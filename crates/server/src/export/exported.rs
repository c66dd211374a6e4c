//! An export in memory, and how it is written to disk.

use std::path::{Path, PathBuf};

use mimique_storage::durable_file;

use super::error::ExportError;
use super::psych_ds;

/// An export in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The study.
    pub study_id: String,
    /// The files by their paths: one, or those of a Psych-DS folder.
    pub files: Vec<(String, Vec<u8>)>,
    /// How many participants it has rows of.
    pub participants: usize,
    /// How many rows (or events) it has.
    pub rows: usize,
}

impl Exported {
    /// All files in one ZIP archive, in a folder named by the study.
    pub fn into_zip(self) -> Result<Vec<u8>, ExportError> {
        let folder = format!("{}_psych-ds", self.study_id);
        psych_ds::zip(&folder, &self.files)
    }

    /// Writes the export: one file to `out`; several to a folder `out`, or into it as a ZIP archive
    /// where its name ends in `.zip`. A file is whole or absent. Returns what was written.
    pub fn write(self, out: &Path) -> Result<Vec<PathBuf>, ExportError> {
        let at = |path: &Path, error| ExportError::File { path: path.display().to_string(), error };
        let is_zip = out.extension().is_some_and(|end| end.eq_ignore_ascii_case("zip"));
        let files = if self.files.len() == 1 {
            let mut files = self.files;
            files.pop().map(|(_, bytes)| (out.to_owned(), bytes)).into_iter().collect()
        } else if is_zip {
            vec![(out.to_owned(), self.into_zip()?)]
        } else {
            let files = self.files.into_iter();
            files.map(|(name, bytes)| (out.join(name), bytes)).collect::<Vec<_>>()
        };
        let mut written = Vec::with_capacity(files.len());
        for (path, bytes) in files {
            if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                std::fs::create_dir_all(folder).map_err(|error| at(folder, error))?;
            }
            durable_file::write(&path, &bytes).map_err(|error| at(&path, error))?;
            written.push(path);
        }
        Ok(written)
    }
}
