//! A clip as it was prepared: what made it, and where its parts are.

use mimique_solver::MethodSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::drawn_face::UnitShapes;
use crate::study_file::Caption;

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
    /// What is heard with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<ClipSound>,
    /// Of an avatar at rest, which trials of reverse correlation move: how it shows their units. It has neither
    /// operators nor take, and no weights of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<UnitShapes>,
}

/// What is heard with a clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClipSound {
    /// Hash of the file.
    pub file: String,
    /// Its media type, by its content: `audio/wav`, `audio/mpeg`, `audio/ogg`.
    pub media_type: String,
    /// How long the file is, seconds.
    pub duration_s: f64,
    /// Where in the file the first frame of the segment is whose sound it is, seconds.
    pub from_s: f64,
    /// How much of it belongs to that segment, seconds, where the file goes on with others; else all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_s: Option<f64>,
    /// How much later than the face it is heard, milliseconds.
    pub delay_ms: f64,
    /// What is said and heard.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub captions: Vec<Caption>,
}

impl ClipSound {
    /// How much is heard from the first frame on, seconds.
    pub fn audible_s(&self) -> f64 {
        let rest = self.duration_s - self.from_s;
        self.length_s.map_or(rest, |length| rest.min(length)) + self.delay_ms / 1e3
    }
}

fn stimulus() -> String {
    "stimulus".to_owned()
}

impl ClipSource {
    /// The packs that a page fetches, each once.
    pub fn packs(&self) -> impl Iterator<Item = &str> {
        let sound = self.sound.as_ref().map_or("", |sound| &sound.file);
        let all = [self.avatar.as_str(), self.operators.as_str(), self.take.as_str(), sound];
        let new = move |at: usize| !all[at].is_empty() && !all[..at].contains(&all[at]);
        (0..all.len()).filter(move |&at| new(at)).map(move |at| all[at])
    }
}
