//! A study on disk: a study file, or a ZIP archive of its folder, which is unpacked.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use mimique_server::unpack_study;
use mimique_storage::durable_file;
use mimique_study::{Severity, Study};
use serde_json::Value;
use sha2::{Digest as _, Sha256};
use tempfile::TempDir;

use crate::check::check_file;

/// Where a study file lies; what was unpacked for it goes away with this.
pub struct StudyFile {
    path: PathBuf,
    given: PathBuf,
    unpacked: Option<TempDir>,
}

impl StudyFile {
    /// The study of a file or of an archive.
    pub fn open(given: &Path) -> anyhow::Result<Self> {
        if !is_archive(given)? {
            let (path, given) = (given.to_owned(), given.to_owned());
            return Ok(Self { path, given, unpacked: None });
        }
        let folder = tempfile::tempdir().context("a folder for the archive")?;
        let path = unpack(given, folder.path())?;
        Ok(Self { path, given: given.to_owned(), unpacked: Some(folder) })
    }

    /// The study file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A message in which a place inside the archive is named as such: the folder that goes away is no place that
    /// anybody knows.
    pub fn said(&self, message: &str) -> String {
        match &self.unpacked {
            None => message.to_owned(),
            Some(folder) => message
                .replace(&folder.path().display().to_string(), &self.given.display().to_string()),
        }
    }
}

/// The study file of a study that is hosted: as it is given, or of an archive unpacked in the data folder, where it
/// stays under the archive's hash.
pub fn in_data_folder(given: &Path, data_folder: &Path) -> anyhow::Result<PathBuf> {
    if !is_archive(given)? {
        return Ok(given.to_owned());
    }
    let hash = Sha256::digest(std::fs::read(given).with_context(|| given.display().to_string())?);
    let archives = data_folder.join("archives");
    durable_file::private_folder(&archives).with_context(|| archives.display().to_string())?;
    let place = archives.join(hex::encode(hash));
    let fresh =
        durable_file::folder_beside(&place).with_context(|| archives.display().to_string())?;
    let path = unpack(given, fresh.path())?;
    let inside = path.strip_prefix(fresh.path()).unwrap_or(&path).to_owned();
    if !place.exists() {
        std::fs::rename(fresh.path(), &place).with_context(|| place.display().to_string())?;
    }
    Ok(place.join(inside))
}

fn is_archive(given: &Path) -> anyhow::Result<bool> {
    mimique_server::is_archive(given)
        .map_err(|error| anyhow!("cannot be read ({error}); check the path"))
        .with_context(|| given.display().to_string())
}

fn unpack(archive: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    unpack_study(archive, folder).map_err(|error| anyhow!("{}: {error}", archive.display()))
}

/// Reads a study and refuses one with errors, naming the first. Missing stimuli do no harm here.
pub fn load(given: &Path) -> anyhow::Result<(Value, Study)> {
    let file = given.display();
    let opened = StudyFile::open(given)?;
    let report = check_file(opened.path())?;
    let blocking = report
        .issues
        .iter()
        .find(|issue| issue.severity == Severity::Error && issue.code() != "missing-file");
    if let Some(issue) = blocking {
        anyhow::bail!(
            "{file}: {}: {}; {} (`mimique check` lists every problem)",
            issue.place(),
            opened.said(&issue.message()),
            issue.remedy()
        );
    }
    let text = std::fs::read_to_string(opened.path()).with_context(|| format!("{file}"))?;
    let value = mimique_study::parse(&text).with_context(|| format!("{file}"))?;
    let study = Study::from_value(&value).with_context(|| format!("{file}"))?;
    Ok((value, study))
}
