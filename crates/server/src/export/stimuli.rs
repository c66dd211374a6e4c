//! The table of stimuli: a row per clip as it was shown, with its factors and what was measured of it.

use std::collections::BTreeSet;

use mimique_storage::Storage;
use mimique_study::columns::STIMULI_COLUMNS;
use mimique_study::{Study, config_hash};
use serde_json::Value;

use super::choose;
use super::csv::{self, Cells};
use super::error::ExportError;
use super::sources::{Sources, Version};
use crate::hosting::Hosting;

/// The table as CSV, and the study's identifier. A clip that was prepared anew for a later version, and differs, has a row more.
///
/// # Errors
/// There is no such study, or there are several and none is named; storage failed.
pub async fn stimuli(
    storage: &Storage,
    study_id: Option<&str>,
) -> Result<(String, Vec<u8>), ExportError> {
    let study_id = choose(storage, study_id).await?;
    let table = table(&Sources::load(storage, &study_id).await?)?;
    Ok((study_id, table))
}

/// The table of a study that lies in no database: its file, its clips as prepared, what was measured of them.
///
/// # Errors
/// The file is no study.
pub fn stimuli_of(file: Value, hosting: &Hosting) -> Result<Vec<u8>, ExportError> {
    let study = Study::from_value(&file).map_err(|error| ExportError::Form(error.to_string()))?;
    let study_id = study.id.clone();
    let (clips, measures) = (hosting.clips.clone(), hosting.measures.clone());
    let version = Version { config_hash: config_hash(&file), file, study, clips, measures };
    table(&Sources { study_id, versions: vec![version] })
}

/// The table of the versions of a study.
pub(super) fn table(sources: &Sources) -> Result<Vec<u8>, ExportError> {
    let mut names: Vec<String> = STIMULI_COLUMNS.map(str::to_owned).to_vec();
    let mut rows: Vec<Vec<(String, Value)>> = Vec::new();
    let mut told = BTreeSet::new();
    for version in &sources.versions {
        for clip in version.study.clips() {
            let source = version.clips.get(&clip.id);
            let provenance = source.map(|source| source.provenance.clone());
            if !told.insert((clip.id.clone(), provenance.clone())) {
                continue;
            }
            let text = |value: &str| Value::from(value);
            let drawn = source.filter(|source| source.video.is_none());
            let mut row: Vec<(String, Value)> = [
                text(&clip.id),
                text(&clip.segment),
                text(&clip.avatar),
                text(&clip.method),
                drawn.map(|source| source.duration_ms).into(),
                provenance.into(),
                drawn.map(|source| source.weights_hash.clone()).into(),
            ]
            .into_iter()
            .zip(STIMULI_COLUMNS)
            .map(|(value, name)| (name.to_owned(), value))
            .collect();
            let own = |(name, _): &(&String, _)| !STIMULI_COLUMNS.contains(&name.as_str());
            let factors = clip.factors.iter().filter(own);
            row.extend(factors.map(|(name, value)| (name.clone(), value.to_value())));
            let measured = version.measures.iter().find(|measures| measures.clip == clip.id);
            let values = measured.into_iter().flat_map(|measures| &measures.values);
            row.extend(values.map(|(name, value)| (name.clone(), (*value).into())));
            for (name, _) in &row {
                if !names.contains(name) {
                    names.push(name.clone());
                }
            }
            rows.push(row);
        }
    }
    let cell = |row: &[(String, Value)], name: &String| {
        row.iter().find(|(own, _)| own == name).map_or(Value::Null, |(_, value)| value.clone())
    };
    let cells: Vec<Vec<Value>> =
        rows.iter().map(|row| names.iter().map(|name| cell(row, name)).collect()).collect();
    let mut bytes = csv::header_of(names.iter().map(String::as_str))?;
    bytes.extend(csv::lines(&cells, Cells::AsTheyAre)?);
    Ok(bytes)
}
