//! Avatars, captures, segments, methods, and the rule that makes clips of them.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    BuiltinExpression, CaptureSound, ExertionCapture, Factors, LocalText, MethodEntry,
    SegmentSound, SoundRule,
};

/// A path that starts with this is resolved by the native loader in the folder that the
/// environment variable `MIMIQUE_DATA` names; unset, the loader refuses the study and says so.
/// Other paths are relative to the study file.
pub const DATA_PREFIX: &str = "${MIMIQUE_DATA}/";

/// What is shown, and what it is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Stimuli {
    /// Heads, by identifier.
    pub avatars: BTreeMap<String, Avatar>,
    /// Recorded or built-in performances, by identifier; empty where all faces move at random.
    pub captures: BTreeMap<String, Capture>,
    /// Cuts of the captures; empty where all faces move at random.
    pub segments: Vec<Segment>,
    /// Methods with parameters, by identifier; empty where all faces move at random.
    pub methods: BTreeMap<String, MethodEntry>,
    /// Which sounds clips are played with, by identifier: a factor. Each clip has its segment's own sound, if it
    /// has one, where none is given.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sounds: BTreeMap<String, SoundRule>,
    /// Which avatar performs which segment by which method; every combination if not given.
    #[serde(default)]
    pub clips: ClipRules,
    /// The same look for every clip.
    #[serde(default)]
    pub look: Look,
}

/// Who is seen: exactly one of `builtin`, `file` and `videos`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Avatar {
    /// A person of the built-in head.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub builtin: Option<BuiltinAvatar>,
    /// A GLB file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Videos of a real person: segment -> an MP4 or WebM file, shown as it is. Its clips are made
    /// with the method `recorded`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub videos: BTreeMap<String, String>,
    /// How a head is drawn.
    #[serde(default, skip_serializing_if = "AvatarLook::is_stimulus")]
    pub look: AvatarLook,
    /// Symmetric shapes to cut into `NAME_L` and `NAME_R` along the face's middle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub split: Vec<String>,
    /// Factors of the clips shown with it.
    #[serde(default, skip_serializing_if = "Factors::is_empty")]
    pub factors: Factors,
    /// Name for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<LocalText>,
}

/// A person of the built-in head.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct BuiltinAvatar {
    /// Which person: the same seed is the same face.
    #[serde(default)]
    pub seed: u64,
    /// Instead of a seed: the person who performs where a capture's `builtin` has this `actor`.
    /// With the method `recorded` it shows the performance itself, the truth that methods are
    /// compared with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub actor: Option<u64>,
    /// About how many vertices the skin has: each quad of the head is split in 1, 4, 9, … 64, whichever comes
    /// nearest (2,300 to 146,000); 9,200 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertices: Option<u32>,
}

/// How a head is drawn: camera and light are the same.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum AvatarLook {
    /// Skin, eyes and hair.
    #[default]
    Stimulus,
    /// Grey clay, which nobody takes for a stimulus: for the performance itself.
    Reference,
}

impl AvatarLook {
    /// The word that the stage knows it by.
    pub fn word(self) -> &'static str {
        match self {
            Self::Stimulus => "stimulus",
            Self::Reference => "reference",
        }
    }

    fn is_stimulus(&self) -> bool {
        *self == Self::Stimulus
    }
}

/// Where an avatar comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AvatarSource<'a> {
    /// The built-in head.
    Builtin(&'a BuiltinAvatar),
    /// A GLB file: relative to the study file, or behind [`DATA_PREFIX`].
    File(&'a str),
    /// Videos: segment -> a file, its path as above.
    Videos(&'a BTreeMap<String, String>),
}

impl Avatar {
    /// Where it comes from; `None` unless exactly one source is given.
    pub fn source(&self) -> Option<AvatarSource<'_>> {
        match (&self.builtin, &self.file, self.videos.is_empty()) {
            (Some(builtin), None, true) => Some(AvatarSource::Builtin(builtin)),
            (None, Some(file), true) => Some(AvatarSource::File(file)),
            (None, None, false) => Some(AvatarSource::Videos(&self.videos)),
            _ => None,
        }
    }
}

/// The media type of a video, by the ending of its name; `None` for what browsers do not all play.
pub fn video_type(path: &str) -> Option<&'static str> {
    let (_, ending) = path.rsplit_once('.')?;
    match ending.to_ascii_lowercase().as_str() {
        "mp4" | "m4v" => Some("video/mp4"),
        "webm" => Some("video/webm"),
        _ => None,
    }
}

