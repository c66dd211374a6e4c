//! Export: what was answered, as files. Made from the database alone, the same bytes each time, and sent or
//! written while it is made: whatever the size of the study, little of it is in memory.
//!
//! | format | what |
//! |---|---|
//! | `csv` | tidy: one row a participant x trial x response, every factor a column |
//! | `wide` | one row a participant |
//! | `json` | the tidy rows as JSON lines |
//! | `events` | every stored event as JSON lines: what the other forms are made of, frame times too |
//! | `tracks` | participants' faces as they were measured: a row per picture |
//! | `psych-ds` | a Psych-DS data set: the tidy table, its data dictionary, the study file |
//!
//! A study that was changed while it ran has several versions; each session is read by its own, and
//! the table has the columns of all.

mod body;
mod csv;
pub(crate) mod error;
pub(crate) mod exported;
pub(crate) mod format;
mod layout;
mod lines;
mod parts;
mod pieces;
mod psych_ds;
pub(crate) mod sources;
mod stimuli;
mod tracks;
mod unstored;
mod zipped;

pub use csv::Cells;
pub use error::ExportError;
pub use exported::{Exported, WrittenFiles};
pub use format::Format;
use mimique_storage::Storage;
pub use parts::{Export, Part};
pub(crate) use pieces::exclusions;
use sources::Sources;
pub use stimuli::{stimuli, stimuli_of};
pub use tracks::courses;
pub use unstored::{Unstored, Written};
pub(crate) use zipped::zip;

use layout::{Form, Layout};

/// What may be asked of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Recruitment identifiers too; they are left out unless asked for.
    pub with_identifiers: bool,
    /// How cells of CSV files are written.
    pub cells: Cells,
}

/// Exports a study into memory; the only one of the database if `study_id` is not given.
///
/// # Errors
/// Those of [`Export::open`] and [`Export::next`].
pub async fn export(
    storage: &Storage,
    study_id: Option<&str>,
    format: Format,
    options: Options,
) -> Result<Exported, ExportError> {
    Export::open(storage, study_id, format, options).await?.collect().await
}

/// The data dictionary as CSV: every column of the tidy form with its kind, unit, levels, description.
pub(crate) async fn dictionary(storage: &Storage, study_id: &str) -> Result<Vec<u8>, ExportError> {
    let study_id = choose(storage, Some(study_id)).await?;
    let sources = Sources::load(storage, &study_id).await?;
    let layout = Layout::tidy(Form::JsonLines, &sources, &[]);
    csv::dictionary(layout.columns())
}

/// The study file as it is served now.
pub(crate) async fn study_file(storage: &Storage, study_id: &str) -> Result<Vec<u8>, ExportError> {
    let study_id = choose(storage, Some(study_id)).await?;
    let sources = Sources::load(storage, &study_id).await?;
    serde_json::to_vec_pretty(&sources.latest()?.file)
        .map_err(|error| ExportError::Form(error.to_string()))
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
