//! Export: what was answered, as files. Made from the database alone, the same bytes each time.
//!
//! | format | what |
//! |---|---|
//! | `csv` | tidy: one row a participant x trial x response, every factor a column |
//! | `wide` | one row a participant |
//! | `json` | the tidy rows as JSON lines |
//! | `events` | every stored event as JSON lines: what the other forms are made of, frame times too |
//! | `psych-ds` | a Psych-DS data set: the tidy table, its data dictionary, the study file |
//!
//! A study that was changed while it ran has several versions; each session is read by its own, and
//! the table has the columns of all.

mod lines;
mod psych_ds;
mod table;
mod unstored;

use std::io;
use std::path::{Path, PathBuf};

pub use table::Cells;
pub(crate) use table::{Sources, Version, as_started};
pub use unstored::{Unstored, Written};

use crate::atomic_file;
use crate::storage::{Storage, StorageError};

/// Form of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Tidy CSV.
    Csv,
    /// Wide CSV.
    Wide,
    /// Tidy rows as JSON lines.
    Json,
    /// Stored events as JSON lines.
    Events,
    /// A Psych-DS data set.
    PsychDs,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::Csv, Self::Wide, Self::Json, Self::Events, Self::PsychDs];

    /// Its name on the command line and in addresses.
    pub fn word(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Wide => "wide",
            Self::Json => "json",
            Self::Events => "events",
            Self::PsychDs => "psych-ds",
        }
    }

    /// The format of this name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.word() == word)
    }
}

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

/// Export failed.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Storage failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
    /// The database holds no study, or none of this name.
    #[error("study {id}: not in this database, which holds {known}; choose one of these")]
    UnknownStudy {
        /// The identifier asked for.
        id: String,
        /// Those it holds.
        known: String,
    },
    /// The database holds several studies and none was chosen.
    #[error("the database holds {known}; choose one by --study")]
    SeveralStudies {
        /// Those it holds.
        known: String,
    },
    /// A session's version of the study is not stored.
    #[error("study {id}: version {config_hash} is not in the database; restore it from a backup")]
    MissingVersion {
        /// The study.
        id: String,
        /// The version.
        config_hash: String,
    },
    /// A file cannot be written.
    #[error("{path}: {error}; choose another place by --out")]
    File {
        /// The file.
        path: String,
        /// What went wrong.
        error: io::Error,
    },
    /// A file cannot be put together.
    #[error("the export cannot be put together: {0}; this is a mistake of Mimique's")]
    Form(String),
}

/// What may be asked of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Recruitment identifiers too; they are left out unless asked for.
    pub with_identifiers: bool,
    /// How cells of CSV files are written.
    pub cells: Cells,
}

/// Exports a study; the only one of the database if `study_id` is not given.
pub async fn export(
    storage: &Storage,
    study_id: Option<&str>,
    format: Format,
    options: Options,
) -> Result<Exported, ExportError> {
    let study_id = choose(storage, study_id).await?;
    let sources = Sources::load(storage, &study_id, options.with_identifiers).await?;
    let stem = format!("{study_id}_responses");
    let (files, participants, rows) = match format {
        Format::Csv => {
            let tidy = sources.tidy(storage).await?;
            let counts = (tidy.participants, tidy.rows.len());
            (vec![(format!("{stem}.csv"), table::csv(&tidy, options.cells)?)], counts.0, counts.1)
        }
        Format::Wide => {
            let wide = sources.wide(storage).await?;
            let counts = (wide.participants, wide.rows.len());
            (
                vec![(format!("{study_id}_wide.csv"), table::csv(&wide, options.cells)?)],
                counts.0,
                counts.1,
            )
        }
        Format::Json => {
            let tidy = sources.tidy(storage).await?;
            let counts = (tidy.participants, tidy.rows.len());
            (vec![(format!("{stem}.jsonl"), lines::rows(&tidy)?)], counts.0, counts.1)
        }
        Format::Events => {
            let (bytes, participants, rows) = lines::events(storage, &sources).await?;
            (vec![(format!("{study_id}_events.jsonl"), bytes)], participants, rows)
        }
        Format::PsychDs => {
            let tidy = sources.tidy(storage).await?;
            let counts = (tidy.participants, tidy.rows.len());
            (
                psych_ds::files(
                    &sources,
                    &tidy.columns,
                    table::csv(&tidy, options.cells)?,
                    counts,
                )?,
                counts.0,
                counts.1,
            )
        }
    };
    Ok(Exported { study_id, files, participants, rows })
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
            atomic_file::write(&path, &bytes).map_err(|error| at(&path, error))?;
            written.push(path);
        }
        Ok(written)
    }
}

/// The data dictionary as CSV: every column of the tidy form with its kind, unit, levels, description.
pub(crate) async fn dictionary(storage: &Storage, study_id: &str) -> Result<Vec<u8>, ExportError> {
    let study_id = choose(storage, Some(study_id)).await?;
    let sources = Sources::load(storage, &study_id, false).await?;
    table::dictionary(&sources.columns())
}

/// The study file as it is served now.
pub(crate) async fn study_file(storage: &Storage, study_id: &str) -> Result<Vec<u8>, ExportError> {
    let study_id = choose(storage, Some(study_id)).await?;
    let sources = Sources::load(storage, &study_id, false).await?;
    serde_json::to_vec_pretty(&sources.latest()?.file)
        .map_err(|error| ExportError::Form(error.to_string()))
}

/// Files in one ZIP archive below one folder.
pub(crate) fn zip(folder: &str, files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ExportError> {
    psych_ds::zip(folder, files)
}

async fn choose(storage: &Storage, wanted: Option<&str>) -> Result<String, ExportError> {
    let mut ids: Vec<String> =
        storage.study_versions().await?.into_iter().map(|version| version.study_id).collect();
    ids.dedup();
    let known = if ids.is_empty() { "none".to_owned() } else { ids.join(", ") };
    match wanted {
        Some(id) if ids.iter().any(|known| known == id) => Ok(id.to_owned()),
        Some(id) => Err(ExportError::UnknownStudy { id: id.to_owned(), known }),
        None if ids.len() > 1 => Err(ExportError::SeveralStudies { known }),
        None => {
            ids.pop().ok_or_else(|| ExportError::UnknownStudy { id: "(any)".to_owned(), known })
        }
    }
}
