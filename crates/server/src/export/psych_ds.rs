//! A Psych-DS 1 data set: `data/…_data.csv`, `dataset_description.json`, and what was shown.

use mimique_session::rows::{self, Column, Table};
use mimique_study::Multilingual as _;

use super::error::ExportError;
use super::sources::Sources;
use super::stimuli;

/// The files beside the table, by their paths in the data set. The table has these columns, and rows of so many
/// participants, so many in all.
pub(super) fn explaining(
    sources: &Sources,
    columns: &[Column],
    counts: (usize, usize),
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let form = |error: serde_json::Error| ExportError::Form(error.to_string());
    let latest = sources.latest()?;
    // The data dictionary needs the columns alone.
    let columns = Table { columns: columns.to_vec(), rows: Vec::new() };
    let description = rows::psych_ds_description(&latest.study, &columns);
    let description = serde_json::to_vec_pretty(&description).map_err(form)?;
    let mut files = vec![
        ("README.md".to_owned(), readme(sources, counts)?.into_bytes()),
        ("dataset_description.json".to_owned(), description),
    ];
    let name = rows::psych_ds_keyword(&sources.study_id);
    files.push((format!("materials/study-{name}_stimuli.csv"), stimuli::table(sources)?));
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
         file, one for each version that was served (column `config_hash`), and the table of stimuli:\n\
         a row per clip, its factors, and what was measured of it.\n",
    ))
}