/// A performance: exactly one of `builtin`, `file` and `exertion`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Capture {
    /// A built-in actor's performances.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub builtin: Option<BuiltinCapture>,
    /// A C3D, TRC or CSV file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The face of a body that exerts itself, computed from the body's motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exertion: Option<ExertionCapture>,
    /// Unit of the file's coordinates where the file does not say: `m`, `cm`, `mm`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Frames per second of the file where the file does not say: arrays of vertices or weights (`.npy`, `.npz`), tables without times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file_rate_hz: Option<f64>,
    /// Which animation of a GLB or glTF file of recorded weights, by its name or its number counted from 1; the first that
    /// moves shapes if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub animation: Option<String>,
    /// Marker map: a JSON or CSV file that says where each marker sits on the avatar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub markers: Option<String>,
    /// Labels of the near-rigid markers that head stabilisation takes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub head: Vec<String>,
    /// Frames of the neutral face: first and end (not included), counted from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neutral: Option<[usize; 2]>,
    /// Cut-off of the low-pass filter on the head's motion, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head_lowpass_hz: Option<f64>,
    /// How much of the head's own motion every clip of this capture shows, 0 (a head that is held still) to 1: the turns
    /// that the head markers tell, or that a built-in actor performs. 1 for built-in actors and 0 for files if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head_motion: Option<f64>,
    /// Where the eyes look in every clip of this capture; they rest if it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gaze: Option<CaptureGaze>,
    /// What was recorded with the whole capture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<CaptureSound>,
    /// Frames a second that are solved and shown, the capture's own if not given. Fewer than the
    /// capture has: low-passed below what they can hold, then brought to the rate. At 60 Hz a
    /// participant loads and solves a third of a capture of 200 Hz. Segments and `neutral` still
    /// count the capture's own frames.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
}

/// A built-in actor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct BuiltinCapture {
    /// Which actor: seed of the identity and of the performance's small differences.
    #[serde(default)]
    pub actor: u64,
    /// Standard deviation of the sensor's noise, millimetres; the generator's default if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_mm: Option<f64>,
}

/// Where the eyes look in a capture: exactly one of `held`, `file`, `target` and `performed`. Every method shows
/// the same gaze, and so do recorded weights.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct CaptureGaze {
    /// One gaze throughout.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<HeldGaze>,
    /// A table of `time` in seconds, `azimuth`, `elevation` and `vergence` in degrees, or recorded weights
    /// with eyeLook shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How many seconds after the file's clock the capture begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub later_s: Option<f64>,
    /// Label of a marker of the capture that stands where the eyes look.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<String>,
    /// The gaze that a built-in actor performs.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub performed: bool,
}

/// One gaze of both eyes, degrees.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct HeldGaze {
    /// To the person's left above 0.
    #[serde(default)]
    pub azimuth: f64,
    /// Upwards above 0.
    #[serde(default)]
    pub elevation: f64,
    /// Angle between both lines of sight: 0 for what is far away.
    #[serde(default)]
    pub vergence: f64,
}

/// What gives the gaze of a capture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GazeSource<'a> {
    /// One gaze throughout.
    Held(HeldGaze),
    /// A file, and how many seconds after its clock the capture begins.
    File(&'a str, f64),
    /// A marker that stands where the eyes look.
    Target(&'a str),
    /// What the built-in actor performs.
    Performed,
}

impl CaptureGaze {
    /// What gives it; `None` unless exactly one is given.
    pub fn source(&self) -> Option<GazeSource<'_>> {
        let later_s = self.later_s.unwrap_or_default();
        match (self.held, &self.file, &self.target, self.performed) {
            (Some(held), None, None, false) => Some(GazeSource::Held(held)),
            (None, Some(file), None, false) => Some(GazeSource::File(file, later_s)),
            (None, None, Some(target), false) => Some(GazeSource::Target(target)),
            (None, None, None, true) => Some(GazeSource::Performed),
            _ => None,
        }
    }
}

