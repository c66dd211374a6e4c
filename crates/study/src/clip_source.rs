//! A clip as it was prepared: what made it, and where its parts are.

use mimique_solver::MethodSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Where a clip's parts are, and how it is solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClipSource {
    /// Hash of the avatar pack (what the stage draws); of a video, the video itself.
    pub avatar: String,
    /// Hash of the operators pack (what the solver needs of avatar and marker map).
    pub operators: String,
    /// Hash of the take pack (the markers of this clip, or recorded weights).
    pub take: String,
    /// The method and its parameters.
    #[schemars(with = "Value")]
    pub method: MethodSpec,
    /// Duration as played, milliseconds.
    pub duration_ms: f64,
    /// Bytes to load if nothing is cached.
    pub bytes: u64,
    /// Provenance: SHA-256 over avatar, capture, map, method, parameters and solver version.
    pub provenance: String,
    /// SHA-256 of the weights as the server solved them (f64, little-endian, frame-major); empty for
    /// a video.
    pub weights_hash: String,
    /// How the stage draws it: `stimulus` or `reference`.
    #[serde(default = "stimulus")]
    pub look: String,
    /// Media type of a video (`video/mp4`, `video/webm`); none for a clip that is drawn. A video has
    /// neither operators nor take, and its duration is known to the browser alone (0 here).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub video: Option<String>,
}

fn stimulus() -> String {
    "stimulus".to_owned()
}

impl ClipSource {
    /// The packs that a page fetches, each once.
    pub fn packs(&self) -> impl Iterator<Item = &str> {
        let all = [self.avatar.as_str(), self.operators.as_str(), self.take.as_str()];
        let new = move |at: usize| !all[at].is_empty() && !all[..at].contains(&all[at]);
        (0..all.len()).filter(move |&at| new(at)).map(move |at| all[at])
    }
}
