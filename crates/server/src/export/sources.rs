//! What an export is made from: the versions of a study, and its sessions.

use std::collections::BTreeMap;

use mimique_session::wire::SessionStarted;
use mimique_storage::{SessionRecord, Storage, StorageError, StudyVersion};
use mimique_study::{ClipSource, Study};
use serde_json::Value;

use super::error::ExportError;

/// The versions of a study in the order of their service. Sessions and their events are read one by one.
pub(crate) struct Sources {
    pub study_id: String,
    pub versions: Vec<Version>,
}

/// A version of the study, read.
pub(crate) struct Version {
    pub config_hash: String,
    pub file: Value,
    pub study: Study,
    pub clips: BTreeMap<String, ClipSource>,
}

impl Version {
    /// Reads a stored version.
    pub fn read(stored: &StudyVersion) -> Result<Self, StorageError> {
        let damaged = |problem: String| StorageError::Damaged { table: "study_versions", problem };
        let file: Value = serde_json::from_str(&stored.file).map_err(|e| damaged(e.to_string()))?;
        let clips = serde_json::from_str(&stored.clips).map_err(|e| damaged(e.to_string()))?;
        let study = Study::from_value(&file).map_err(|error| {
            damaged(format!("study {}, {}: {error}", stored.study_id, stored.config_hash))
        })?;
        Ok(Self { config_hash: stored.config_hash.clone(), file, study, clips })
    }
}

impl Sources {
    /// The versions of a study.
    pub async fn load(storage: &Storage, study_id: &str) -> Result<Self, ExportError> {
        let versions = storage.study_versions().await?;
        let versions = versions
            .iter()
            .filter(|version| version.study_id == study_id)
            .map(Version::read)
            .collect::<Result<_, _>>()?;
        Ok(Self { study_id: study_id.to_owned(), versions })
    }

    /// The version that is served now, or was served last.
    pub fn latest(&self) -> Result<&Version, ExportError> {
        self.versions.last().ok_or_else(|| ExportError::UnknownStudy {
            id: self.study_id.clone(),
            known: "none".into(),
        })
    }

    /// The version of this hash.
    pub fn version(&self, config_hash: &str) -> Result<&Version, ExportError> {
        let found = self.versions.iter().find(|version| version.config_hash == config_hash);
        found.ok_or_else(|| ExportError::missing(&self.study_id, config_hash))
    }
}

/// The session as `study` knows it, without its secrets.
pub(crate) fn as_started(session: &SessionRecord) -> SessionStarted {
    SessionStarted {
        session: String::new(),
        participant_id: mimique_storage::participant_id(session.participant),
        participant: session.participant,
        slot: session.slot,
        condition: session.condition.clone(),
        seed: session.seed,
        stage: session.stage.clone(),
        config_hash: session.config_hash.clone(),
        withdrawal_code: String::new(),
    }
}
