//! The export that a deposit is made of, and the versions of the study that its answers belong to.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use mimique_deposit::{Responses, StudyVersion, known_columns};
use mimique_session::rows::Column;
use mimique_study::{CheckedStudy, Study, config_hash};

/// An export, read.
pub(super) struct Inputs {
    /// The table of answers.
    pub place: PathBuf,
    pub responses: Responses,
    /// The versions that answers belong to, the study's own being the last.
    pub versions: Vec<StudyVersion>,
    pub studies: Vec<Study>,
    /// The columns that exports of them have.
    pub known: BTreeMap<String, Column>,
}

impl Inputs {
    /// Reads a tidy export, or a Psych-DS folder with its versions of the study.
    pub fn read(export: &Path, checked: &CheckedStudy) -> anyhow::Result<Self> {
        let (place, earlier) = if export.is_dir() {
            (data_file(export)?, versions_in(&export.join("materials"))?)
        } else {
            (export.to_owned(), Vec::new())
        };
        let named = || place.display().to_string();
        let bytes = std::fs::read(&place)
            .map_err(|error| anyhow!("cannot be read ({error}); check the path"))
            .with_context(named)?;
        let responses = Responses::read(&bytes).with_context(named)?;
        let mut versions: Vec<StudyVersion> = Vec::new();
        let mut studies = Vec::new();
        let hashes = responses.values("config_hash");
        for (path, file) in earlier {
            let hash = config_hash(&file);
            if hash != checked.config_hash() && hashes.contains(&&*hash) {
                studies.push(Study::from_value(&file).with_context(|| path.display().to_string())?);
                versions.push(StudyVersion { file });
            }
        }
        versions.push(StudyVersion { file: checked.value().clone() });
        studies.push(checked.study().clone());
        let known: Vec<String> =
            versions.iter().map(|version| config_hash(&version.file)).collect();
        if let Some(hash) = hashes.iter().find(|hash| !known.iter().any(|own| own == **hash)) {
            bail!(
                "{}: config_hash {hash}: these answers belong to another version of the study than {}; give the study file as \
                 it was served, or a Psych-DS export, which has every version",
                named(),
                checked.config_hash()
            );
        }
        let columns = known_columns(&studies.iter().collect::<Vec<_>>());
        Ok(Self { place, responses, versions, studies, known: columns })
    }
}

/// The one table of a Psych-DS folder.
fn data_file(folder: &Path) -> anyhow::Result<PathBuf> {
    let data = folder.join("data");
    let entries = std::fs::read_dir(&data)
        .map_err(|error| anyhow!("cannot be read ({error}); give a folder that `mimique export --format psych-ds` wrote"))
        .with_context(|| data.display().to_string())?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry.with_context(|| data.display().to_string())?.path();
        if path.to_string_lossy().ends_with("_data.csv") {
            found.push(path);
        }
    }
    match found.len() {
        1 => Ok(found.remove(0)),
        count => bail!(
            "{}: {count} files end in _data.csv, and one is wanted; give the table itself",
            data.display()
        ),
    }
}

/// The versions of the study that a Psych-DS folder has, in the order of their names.
fn versions_in(materials: &Path) -> anyhow::Result<Vec<(PathBuf, serde_json::Value)>> {
    let Ok(entries) = std::fs::read_dir(materials) else { return Ok(Vec::new()) };
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.with_context(|| materials.display().to_string())?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.contains("_version-") && name.ends_with(".json") {
            paths.push(path);
        }
    }
    paths.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let value = mimique_study::parse(&text).with_context(|| path.display().to_string())?;
        Ok((path, value))
    };
    paths.into_iter().map(read).collect()
}
