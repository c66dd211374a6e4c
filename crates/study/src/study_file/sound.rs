//! The sound of clips: files of segments and captures, which sound a clip is played with, captions, and the page
//! on which participants set the volume.

use std::collections::{BTreeMap, BTreeSet};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Clip, Factors, LocalText, Segment, Study, Translations};
use crate::study_file::Multilingual as _;
use crate::text::sound_words;

/// The sound of a segment. Without `file` it is cut out of the sound of the segment's capture.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SegmentSound {
    /// a WAV, an MP3 or an Ogg Opus file that belongs to this segment alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Where in the file the segment's first frame is, seconds: 0, its beginning, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// What is said and heard, in the order of its times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub captions: Vec<Caption>,
}

/// The sound of a whole capture: each segment is heard where it stands in the capture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct CaptureSound {
    /// a WAV, an MP3 or an Ogg Opus file.
    pub file: String,
    /// Where in the file the capture's first frame (frame 0) is, seconds: 0, its beginning, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
}

/// What is said or heard during a part of a clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Caption {
    /// From when it is shown, seconds after the segment's first frame.
    pub from_s: f64,
    /// Until when.
    pub to_s: f64,
    /// The text.
    pub text: LocalText,
}

/// Which sound a clip is played with: the segment's own, unless it says otherwise.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SoundRule {
    /// Whether no sound is played.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub silent: bool,
    /// Segment -> the segment whose sound is played in the place of its own.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub from: BTreeMap<String, String>,
    /// How much later than the face the sound is heard, milliseconds; earlier below 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delay_ms: Option<f64>,
    /// Factors of the clips played with it. Its name is always there, as the factor `sound`.
    #[serde(default, skip_serializing_if = "Factors::is_empty")]
    pub factors: Factors,
    /// Name for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<LocalText>,
}

/// How participants meet sound: captions, and the page on which they set the volume. A study whose clips have
/// sound has that page with or without this section.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SoundSection {
    /// Whether captions are shown below the clip.
    #[serde(default)]
    pub captions: CaptionRule,
    /// The page on which the volume is set and hearing is checked.
    #[serde(default)]
    pub check: SoundCheck,
}

/// Whether captions are shown below the clip.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum CaptionRule {
    /// They are not.
    #[default]
    Off,
    /// They always are.
    On,
    /// The participant switches them on and off; they are off at first.
    Offered,
}

/// The page on which the volume is set: in each round a few tones are played, and the participant says how many.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct SoundCheck {
    /// A line below the heading: headphones, a quiet room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<LocalText>,
    /// How many rounds there are.
    #[serde(default = "three")]
    pub rounds: u32,
    /// How many rounds must be right.
    #[serde(default = "two")]
    pub correct: u32,
    /// Most tones in a round; the least is 1.
    #[serde(default = "four")]
    pub most_tones: u32,
    /// How often all rounds may be gone through.
    #[serde(default = "two")]
    pub attempts: u32,
    /// What becomes of people who do not hear the tones.
    #[serde(default)]
    pub hearing: Hearing,
}

/// What becomes of people who do not hear the tones.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Hearing {
    /// They go on; every row of theirs says so.
    #[default]
    Noted,
    /// They are screened out.
    Required,
}

fn two() -> u32 {
    2
}

fn three() -> u32 {
    3
}

fn four() -> u32 {
    4
}

impl Default for SoundCheck {
    fn default() -> Self {
        let hearing = Hearing::default();
        Self { text: None, rounds: 3, correct: 2, most_tones: 4, attempts: 2, hearing }
    }
}

/// What the participant's page is sent of sound; nothing in a study without.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct SoundPages {
    /// Whether captions are shown.
    pub captions: CaptionRule,
    /// The page on which the volume is set.
    pub check: SoundCheck,
    /// What the pages say of sound, by language and by name: studies without sound do not carry it.
    pub words: Translations,
}

