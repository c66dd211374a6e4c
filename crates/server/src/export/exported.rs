//! An export on its way to the disk, or in memory.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use mimique_storage::durable_file::Draft;

use super::error::ExportError;
use super::parts::{Export, Part};
use super::zipped::Zipped;

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

/// An export on disk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFiles {
    /// The files.
    pub paths: Vec<PathBuf>,
    /// How many participants it has rows of.
    pub participants: usize,
    /// How many rows (or events) it has.
    pub rows: usize,
}

impl Exported {
    /// Writes the export: one file to `out`; several to a folder `out`, or into it as a ZIP archive
    /// where its name ends in `.zip`. A file is whole or absent. Returns what was written.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(self, out: &Path) -> Result<Vec<PathBuf>, ExportError> {
        let mut place = Destination::new(out, &self.study_id, self.files.len() > 1);
        for (path, bytes) in self.files {
            place.take(Part::File(path))?;
            place.take(Part::Bytes(bytes))?;
        }
        place.finish()
    }
}

impl Export {
    /// Writes the export as [`Exported::write`] does, while it is made.
    ///
    /// # Errors
    /// Those of [`Self::next`]; a file cannot be written.
    pub async fn write(mut self, out: &Path) -> Result<WrittenFiles, ExportError> {
        let mut place = Destination::new(out, self.study_id(), self.format().is_folder());
        while let Some(part) = self.next().await? {
            place.take(part)?;
        }
        let (participants, rows) = (self.participants(), self.rows());
        Ok(WrittenFiles { paths: place.finish()?, participants, rows })
    }
}

/// Where an export is written to.
struct Destination<'o> {
    out: &'o Path,
    kind: Kind,
    paths: Vec<PathBuf>,
}

enum Kind {
    File(Option<Draft>),
    Folder(Option<Draft>),
    Archive(Box<Zipped>, Option<Draft>),
}

impl<'o> Destination<'o> {
    fn new(out: &'o Path, study_id: &str, is_folder: bool) -> Self {
        let is_zip = out.extension().is_some_and(|end| end.eq_ignore_ascii_case("zip"));
        let kind = match (is_folder, is_zip) {
            (false, _) => Kind::File(None),
            (true, false) => Kind::Folder(None),
            (true, true) => {
                Kind::Archive(Box::new(Zipped::below(&psych_ds_folder(study_id))), None)
            }
        };
        Self { out, kind, paths: Vec::new() }
    }

    fn take(&mut self, part: Part) -> Result<(), ExportError> {
        match (&mut self.kind, part) {
            (Kind::File(draft), Part::File(_)) => *draft = Some(begin(self.out)?),
            (Kind::Folder(draft), Part::File(path)) => {
                if let Some(done) = draft.take() {
                    self.paths.push(finish(done)?);
                }
                *draft = Some(begin(&self.out.join(path))?);
            }
            (Kind::File(draft) | Kind::Folder(draft), Part::Bytes(bytes)) => {
                if let Some(draft) = draft {
                    write(draft, &bytes)?;
                }
            }
            (Kind::Archive(zipped, draft), part) => {
                zipped.take(part)?;
                let bytes = zipped.made();
                if draft.is_none() {
                    *draft = Some(begin(self.out)?);
                }
                if let Some(draft) = draft {
                    write(draft, &bytes)?;
                }
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Vec<PathBuf>, ExportError> {
        let draft = match self.kind {
            Kind::File(draft) | Kind::Folder(draft) => draft,
            Kind::Archive(zipped, draft) => {
                let mut draft = draft;
                if let Some(draft) = &mut draft {
                    write(draft, &zipped.finish()?)?;
                }
                draft
            }
        };
        if let Some(done) = draft {
            self.paths.push(finish(done)?);
        }
        Ok(self.paths)
    }
}

/// The folder in an archive of a data set.
pub(super) fn psych_ds_folder(study_id: &str) -> String {
    format!("{study_id}_psych-ds")
}

fn begin(path: &Path) -> Result<Draft, ExportError> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|error| at(folder, error))?;
    }
    Draft::begin(path).map_err(|error| at(path, error))
}

fn write(draft: &mut Draft, bytes: &[u8]) -> Result<(), ExportError> {
    draft.write_all(bytes).map_err(|error| at(draft.path(), error))
}

fn finish(draft: Draft) -> Result<PathBuf, ExportError> {
    let path = draft.path().to_owned();
    draft.finish().map_err(|error| at(&path, error))?;
    Ok(path)
}

fn at(path: &Path, error: std::io::Error) -> ExportError {
    ExportError::File { path: path.display().to_string(), error }
}
