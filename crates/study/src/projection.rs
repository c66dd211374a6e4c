//! A study as the participant's page needs it.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::question::Question;
use crate::study_file::{
    AttentionRule, Avatar, Calibration, Clip, Component, Consent, Contact, DeviceRules, JsonBlock,
    LocalText, Look, MimicryPages, Multilingual, Questionnaire, Recruitment, RepeatPrevention,
    ScreeningRule, Section, Sequence, SoundPages, Study, Training, Translations, Triggers,
    questions_among,
};

/// What the participant's page is sent of a study, and all that orders and plans are drawn from: the
/// sections that people go through, as the file has them, and the clips that its rules make. Avatars,
/// captures and methods are not in it (the server has prepared the clips), and neither is what
/// participants must not know: codes, hypotheses, exclusions, tables.
///
/// One projection serves all participants: the page draws its own order, because a static host has
/// nobody else to draw it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct StudyProjection {
    /// Identifier used in addresses and file names.
    pub id: String,
    /// Title.
    pub title: LocalText,
    /// A sentence on what it is about.
    pub description: LocalText,
    /// Languages of the pages, the first being the default.
    pub languages: Vec<String>,
    /// The study's own buttons and messages, by language and by name.
    pub translations: Translations,
    /// Whom a participant can write to.
    pub contact: Option<Contact>,
    /// Parameters of the address that a recruiting site sends.
    pub url_parameters: Vec<String>,
    /// How a second participation of one person is recognised.
    pub repeat_prevention: RepeatPrevention,
    /// Seconds after which the last page goes back by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub return_after_seconds: Option<u32>,
    /// What a participant agrees to.
    pub consent: Option<Consent>,
    /// What a device must have.
    pub device: Option<DeviceRules>,
    /// Whether a clip is drawn by the browser, for which the device is looked at whatever the study asks.
    #[serde(default)]
    pub draws_clips: bool,
    /// Questions about the participant.
    pub demographics: Option<Questionnaire>,
    /// Whom the study does not take.
    pub screening: Vec<ScreeningRule>,
    /// What becomes of failed attention checks.
    pub attention_checks: Option<AttentionRule>,
    /// Pages read before the first trial.
    pub instructions: Vec<Section>,
    /// How large a CSS pixel is, and how far away the eyes are.
    pub calibration: Option<Calibration>,
    /// What the pages need of sound: [`SoundPages`], or null in a study without. The page hands it on to scripts that
    /// such a study alone loads, and reads a few words of it: a reader of its own would weigh on every study.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    #[schemars(with = "Option<SoundPages>")]
    pub sound: Value,
    /// What the page hands on to the script that tells another program: [`Triggers`], or null.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    #[schemars(with = "Option<Triggers>")]
    pub triggers: Value,
    /// What the page hands on to the scripts that measure the participant's face: [`MimicryPages`], or null.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    #[schemars(with = "Option<MimicryPages>")]
    pub mimicry: Value,
    /// Trials for practice.
    pub training: Option<Training>,
    /// Questions that several components ask.
    pub questions: Vec<Question>,
    /// What the sequence is made of, by name.
    pub components: BTreeMap<String, Component>,
    /// The order of components and trials.
    pub sequence: Sequence,
    /// Shown after the last answer.
    pub debriefing: Vec<Section>,
    /// Every clip with its factors, in the order of the file.
    pub clips: Vec<Clip>,
    /// The same look for every clip.
    pub look: Look,
}

impl Study {
    /// The study as the participant's page needs it.
    pub fn projection(&self) -> StudyProjection {
        let Recruitment { url_parameters, repeat_prevention, return_after_seconds, .. } =
            &self.recruitment;
        StudyProjection {
            id: self.id.clone(),
            title: self.study_metadata.title.clone(),
            description: self.study_metadata.description.clone(),
            languages: self.languages.clone(),
            translations: self.translations.clone(),
            contact: self.contact.clone(),
            url_parameters: url_parameters.clone(),
            repeat_prevention: *repeat_prevention,
            return_after_seconds: *return_after_seconds,
            consent: self.consent.clone(),
            device: self.device.clone(),
            draws_clips: self.draws_clips(),
            demographics: self.demographics.clone(),
            screening: self.screening.clone(),
            attention_checks: self.attention_checks.clone(),
            instructions: self.instructions.clone(),
            calibration: self.calibration.clone(),
            sound: serde_json::to_value(self.sound_pages()).unwrap_or_default(),
            triggers: serde_json::to_value(self.triggers).unwrap_or_default(),
            mimicry: serde_json::to_value(self.mimicry_pages()).unwrap_or_default(),
            training: self.training.clone(),
            questions: self.questions.clone(),
            components: self.projected_components(),
            sequence: self.sequence.clone(),
            debriefing: self.debriefing.clone(),
            clips: self.clips(),
            look: self.stimuli.look.clone(),
        }
    }
}

impl Study {
    /// The components, adaptive blocks with the clips that they show, blocks of reverse correlation with theirs, blocks of pairs as the trials that they make.
    fn projected_components(&self) -> BTreeMap<String, Component> {
        let mut components = self.components.clone();
        for (name, block) in self.trial_blocks() {
            components.insert(name.to_owned(), Component::Trials(block.into_owned()));
        }
        for (name, block) in self.adaptive() {
            let block = serde_json::to_value(block).unwrap_or_default();
            components.insert(name.to_owned(), Component::Adaptive(JsonBlock::new(block)));
        }
        for (name, block) in self.scalings() {
            let block = serde_json::to_value(block).unwrap_or_default();
            components.insert(name.to_owned(), Component::Scaling(JsonBlock::new(block)));
        }
        for (name, block) in self.reverse_correlations() {
            let block = serde_json::to_value(block).unwrap_or_default();
            let block = Component::ReverseCorrelation(JsonBlock::new(block));
            components.insert(name.to_owned(), block);
        }
        components
    }

    /// Whether a clip is drawn by the browser: not every one is a video.
    fn draws_clips(&self) -> bool {
        if !self.clips_at_rest().is_empty() {
            return true;
        }
        let is_drawn = |avatar: &Avatar| avatar.videos.is_empty();
        let avatars = &self.stimuli.avatars;
        self.clips().iter().any(|clip| avatars.get(&clip.avatar).is_some_and(is_drawn))
    }
}

impl Multilingual for StudyProjection {
    fn languages(&self) -> &[String] {
        &self.languages
    }

    fn translations(&self) -> &Translations {
        &self.translations
    }
}

impl StudyProjection {
    /// What the pages say of sound in a language, by name; nothing in a study without.
    pub fn sound_word(&self, language: &str, name: &str) -> &str {
        word(&self.sound, language, name)
    }

    /// What the pages say of the measuring of faces in a language, by name; nothing in a study without.
    pub fn mimicry_word(&self, language: &str, name: &str) -> &str {
        word(&self.mimicry, language, name)
    }

    /// Whether only those may take part who hear the tones of the sound check.
    pub fn hearing_is_required(&self) -> bool {
        self.sound["check"]["hearing"] == "required"
    }

    /// Every question: demographics, those of questionnaires, shared ones.
    pub fn all_questions(&self) -> impl Iterator<Item = &Question> {
        questions_among(self.demographics.as_ref(), &self.components, &self.questions)
    }
}

/// A text of what studies alone carry that need it.
fn word<'a>(pages: &'a Value, language: &str, name: &str) -> &'a str {
    pages["words"][language][name].as_str().unwrap_or_default()
}