/// What is heard with a clip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeardSound<'a> {
    /// The file.
    pub file: &'a str,
    /// JSON pointer of the sound in the study file, below which `file` and `fromS` stand.
    pub place: SoundPlace<'a>,
    /// Where in the file the first frame of the segment, or of its capture, is, seconds.
    pub from_s: f64,
    /// The segment whose sound it is: the clip's own, or another.
    pub segment: &'a Segment,
    /// How much later than the face it is heard, milliseconds.
    pub delay_ms: f64,
}

/// Where in a study file a sound stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SoundPlace<'a> {
    /// In the segment at this place of the list.
    Segment(usize),
    /// In the capture of this name.
    Capture(&'a str),
}

impl SoundPlace<'_> {
    /// The JSON pointer.
    pub fn pointer(&self) -> String {
        match self {
            Self::Segment(index) => format!("/stimuli/segments/{index}/sound"),
            Self::Capture(name) => {
                format!("{}/sound", crate::check::below("/stimuli/captures", name))
            }
        }
    }
}

impl Study {
    /// What is heard with a clip; nothing where its rule is silence, or its segment has no sound.
    pub fn heard(&self, clip: &Clip) -> Option<HeardSound<'_>> {
        let rule = clip.sound.as_ref().and_then(|name| self.stimuli.sounds.get(name));
        if rule.is_some_and(|rule| rule.silent) {
            return None;
        }
        let other = rule.and_then(|rule| rule.from.get(&clip.segment));
        let delay_ms = rule.and_then(|rule| rule.delay_ms).unwrap_or_default();
        let sound = self.sound_of(other.unwrap_or(&clip.segment))?;
        Some(HeardSound { delay_ms, ..sound })
    }

    /// The sound of a segment: its own, or that of its capture.
    pub fn sound_of(&self, segment: &str) -> Option<HeardSound<'_>> {
        let segments = &self.stimuli.segments;
        let index = segments.iter().position(|each| each.id == segment)?;
        let segment = &segments[index];
        let own = segment.sound.as_ref();
        if let Some(file) = own.and_then(|own| own.file.as_deref()) {
            let from_s = own.and_then(|own| own.from_s).unwrap_or_default();
            let place = SoundPlace::Segment(index);
            return Some(HeardSound { file, place, from_s, segment, delay_ms: 0.0 });
        }
        let (name, capture) = self.stimuli.captures.get_key_value(&segment.capture)?;
        let CaptureSound { file, from_s } = capture.sound.as_ref()?;
        let (from_s, place) = (from_s.unwrap_or_default(), SoundPlace::Capture(name));
        Some(HeardSound { file, place, from_s, segment, delay_ms: 0.0 })
    }

    /// Whether something is heard with one of the clips.
    pub fn has_sound(&self) -> bool {
        self.clips().iter().any(|clip| self.heard(clip).is_some())
    }

    /// Every sound that a clip is played with, each once, in the order of the clips.
    pub fn sounds(&self) -> Vec<HeardSound<'_>> {
        let mut known = BTreeSet::new();
        let mut sounds = Vec::new();
        for clip in self.clips() {
            let heard = self.heard(&clip);
            sounds.extend(heard.filter(|heard| known.insert(heard.segment.id.as_str())));
        }
        sounds
    }

    /// What the participant's page is sent of sound.
    pub(crate) fn sound_pages(&self) -> Option<SoundPages> {
        let SoundSection { captions, check } = self.sound.clone().unwrap_or_default();
        let language = |language: &String| {
            let mut words = sound_words(language, self.translations().get(language));
            let note = check.text.as_ref().map(|text| text.in_language(language).to_owned());
            words.insert("sound_note".to_owned(), note.unwrap_or_default());
            (language.clone(), words)
        };
        let words = self.languages.iter().map(language).collect();
        self.has_sound().then_some(SoundPages { captions, check, words })
    }
}
