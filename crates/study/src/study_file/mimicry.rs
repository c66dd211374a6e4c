//! The participant's own face, measured in the page while clips play: with a consent of its own, and only where the study
//! asks for it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{LocalText, Study, Translations};
use crate::study_file::Multilingual as _;
use crate::text::mimicry_words;

/// The face of those who agree is measured by their own browser while clips play: numbers are kept, no picture. What
/// measures it (MediaPipe's Face Landmarker) are files that the study brings. `docs/guide/mimicry.md` says where they come
/// from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Mimicry {
    /// What a participant agrees to, on a page of its own. Who does not agree takes part without.
    pub consent: MimicryConsent,
    /// The model: the file `face_landmarker.task`.
    pub model: String,
    /// The folder of the npm package `@mediapipe/tasks-vision`, with `vision_bundle.mjs` and `wasm` in it.
    pub runtime: String,
    /// How many pictures of the camera are measured at most, per second.
    #[serde(default = "thirty")]
    pub rate_hz: f64,
    /// Whether who has agreed goes on with the camera only once the face was seen.
    #[serde(default)]
    pub needs_face: bool,
}

/// What a participant agrees to before the camera is switched on. The page adds what is sent and what is not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MimicryConsent {
    /// Version of the text, kept with the answer.
    pub version: String,
    /// Heading of the page.
    pub heading: LocalText,
    /// Why the face is measured, who sees the numbers, how long they are kept; an empty line begins a paragraph.
    pub text: LocalText,
}

fn thirty() -> f64 {
    30.0
}

/// A file of what measures the face, as the page gets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MimicryFile {
    /// Its name among the clips that the page gets, and in [`MimicryPages::files`].
    pub name: &'static str,
    /// Where it is below the runtime's folder; none of the model.
    pub below: Option<&'static str>,
    /// Its media type.
    pub media_type: &'static str,
    /// What its address ends with where browsers take it by its media type alone.
    pub ending: Option<&'static str>,
}

/// The files that the page loads once somebody has agreed.
pub const MIMICRY_FILES: [MimicryFile; 4] = [
    MimicryFile {
        name: "model",
        below: None,
        media_type: "application/octet-stream",
        ending: None,
    },
    MimicryFile {
        name: "bundle",
        below: Some("vision_bundle.mjs"),
        media_type: "text/javascript",
        ending: Some("js"),
    },
    MimicryFile {
        name: "loader",
        below: Some("wasm/vision_wasm_module_internal.js"),
        media_type: "text/javascript",
        ending: Some("js"),
    },
    MimicryFile {
        name: "module",
        below: Some("wasm/vision_wasm_module_internal.wasm"),
        media_type: "application/wasm",
        ending: Some("wasm"),
    },
];

impl MimicryFile {
    /// What the keys of these files begin with in a study's clips as the page gets them.
    pub const PREFIX: &str = "media:mimicry/";

    /// Its key in a study's clips as the page gets them.
    pub fn key(&self) -> String {
        [Self::PREFIX, self.name].concat()
    }

    /// Where it is, as the study file would name it.
    pub fn path(&self, mimicry: &Mimicry) -> String {
        match self.below {
            None => mimicry.model.clone(),
            Some(below) => format!("{}/{below}", mimicry.runtime.trim_end_matches('/')),
        }
    }
}

/// What is measured of a face, in the order of a track: MediaPipe's 52 scores from 0 to 1. They are those of ARKit's 52
/// blendshapes that have their names, `tongueOut` left out, and the score of a face at rest.
#[rustfmt::skip]
pub const TRACKED_SHAPES: [&str; 52] = [
    "_neutral",
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight",
    "cheekPuff", "cheekSquintLeft", "cheekSquintRight",
    "eyeBlinkLeft", "eyeBlinkRight", "eyeLookDownLeft", "eyeLookDownRight",
    "eyeLookInLeft", "eyeLookInRight", "eyeLookOutLeft", "eyeLookOutRight",
    "eyeLookUpLeft", "eyeLookUpRight", "eyeSquintLeft", "eyeSquintRight",
    "eyeWideLeft", "eyeWideRight",
    "jawForward", "jawLeft", "jawOpen", "jawRight",
    "mouthClose", "mouthDimpleLeft", "mouthDimpleRight", "mouthFrownLeft", "mouthFrownRight",
    "mouthFunnel", "mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthPressLeft", "mouthPressRight", "mouthPucker", "mouthRight",
    "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper",
    "mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight",
    "mouthUpperUpLeft", "mouthUpperUpRight", "noseSneerLeft", "noseSneerRight",
];

/// What the participant's page is sent of it; nothing in a study without.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct MimicryPages {
    /// Version of the consent.
    pub version: String,
    /// Pictures that are measured at most, per second.
    pub rate_hz: f64,
    /// Whether the face must be seen to go on with the camera.
    pub needs_face: bool,
    /// [`TRACKED_SHAPES`].
    pub shapes: Vec<String>,
    /// SHA-256 of each of [`MIMICRY_FILES`] by its name, which the server adds.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    pub files: Value,
    /// What the pages say, by language and by name: studies without do not carry it.
    pub words: Translations,
}

impl Study {
    /// What the participant's page is sent of the measuring of faces.
    pub(crate) fn mimicry_pages(&self) -> Option<MimicryPages> {
        let Mimicry { consent, rate_hz, needs_face, .. } = self.mimicry.as_ref()?;
        let language = |language: &String| {
            let mut words = mimicry_words(language, self.translations().get(language));
            let own = [("mimicry_heading", &consent.heading), ("mimicry_text", &consent.text)];
            words.extend(
                own.map(|(name, text)| (name.to_owned(), text.in_language(language).to_owned())),
            );
            (language.clone(), words)
        };
        Some(MimicryPages {
            version: consent.version.clone(),
            rate_hz: *rate_hz,
            needs_face: *needs_face,
            shapes: TRACKED_SHAPES.map(str::to_owned).to_vec(),
            files: Value::Null,
            words: self.languages.iter().map(language).collect(),
        })
    }
}
