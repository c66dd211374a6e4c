//! Whether the answers of an export were given to the study file that they are analysed with.
//!
//! Every row of an export has the hash of the study file that was served. Another study's answers are refused; where
//! another version of the study was served, the report says how its rules, hypotheses and factors differ.

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::Table;
use mimique_study::{Question, Study, StudyFileError, answer_hashes};
use serde::Serialize;
use serde_json::Value;

use crate::trials::column::Column;
use crate::trials::error::ExportError;

/// A study file that was served, as exports in Psych-DS form carry it.
#[derive(Debug, Clone)]
pub struct ServedVersion {
    /// Each `config_hash` that its answers can have.
    pub config_hashes: Vec<String>,
    /// The file, read.
    pub study: Study,
}

impl ServedVersion {
    /// Reads a study file.
    ///
    /// # Errors
    /// [`StudyFileError`]: no JSON, or no study.
    pub fn from_text(text: &str) -> Result<Self, StudyFileError> {
        let file = mimique_study::parse(text)?;
        Ok(Self { config_hashes: answer_hashes(&file), study: Study::from_value(&file)? })
    }
}

/// The study file of the analysis and those that were served.
#[derive(Debug, Clone, Copy, Default)]
pub struct StudyVersions<'a> {
    /// Each `config_hash` that answers to the file of the analysis can have; without any nothing is compared.
    pub config_hashes: &'a [String],
    /// Versions of which the file is known.
    pub served: &'a [ServedVersion],
}

/// Answers that were given to another version of the study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OtherVersion {
    pub config_hash: String,
    /// Participants with rows of this version.
    pub people: usize,
    /// What differs; `None` where the file of the version is not known.
    pub differences: Option<Vec<Difference>>,
}

/// What differs between two versions of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Difference {
    pub of: Part,
    /// The rule, hypothesis or factor.
    pub name: String,
    /// In the version that was served; `None` where it is absent.
    pub served: Option<String>,
    /// In the file of the analysis; `None` where it is absent.
    pub analysed: Option<String>,
}

/// A part of the study file on which results depend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Part {
    Rule,
    Hypothesis,
    Factor,
}

/// The versions that answers were given to, other than the file of the analysis. Refuses another study.
pub(crate) fn other_versions(
    table: &Table,
    study: &Study,
    versions: StudyVersions<'_>,
) -> Result<Vec<OtherVersion>, ExportError> {
    let own = versions.config_hashes;
    if own.is_empty() || !table.has("config_hash") {
        return Ok(Vec::new());
    }
    let is_own = |hash: &&str| own.iter().any(|own| own == *hash);
    let [hash, participant, stage] =
        ["config_hash", "participant_id", "stage"].map(|name| Column::of(table, name));
    // Pilot sessions take no part once there are live ones, and often precede the last changes.
    let is_pilot = |row: usize| stage.text(row) == Some("pilot");
    let all_pilot = (0..table.rows()).all(is_pilot);
    let mut people: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for row in (0..table.rows()).filter(|row| all_pilot || !is_pilot(*row)) {
        if let Some(hash) = hash.text(row).filter(|hash| !is_own(hash)) {
            people.entry(hash).or_default().extend(participant.text(row));
        }
    }
    let mut others = Vec::new();
    for (hash, people) in people {
        let served = (versions.served.iter())
            .find(|version| version.config_hashes.iter().any(|own| own == hash));
        let another = match served {
            Some(version) => version.study.id != study.id,
            None => !has_trials_of(table, study, hash),
        };
        if another {
            return Err(ExportError::AnotherStudy {
                config_hash: hash.to_owned(),
                of: served.map(|version| version.study.id.clone()),
                study: study.id.clone(),
            });
        }
        others.push(OtherVersion {
            config_hash: hash.to_owned(),
            people: people.len(),
            differences: served.map(|version| differences(&version.study, study)),
        });
    }
    Ok(others)
}

/// Whether rows of a version could be answers to the study: at least half of them are of one of its clips, with one of its
/// questions. Studies of one laboratory share some clips and questions. Rows without a trial say nothing.
fn has_trials_of(table: &Table, study: &Study, hash: &str) -> bool {
    let [own, kind, stimulus, response] = ["config_hash", "trial_type", "stimulus", "response_id"]
        .map(|name| Column::of(table, name));
    let clips = study.clips();
    let clips: BTreeSet<&str> = clips.iter().map(|clip| clip.id.as_str()).collect();
    let questions: BTreeSet<String> =
        study.all_questions().flat_map(Question::response_ids).collect();
    let (mut trials, mut fitting) = (0, 0);
    for row in 0..table.rows() {
        if own.text(row) != Some(hash) || kind.text(row) != Some("trial") {
            continue;
        }
        trials += 1;
        let is_clip =
            stimulus.text(row).is_none_or(|clip| clips.is_empty() || clips.contains(clip));
        let is_asked = response.text(row).is_some_and(|response| questions.contains(response));
        fitting += usize::from(is_clip && is_asked);
    }
    2 * fitting >= trials
}

fn differences(served: &Study, analysed: &Study) -> Vec<Difference> {
    let both = |of: Part, parts: fn(&Study) -> BTreeMap<String, String>| {
        let (served, analysed) = (parts(served), parts(analysed));
        let names: BTreeSet<&String> = served.keys().chain(analysed.keys()).collect();
        let differing = names.into_iter().filter(|name| served.get(*name) != analysed.get(*name));
        let differing = differing.map(|name| Difference {
            of,
            name: name.clone(),
            served: served.get(name).cloned(),
            analysed: analysed.get(name).cloned(),
        });
        differing.collect::<Vec<_>>()
    };
    let mut found = both(Part::Rule, rules);
    found.extend(both(Part::Hypothesis, hypotheses));
    found.extend(both(Part::Factor, factors));
    found
}

/// The rules of exclusion by their keys in the study file.
fn rules(study: &Study) -> BTreeMap<String, String> {
    let mut rules = BTreeMap::new();
    if let Ok(Value::Object(own)) = serde_json::to_value(&study.exclusions) {
        // A rule that is off is no rule.
        let set = own.into_iter().filter(|(_, value)| !matches!(value, Value::Bool(false)));
        rules.extend(set.map(|(name, value)| (name, value.to_string())));
    }
    for (name, block) in study.panel_blocks() {
        if let Some(own) = &block.exclude {
            let own = serde_json::to_value(own).unwrap_or_default();
            rules.insert(format!("{name}.exclude"), own.to_string());
        }
    }
    rules
}

/// What is tested, without the words of the statement.
fn hypotheses(study: &Study) -> BTreeMap<String, String> {
    let tested = |hypothesis: &mimique_study::Hypothesis| {
        let mut own = serde_json::to_value(hypothesis).unwrap_or_default();
        if let Some(keys) = own.as_object_mut() {
            for words in ["id", "statement", "smallestEffectReason"] {
                keys.remove(words);
            }
        }
        (hypothesis.id.clone(), own.to_string())
    };
    study.hypotheses.iter().map(tested).collect()
}

/// The levels of each factor of the clips.
fn factors(study: &Study) -> BTreeMap<String, String> {
    let clips = study.clips();
    let names = study.factor_names().into_iter();
    let levels = names.map(|name| {
        let levels: BTreeSet<String> =
            clips.iter().filter_map(|clip| clip.factor_text(&name)).collect();
        (name, levels.into_iter().collect::<Vec<_>>().join(", "))
    });
    levels.collect()
}
