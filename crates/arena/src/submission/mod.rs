//! What somebody submits: a method's weights or vertices for every segment, who made it, under which licence.

mod details;
mod given;
mod problem;
mod vertices;
mod weights;

use std::collections::BTreeMap;

use mimique_study::canonical;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

pub use details::{SubmissionDetails, check_details};
pub use given::Given;
pub use problem::SubmissionProblem;
pub use vertices::{TOLERANCE_MM, VertexSubmission, check_vertices};
pub use weights::{GivenWeights, WeightSubmission, check_weights};

/// A submission as its `submission.json` has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Submission {
    /// What and whose it is.
    #[serde(flatten)]
    pub details: SubmissionDetails,
    /// Weights of the arena's head, or vertices.
    pub kind: SubmittedKind,
    /// A file of weights for each segment.
    pub segments: BTreeMap<String, SubmittedFile>,
    /// Of vertices: the head that its weights move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avatar: Option<SubmittedAvatar>,
    /// SHA-256 over kind and hashes of all files: what the method shows, whoever made it.
    pub hash: String,
}

/// What was submitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SubmittedKind {
    /// Weights of the arena's head.
    Weights,
    /// Places of the head's vertices.
    Vertices,
}

/// A file of a submission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SubmittedFile {
    /// Its name in the submission's folder.
    pub file: String,
    /// Number of frames.
    pub frames: usize,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

/// The head of a submission of vertices: the arena's, moved by the principal shapes of the sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SubmittedAvatar {
    /// Its name in the submission's folder.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// Number of shapes.
    pub shapes: usize,
    /// How far a vertex is at most from where it was submitted, millimetres.
    pub largest_error_mm: f64,
    /// The root mean square of that distance, millimetres.
    pub rms_error_mm: f64,
}

/// What a submission is made of: the weights of each segment in a table, and of vertices the head that they move.
pub enum Checked {
    /// Weights.
    Weights(WeightSubmission),
    /// Vertices.
    Vertices(VertexSubmission),
}

impl From<WeightSubmission> for Checked {
    fn from(own: WeightSubmission) -> Self {
        Self::Weights(own)
    }
}

impl From<VertexSubmission> for Checked {
    fn from(own: VertexSubmission) -> Self {
        Self::Vertices(own)
    }
}

/// The submission and the files of its folder, names and bytes; `submission.json` is the last.
pub fn submission_files(
    details: SubmissionDetails,
    checked: impl Into<Checked>,
) -> (Submission, Vec<(String, Vec<u8>)>) {
    let (kind, tables, avatar) = match checked.into() {
        Checked::Weights(own) => (SubmittedKind::Weights, own.segments, None),
        Checked::Vertices(own) => {
            let avatar = SubmittedAvatar {
                file: "head.glb".to_owned(),
                sha256: sha256(&own.glb),
                shapes: own.shapes,
                largest_error_mm: own.largest_error_mm,
                rms_error_mm: own.rms_error_mm,
            };
            (SubmittedKind::Vertices, own.segments, Some((avatar, own.glb)))
        }
    };
    let mut files = Vec::new();
    let mut segments = BTreeMap::new();
    for (segment, table) in tables {
        let (file, bytes) = (format!("{segment}.csv"), table.to_csv().into_bytes());
        let (frames, sha256) = (table.frames.len(), sha256(&bytes));
        segments.insert(segment, SubmittedFile { file: file.clone(), frames, sha256 });
        files.push((file, bytes));
    }
    let avatar = avatar.map(|(avatar, glb)| {
        files.push((avatar.file.clone(), glb));
        avatar
    });
    let hash = content_hash(kind, &segments, avatar.as_ref());
    let submission = Submission { details, kind, segments, avatar, hash };
    let mut text = serde_json::to_string_pretty(&submission).unwrap_or_default();
    text.push('\n');
    files.push(("submission.json".to_owned(), text.into_bytes()));
    (submission, files)
}

/// What the hash of a submission is of: its kind and the hashes of its files by segment.
pub(crate) fn content_hash(
    kind: SubmittedKind,
    segments: &BTreeMap<String, SubmittedFile>,
    avatar: Option<&SubmittedAvatar>,
) -> String {
    let files: BTreeMap<&String, &String> =
        segments.iter().map(|(segment, file)| (segment, &file.sha256)).collect();
    let content = serde_json::json!({
        "kind": kind,
        "segments": files,
        "avatar": avatar.map(|avatar| &avatar.sha256),
    });
    sha256(canonical(&content).as_bytes())
}

/// SHA-256 in hexadecimal.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}
