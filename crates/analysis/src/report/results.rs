//! Everything that a report computed, as `results.json` has it.

use std::collections::BTreeMap;

use mimique_stats::{Confusion, Description, Labelled, Outcome};
use serde::Serialize;

use crate::agreement::{Agreement, ScaleConsistency};
use crate::faces::BlockImages;
use crate::hypothesis::HypothesisResult;
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::person_level::PersonLevel;
use crate::hypothesis::trial_level::TrialLevel;
use crate::mimicry::MimicryResult;
use crate::report::section::best_worst::BestWorstCounts;
use crate::report::section::choices::Choices;
use crate::report::section::course::Course;
use crate::report::section::detection::QuestionDetection;
use crate::report::section::layouts::LayoutCell;
use crate::report::section::panels::PanelResult;
use crate::report::section::roc::QuestionRoc;
use crate::report::section::stimulus_measures::MeasureCorrelation;
use crate::report::section::traces::MeanTraces;
use crate::scaling::BlockScale;
use crate::sensitivity::Sensitivity;
use crate::thresholds::BlockThresholds;
use crate::trials::exclusion_rates::ExclusionRates;
use crate::trials::export::{Flow, Person};
use crate::trials::versions::OtherVersion;

/// Everything that was computed, for `results.json`.
#[derive(Serialize, Default)]
pub(crate) struct Results<'a> {
    pub study: String,
    pub version: String,
    pub language: &'static str,
    pub flow: Option<&'a Flow>,
    pub people: &'a [Person],
    /// Whether trials are excluded more often at some levels of a factor.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub exclusion_rates: Vec<ExclusionRates>,
    pub about_people: BTreeMap<String, AboutPeople>,
    /// Versions of the study that were served, other than this file.
    #[serde(skip_serializing_if = "<[OtherVersion]>::is_empty")]
    pub other_versions: &'a [OtherVersion],
    pub hypotheses: Vec<HypothesisResult>,
    /// Where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<&'a Sensitivity>,
    pub confusion: Vec<NamedConfusion>,
    pub comparisons: Vec<Comparison>,
    pub choices: Vec<Choices>,
    pub best_worst: Vec<BestWorstCounts>,
    pub two_way: Vec<TwoWay>,
    pub course: Vec<Course>,
    pub layouts: Vec<LayoutCell>,
    pub late_frames: Vec<LateFrames>,
    /// Of adaptive blocks.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub thresholds: Vec<BlockThresholds>,
    /// Of blocks of difference scaling.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scalings: Vec<BlockScale>,
    /// Of blocks of reverse correlation.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<BlockImages>,
    /// Of forced choices, category by category.
    pub detection: Vec<QuestionDetection>,
    /// Of forced choices with a rating of confidence.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub roc: Vec<QuestionRoc>,
    /// About the clips, question by question.
    pub agreement: Vec<Agreement>,
    /// Scales that the study file declares.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub scales: Vec<ScaleConsistency>,
    /// Of ratings that follow the clip.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub traces: Vec<MeanTraces>,
    /// Of blocks of panels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub panels: Vec<PanelResult>,
    /// Where a table of stimuli was given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stimulus_measures: Vec<MeasureCorrelation>,
    /// Of studies that measure faces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mimicry: Option<MimicryResult>,
}

impl Results<'_> {
    /// What a part of the report has computed, behind what is there.
    pub(crate) fn append(&mut self, part: Self) {
        self.exclusion_rates.extend(part.exclusion_rates);
        self.about_people.extend(part.about_people);
        self.hypotheses.extend(part.hypotheses);
        self.confusion.extend(part.confusion);
        self.comparisons.extend(part.comparisons);
        self.choices.extend(part.choices);
        self.best_worst.extend(part.best_worst);
        self.two_way.extend(part.two_way);
        self.course.extend(part.course);
        self.layouts.extend(part.layouts);
        self.late_frames.extend(part.late_frames);
        self.thresholds.extend(part.thresholds);
        self.scalings.extend(part.scalings);
        self.faces.extend(part.faces);
        self.detection.extend(part.detection);
        self.roc.extend(part.roc);
        self.agreement.extend(part.agreement);
        self.scales.extend(part.scales);
        self.panels.extend(part.panels);
        self.traces.extend(part.traces);
        self.stimulus_measures.extend(part.stimulus_measures);
        self.mimicry = self.mimicry.take().or(part.mimicry);
    }
}

/// Answers about people.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AboutPeople {
    /// Of a number.
    Numbers(Outcome<Description>),
    /// Of words: people an answer.
    Counts(Labelled<usize>),
}

/// A confusion matrix of some of the trials.
#[derive(Serialize)]
pub(crate) struct NamedConfusion {
    pub response: String,
    /// The factor; none for all trials.
    pub by: Option<String>,
    /// `all`, or a factor's level.
    pub of: String,
    pub result: Confusion,
}

/// Two factors and their interaction.
#[derive(Serialize)]
pub(crate) struct TwoWay {
    pub measure: String,
    pub factors: [String; 2],
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
}

/// Late frames at a level of the first factor.
#[derive(Serialize)]
pub(crate) struct LateFrames {
    pub level: String,
    pub trials: usize,
    pub frames: f64,
    pub late: f64,
    pub trials_with_late_frames: usize,
    pub longest_ms: Option<f64>,
}
