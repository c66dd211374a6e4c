//! The study file: its types, as they stand in JSON (comments allowed).
//!
//! These are the raw types: what the file says, after [`crate::check`] has found it free of errors.
//! The words are reVISit's where they fit (`studyMetadata`, `components`, `sequence`,
//! `interruptions`, `likert` with `numItems`). Derived things, such as the clips that a rule makes,
//! are methods.

mod adaptive;
mod between;
mod clips;
mod compared;
mod conduct;
mod exertion;
mod general;
mod hypotheses;
mod json_block;
mod languages;
mod local_text;
mod media;
mod method;
mod mimicry;
mod pairs;
mod panel;
mod paths;
mod reverse_correlation;
mod scales;
mod scaling;
mod sequence;
mod sound;
mod stimuli;
mod tables;
mod trial_blocks;
mod triggers;
mod typographic_quotes;

use std::collections::BTreeMap;

use crate::question::Question;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use adaptive::{
    AdaptiveBlock, AdaptiveComponent, LevelClip, LevelRule, PsychometricFunction, QuestPlusRule,
    ShownSegment, StaircaseRule, Varied,
};
pub use between::UnknownCondition;
pub use clips::{BuiltinExpression, Clip, FactorValue, Factors};
pub(crate) use compared::Compared;
pub use compared::NoCells;
pub use conduct::{
    AfterTraining, AttentionEnd, AttentionRule, BackendRule, Calibration, Criterion, DeviceKind,
    DeviceRules, FullscreenRule, ScreeningRule, StatedAnswers, StaticHosting, TimeLimit,
};
pub use exertion::{
    BuiltinMotion, ExertionCapture, ExertionExpressivity, ExertionHeart, ExertionLoads,
    ExertionPerson, ExertionPlanPart, ExertionSex, ExertionSource, WrittenPart,
};
pub use general::{
    Consent, Contact, ContactPerson, Metadata, Published, Recruitment, RepeatPrevention, Section,
};
pub use hypotheses::{
    Exclusions, Generalise, Hypothesis, Measure, SEGMENTS_FOR_OTHER_CLIPS, StraightLining, TestName,
};
pub use json_block::JsonBlock;
pub use languages::{Multilingual, Translations};
pub use local_text::LocalText;
pub use media::{MEDIA_PREFIX, media_type};
pub use method::{MethodEntry, MethodTraining};
pub use mimicry::{
    MIMICRY_FILES, Mimicry, MimicryConsent, MimicryFile, MimicryPages, TRACKED_SHAPES,
};
pub use pairs::{DealtPairs, NoPairs, PairRule, PairSchedule, PairsBlock, PairsComponent};
pub use panel::{PanelBlock, PanelComponent, PanelExclusion, PanelPage, PanelPages, answer_about};
pub use paths::{PathError, WrongVariable, resolve_path};
pub use reverse_correlation::{ReverseCorrelationBlock, ReverseCorrelationComponent};
pub use scales::CompositeScale;
pub use scaling::{ScalingBlock, ScalingComponent, ScalingRule};
pub use sequence::{
    Beside, BreakComponent, ClipSelection, ClipShowing, Component, Constraint, Interruption,
    OrderRule, PageComponent, Questionnaire, Sequence, SequenceItem, Side, Training,
    TrialsComponent,
};
pub use sound::{
    Caption, CaptionRule, CaptureSound, HeardSound, Hearing, SegmentSound, SoundCheck, SoundPages,
    SoundPlace, SoundRule, SoundSection,
};
pub use stimuli::{
    Avatar, AvatarLook, AvatarSource, BuiltinAvatar, BuiltinCapture, Capture, CaptureGaze,
    CaptureSource, ClipCross, ClipEntry, ClipRules, DATA_PREFIX, GazeSource, HeldGaze, Look,
    Performance, Segment, Span, Stimuli, video_type,
};
pub use tables::{Layout, TableLayout};
pub use triggers::Triggers;
use typographic_quotes::TypographicQuote;

