//! How far preparing an uploaded study is. It is kept in the database: whichever server is asked says it.

use mimique_storage::{Storage, StorageError};
use mimique_study::{Issue, Severity};
use serde::{Deserialize, Serialize};

use crate::clock::now_ms;

/// Where preparing a study stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub(crate) enum Preparing {
    /// So many clips of so many are ready.
    Under { done: usize, of: usize },
    /// It is hosted; what should be said of its stimuli.
    Ready { warnings: Vec<String> },
    /// Its stimuli cannot be prepared.
    Failed { problem: String },
}

/// What the check found, in words: they outlive the process that knows the values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Noted {
    pub is_error: bool,
    pub place: String,
    pub message: String,
    pub remedy: String,
}

impl From<&Issue> for Noted {
    fn from(issue: &Issue) -> Self {
        Self {
            is_error: issue.severity == Severity::Error,
            place: issue.place().to_owned(),
            message: issue.message(),
            remedy: issue.remedy(),
        }
    }
}

/// A study that was uploaded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Preparation {
    #[serde(flatten)]
    pub state: Preparing,
    /// What the check found: warnings.
    pub issues: Vec<Noted>,
}

impl Preparation {
    /// What is known of a study's preparation.
    pub async fn of(storage: &Storage, study_id: &str) -> Result<Option<Self>, StorageError> {
        let Some(notes) = storage.preparation(study_id).await? else { return Ok(None) };
        let damaged = |error: serde_json::Error| StorageError::Damaged {
            table: "preparations",
            problem: error.to_string(),
        };
        serde_json::from_str(&notes).map(Some).map_err(damaged)
    }

    /// Begins; false where another one of this study is under way.
    pub async fn begin(&self, storage: &Storage, study_id: &str) -> Result<bool, StorageError> {
        storage.begin_preparation(study_id, &self.notes(), now_ms()).await
    }

    /// Notes how far it is.
    pub async fn note(&self, storage: &Storage, study_id: &str) -> Result<(), StorageError> {
        let is_under_way = matches!(self.state, Preparing::Under { .. });
        storage.note_preparation(study_id, is_under_way, &self.notes(), now_ms()).await
    }

    fn notes(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}
