//! A Psych-DS 1 data set: `data/…_data.csv`, `dataset_description.json`, and what was shown.

use std::io::{Cursor, Write};

use mimique_session::rows::{self, Column, Table};
use mimique_study::Multilingual as _;
use zip::CompressionMethod;
use zip::write::SimpleFileOptions;

use super::error::ExportError;
use super::sources::Sources;

/// The files by their paths in the data set, in alphabetical order. `csv` is the tidy table with these
/// columns, of so many participants and rows.
pub(super) fn files(
    sources: &Sources,
    columns: &[Column],
    csv: Vec<u8>,
    counts: (usize, usize),
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let form = |error: serde_json::Error| ExportError::Form(error.to_string());
    let latest = sources.latest()?;
    // The data dictionary needs the columns alone.
    let columns = Table { columns: columns.to_vec(), rows: Vec::new() };
    let description = rows::psych_ds_description(&latest.study, &columns);
    // Values of Psych-DS keywords are letters and digits.
    let name: String = sources.study_id.chars().filter(char::is_ascii_alphanumeric).collect();
    let mut files = vec![
        ("README.md".to_owned(), readme(sources, counts)?.into_bytes()),
        (format!("data/study-{name}_data.csv"), csv),
        (
            "dataset_description.json".to_owned(),
            serde_json::to_vec_pretty(&description).map_err(form)?,
        ),
    ];
    for version in &sources.versions {
        let short = &version.config_hash[..version.config_hash.len().min(12)];
        let text = serde_json::to_vec_pretty(&version.file).map_err(form)?;
        files.push((format!("materials/study-{name}_version-{short}.json"), text));
    }
    Ok(files)
}

fn readme(sources: &Sources, (participants, rows): (usize, usize)) -> Result<String, ExportError> {
    let study = &sources.latest()?.study;
    let title = study.study_metadata.title.in_language(study.default_language());
    let description = study.study_metadata.description.in_language(study.default_language());
    Ok(format!(
        "# {title}\n\n{description}\n\n\
         {participants} participants, {rows} responses; one row a participant x trial x response.\n\
         The columns are described in `dataset_description.json`; `materials/` holds the study\n\
         file, one for each version that was served (column `config_hash`).\n",
    ))
}

/// The files in a ZIP archive, below one folder; the same bytes for the same files.
pub(super) fn zip(folder: &str, files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ExportError> {
    let form = |error: zip::result::ZipError| ExportError::Form(error.to_string());
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer.start_file(format!("{folder}/{name}"), options).map_err(form)?;
        writer.write_all(bytes).map_err(|error| ExportError::Form(error.to_string()))?;
    }
    Ok(writer.finish().map_err(form)?.into_inner())
}
