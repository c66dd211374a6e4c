//! The file beside a repaired capture that says what was changed: `FILE.repair.json`.

use std::path::{Path, PathBuf};

use mimique_mocap::RepairRecord;
use serde::{Deserialize, Serialize};

use crate::provenance::sha256_hex;

/// A file and its content's hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileHash {
    /// Name of the file, without its folder.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

impl FileHash {
    /// Of a file and its bytes.
    pub fn of(path: &Path, bytes: &[u8]) -> Self {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self { file, sha256: sha256_hex(bytes) }
    }
}

/// What was changed in a capture, and in which files it is found before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RepairSidecar {
    /// Program that repaired it.
    pub program: String,
    /// The capture as it was recorded.
    pub source: FileHash,
    /// The capture as it is now.
    pub result: FileHash,
    /// What was done.
    pub repair: RepairRecord,
}

/// A sidecar that does not serve.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SidecarError {
    /// It is there but cannot be read.
    #[error("{file}: {what}; repair the capture again, or remove the file")]
    Unreadable {
        /// The sidecar.
        file: String,
        /// Why.
        what: String,
    },
    /// It is of other bytes.
    #[error(
        "{file}: of a capture with SHA-256 {expected}, this one has {found}; repair the capture again, or remove the file"
    )]
    OtherCapture {
        /// The sidecar.
        file: String,
        /// Hash that it names.
        expected: String,
        /// Hash of the capture.
        found: String,
    },
}

/// Where the sidecar of a capture is.
pub fn sidecar_path(capture: &Path) -> PathBuf {
    let mut name = capture.as_os_str().to_owned();
    name.push(".repair.json");
    PathBuf::from(name)
}

impl RepairSidecar {
    /// The sidecar beside a capture; `None` where there is none.
    ///
    /// # Errors
    /// [`SidecarError`]: not readable, or of other bytes than the capture's.
    pub fn beside(capture: &Path, bytes: &[u8]) -> Result<Option<Self>, SidecarError> {
        let path = sidecar_path(capture);
        let file = path.display().to_string();
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(SidecarError::Unreadable { file, what: e.to_string() }),
        };
        let sidecar: Self = serde_json::from_str(&text)
            .map_err(|e| SidecarError::Unreadable { file: file.clone(), what: e.to_string() })?;
        let found = sha256_hex(bytes);
        if sidecar.result.sha256 != found {
            let expected = sidecar.result.sha256;
            return Err(SidecarError::OtherCapture { file, expected, found });
        }
        Ok(Some(sidecar))
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        // Numbers, texts and lists only: it cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// What the provenance of a stimulus holds of it: everything but the files' names.
    pub fn hash(&self) -> String {
        let value = serde_json::to_value(&self.repair).unwrap_or_default();
        sha256_hex(format!("{} {} {value}", self.source.sha256, self.result.sha256).as_bytes())
    }
}