/// Where a capture comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CaptureSource<'a> {
    /// A built-in actor.
    Builtin(&'a BuiltinCapture),
    /// A file: relative to the study file, or behind [`DATA_PREFIX`].
    File(&'a str),
    /// The face of a body that exerts itself.
    Exertion(&'a ExertionCapture),
}

impl Capture {
    /// Where it comes from; `None` unless exactly one source is given.
    pub fn source(&self) -> Option<CaptureSource<'_>> {
        match (&self.builtin, &self.file, &self.exertion) {
            (Some(builtin), None, None) => Some(CaptureSource::Builtin(builtin)),
            (None, Some(file), None) => Some(CaptureSource::File(file)),
            (None, None, Some(exertion)) => Some(CaptureSource::Exertion(exertion)),
            _ => None,
        }
    }

    /// The share of the head's own motion that its clips show, 0 to 1.
    pub fn head_motion_shown(&self) -> f64 {
        self.head_motion.unwrap_or(if self.builtin.is_some() { 1.0 } else { 0.0 })
    }
}

/// A cut of a capture: `first` and `end` of a file or of an exertion, or `performance` of a built-in actor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Segment {
    /// Identifier: `joy2`.
    pub id: String,
    /// Which capture.
    pub capture: String,
    /// First frame, counted from 0 at the capture's own rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<usize>,
    /// Frame after the last one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<usize>,
    /// What a built-in actor performs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub performance: Option<Performance>,
    /// What is heard with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<SegmentSound>,
    /// Factors of its clips. A performance's `expression` and `intensity` are always there.
    #[serde(default, skip_serializing_if = "Factors::is_empty")]
    pub factors: Factors,
}

/// What a built-in actor performs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Performance {
    /// Which emotion.
    pub expression: BuiltinExpression,
    /// How strongly: 1 weak, 2 marked, 3 exaggerated.
    pub intensity: u8,
}

/// What a segment takes of its capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Span {
    /// Frames `first..end` of a file or of an exertion.
    Frames {
        /// First frame.
        first: usize,
        /// Frame after the last one.
        end: usize,
    },
    /// A performance of a built-in actor.
    Performance(Performance),
}

impl Segment {
    /// What it takes; `None` unless frames alone or a performance alone are given.
    pub fn span(&self) -> Option<Span> {
        match (self.first, self.end, self.performance) {
            (Some(first), Some(end), None) if first < end => Some(Span::Frames { first, end }),
            (None, None, Some(performance)) => Some(Span::Performance(performance)),
            _ => None,
        }
    }
}

/// Which clips there are.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ClipRules {
    /// Every combination of these; all avatars, segments and methods where a part is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cross: Option<ClipCross>,
    /// Clips one by one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub list: Vec<ClipEntry>,
}

/// Every combination.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ClipCross {
    /// Avatars; all if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub avatars: Vec<String>,
    /// Segments; all if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<String>,
    /// Methods; all if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub methods: Vec<String>,
    /// Sounds; all if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sounds: Vec<String>,
}

/// One clip of a list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ClipEntry {
    /// Which avatar.
    pub avatar: String,
    /// Which segment.
    pub segment: String,
    /// Which method.
    pub method: String,
    /// Which of `sounds`, where there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<String>,
}

/// The same look for every clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Look {
    /// Background, `#rrggbb`.
    #[serde(default = "grey")]
    pub background: String,
    /// Width in CSS pixels; narrower screens shrink it.
    #[serde(default = "size")]
    pub width: u32,
    /// Height in CSS pixels.
    #[serde(default = "size")]
    pub height: u32,
    /// Width on the screen in millimetres, by the section `calibration`. Whoever left the
    /// calibration out sees the clip at the size in pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<f64>,
    /// Height on the screen in millimetres; given together with the width.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<f64>,
}

impl Default for Look {
    fn default() -> Self {
        Self { background: grey(), width: size(), height: size(), width_mm: None, height_mm: None }
    }
}

fn grey() -> String {
    "#808080".to_owned()
}

fn size() -> u32 {
    480
}