/// A whole study file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
#[schemars(title = "Mimique study")]
pub struct Study {
    /// Where the JSON Schema is, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Identifier used in addresses and file names: lower-case letters, digits, `-`.
    pub id: String,
    /// Title, version, authors.
    pub study_metadata: Metadata,
    /// Languages of the pages, the first being the default: `en`, `fr`.
    pub languages: Vec<String>,
    /// Buttons and messages in other languages than English and French, by language and by name:
    /// `mimique check --words de` prints a beginning. In English and French it changes single texts.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub translations: Translations,
    /// Seed of every random stream (below 2^53).
    #[serde(default)]
    pub seed: u64,
    /// Whom a participant can write to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// Where participants come from and go back to.
    #[serde(default)]
    pub recruitment: Recruitment,
    /// What a participant agrees to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub consent: Option<Consent>,
    /// What a device must have; looked at right after consent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<DeviceRules>,
    /// Questions about the participant, asked after consent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub demographics: Option<Questionnaire>,
    /// Whom the study does not take, by their answers to pages of questions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub screening: Vec<ScreeningRule>,
    /// What becomes of failed attention checks; they are only recorded if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attention_checks: Option<AttentionRule>,
    /// Pages read before the first trial.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instructions: Vec<Section>,
    /// How large a CSS pixel is, and how far away the eyes are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// A program on the participant's machine that is told what is shown when.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub triggers: Option<Triggers>,
    /// How participants meet the sound of clips: captions, and the page on which the volume is set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<SoundSection>,
    /// The participant's face, measured in the page while clips play, with a consent of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mimicry: Option<Mimicry>,
    /// Trials for practice; their answers are marked `training`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub training: Option<Training>,
    /// Questions that several components ask, by identifier.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub questions: Vec<Question>,
    /// What the sequence is made of, by name.
    pub components: BTreeMap<String, Component>,
    /// The order of components and trials.
    pub sequence: Sequence,
    /// Shown after the last answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub debriefing: Vec<Section>,
    /// Avatars, captures, segments, methods and the clips made of them.
    pub stimuli: Stimuli,
    /// Where answers go when the pages are hosted without the server.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_hosting: Option<StaticHosting>,
    /// What is tested, and how; read by `mimique analyze`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hypotheses: Vec<Hypothesis>,
    /// Questions whose answers belong together, by the name of the scale; read by `mimique analyze`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub scales: BTreeMap<String, CompositeScale>,
    /// Tables of the report in the study's own layout; read by `mimique analyze`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<TableLayout>,
    /// Rules, fixed beforehand, that leave trials or people out of the analysis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exclusions: Option<Exclusions>,
    /// In a file that was published with its answers: which served file it is. Written by `mimique capsule` and
    /// `mimique deposit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub published: Option<Published>,
}

/// The file is not a study: what a reader says that stops at the first mistake.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyFileError {
    /// Not JSON, nor JSON with comments.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// JSON, but not a study.
    #[error("study file: {0}; run `mimique check` on it for every problem and its place")]
    Shape(String),
}

/// The text is not JSON, nor JSON with comments.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}; {remedy}")]
pub struct SyntaxError {
    /// Line and column, or `study file`.
    pub place: String,
    /// What the parser says, or what is found in the place of JSON.
    pub what: String,
    /// What to do about it.
    pub remedy: &'static str,
}

impl SyntaxError {
    /// What to do about it.
    pub const REMEDY: &str = "write JSON (comments and trailing commas are allowed)";
}

impl Study {
    /// Reads a study from a JSON value, stopping at the first mistake.
    pub fn from_value(value: &serde_json::Value) -> Result<Self, StudyFileError> {
        serde_path_to_error::deserialize(value)
            .map_err(|error| StudyFileError::Shape(error.to_string()))
    }

    /// Reads a study from text: JSON, comments allowed. Stops at the first mistake.
    pub fn from_text(text: &str) -> Result<Self, StudyFileError> {
        Self::from_value(&parse(text)?)
    }
}

/// Parses the text of a study file: JSON, comments and trailing commas allowed.
pub fn parse(text: &str) -> Result<serde_json::Value, SyntaxError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if let Some(line) = nested_too_deeply(text) {
        return Err(SyntaxError {
            place: format!("line {line}"),
            what: format!("brackets nested more than {DEEPEST} deep"),
            remedy: SyntaxError::REMEDY,
        });
    }
    json5::from_str(text).map_err(|error| match typographic_quotes::find(text) {
        Some(TypographicQuote { line, column, quote }) => SyntaxError {
            place: format!("line {line}, column {column}"),
            what: format!("{quote} is a typographic quote, as word processors write them"),
            remedy: "write \" in its place, and the others alike",
        },
        None => not_json(&error),
    })
}

/// What the parser says.
fn not_json(error: &json5::Error) -> SyntaxError {
    SyntaxError {
        place: error.position().map_or_else(
            || "study file".to_owned(),
            |position| format!("line {}, column {}", position.line + 1, position.column + 1),
        ),
        what: error.code().map_or_else(|| error.to_string(), |code| code.to_string()),
        remedy: SyntaxError::REMEDY,
    }
}

/// Deepest nesting of brackets; the parser calls itself for each.
const DEEPEST: usize = 100;

/// The line at which brackets outside of strings and comments are nested too deeply.
fn nested_too_deeply(text: &str) -> Option<usize> {
    let (mut depth, mut line) = (0_usize, 1);
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '\n' => line += 1,
            '[' | '{' => {
                depth += 1;
                if depth > DEEPEST {
                    return Some(line);
                }
            }
            ']' | '}' => depth = depth.saturating_sub(1),
            '"' | '\'' => {
                while let Some(inside) = letters.next() {
                    match inside {
                        '\\' => drop(letters.next()),
                        '\n' => line += 1,
                        _ if inside == letter => break,
                        _ => {}
                    }
                }
            }
            '/' if letters.peek() == Some(&'/') => {
                while letters.next_if(|inside| *inside != '\n').is_some() {}
            }
            '/' if letters.peek() == Some(&'*') => {
                let mut before = ' ';
                letters.next();
                for inside in letters.by_ref() {
                    line += usize::from(inside == '\n');
                    if before == '*' && inside == '/' {
                        break;
                    }
                    before = inside;
                }
            }
            _ => {}
        }
    }
    None
}

impl Study {
    /// Every question of the file: demographics, shared ones, those of questionnaires.
    pub fn all_questions(&self) -> impl Iterator<Item = &Question> {
        questions_among(self.demographics.as_ref(), &self.components, &self.questions)
    }

    /// The questions on which a run of equal answers is straight-lining: those that the rule names, else all
    /// that trials may ask and that are answered on a scale or by options, but attention checks. None where
    /// the study has no such rule.
    pub fn straight_lining_questions(&self) -> Vec<&Question> {
        let rule = self.exclusions.as_ref().and_then(|rules| rules.straight_lining.as_ref());
        let is_meant = |rule: &StraightLining, question: &Question| match rule.questions.as_slice()
        {
            [] => question.attention_check.is_none() && question.is_closed(),
            named => named.contains(&question.id),
        };
        let of = |rule| self.questions.iter().filter(move |question| is_meant(rule, question));
        rule.into_iter().flat_map(of).collect()
    }

    /// The questions that a step asks, by the step's identifier (`demographics`, `faces/joy2.box`).
    pub fn questions_of(&self, step: &str) -> Vec<&Question> {
        let shared = |ids: &[String]| -> Vec<&Question> {
            ids.iter()
                .filter_map(|id| self.questions.iter().find(|question| question.id == *id))
                .collect()
        };
        match component_of(step) {
            "demographics" => self.demographics.iter().flat_map(|page| &page.questions).collect(),
            "training" => {
                self.training.as_ref().map_or_else(Vec::new, |each| shared(&each.questions))
            }
            name => match self.components.get(name) {
                Some(Component::Trials(block)) => shared(&block.questions),
                Some(Component::Pairs(block)) => {
                    block.read().map_or_else(|_| Vec::new(), |block| shared(&block.questions()))
                }
                Some(Component::Panel(block)) => {
                    block.read().map_or_else(|_| Vec::new(), |block| shared(&[block.question]))
                }
                Some(Component::Adaptive(block)) => shared(&[block.question().to_owned()]),
                Some(Component::ReverseCorrelation(block)) => shared(&block.questions()),
                Some(Component::Scaling(block)) => shared(&[block.question().to_owned()]),
                Some(Component::Questionnaire(page)) => page.questions.iter().collect(),
                _ => Vec::new(),
            },
        }
    }
}

/// Every question of demographics, of questionnaires and of those that are shared.
pub(crate) fn questions_among<'a>(
    demographics: Option<&'a Questionnaire>,
    components: &'a BTreeMap<String, Component>,
    shared: &'a [Question],
) -> impl Iterator<Item = &'a Question> {
    let pages = components.values().filter_map(|component| match component {
        Component::Questionnaire(page) => Some(page),
        _ => None,
    });
    demographics.into_iter().chain(pages).flat_map(|page| &page.questions).chain(shared)
}

/// Name of the component (or of the section of the file) that a step comes from.
pub fn component_of(step: &str) -> &str {
    step.split(['/', '#']).next().unwrap_or(step)
}
