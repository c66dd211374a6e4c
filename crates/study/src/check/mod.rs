//! Every problem of a study file at once, each with its place and a remedy.
//!
//! Text -> JSON -> [`structure`] (keys and types, against the schema that the Rust types generate) ->
//! raw types -> [`general`], [`questions`], [`conduct`], [`stimuli`], [`sequence`], [`hypotheses`],
//! [`scales`], [`tables`] (what no type can say) -> [`CheckedStudy`]. Where the structure is [`damage`]d, the
//! later stages run on what can be read of the file ([`readable`]).

mod adaptive;
mod assigned;
mod attention;
mod avatars;
mod between;
mod compared;
mod conditions;
mod conduct;
mod damage;
mod exertion;
mod general;
mod hypotheses;
mod issue;
mod levels;
mod media;
mod mimicry;
mod nearest;
mod pairs;
mod panel;
mod problem;
mod questions;
mod readable;
mod responses;
mod reverse_correlation;
mod scales;
mod scaling;
mod schema;
mod sequence;
mod sound;
mod stimuli;
mod structure;
mod tables;
mod values;

use serde_json::Value;

use crate::canonical::config_hash;
use crate::study_file::{Clip, Study, parse};
pub(crate) use issue::below;
pub use issue::{Issue, Issues, Severity};
pub use problem::Problem;
use schema::Schemas;
pub use schema::{SCHEMA_ADDRESS, json_schema};
pub use values::{Count, Counted, JsonType, Known, Names, Nearest, Shown, Wanted};

/// A study that was checked and has no errors.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedStudy {
    study: Study,
    value: Value,
    config_hash: String,
}

impl CheckedStudy {
    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The file as JSON (what the participant's page carries).
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// SHA-256 of the canonical file, hexadecimal.
    pub fn config_hash(&self) -> &str {
        &self.config_hash
    }
}

/// What the check found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Every problem, in the order of the file's sections.
    pub issues: Vec<Issue>,
    /// The study, if no issue is an error.
    pub study: Option<CheckedStudy>,
}

impl Report {
    /// Number of errors.
    pub fn errors(&self) -> usize {
        self.issues.iter().filter(|issue| issue.severity == Severity::Error).count()
    }

    /// Number of warnings.
    pub fn warnings(&self) -> usize {
        self.issues.len() - self.errors()
    }
}

/// Whether a file that the study names is there: `Err` says what is wrong, [`Problem::NoFile`] say.
pub type FileLookup<'a> = dyn Fn(&str) -> Result<(), Problem> + 'a;

/// What is wrong in the files that a study names, found by opening them: faults at places of the study file.
pub type OpenedFiles<'a> = dyn Fn(&Study) -> Vec<Issue> + 'a;

/// The files that a study names, as the check sees them.
struct Files<'a> {
    lookup: &'a FileLookup<'a>,
    opened: &'a OpenedFiles<'a>,
}

/// Checks the text of a study file. `lookup` is asked for every file that the study names.
pub fn check(text: &str, lookup: &FileLookup<'_>) -> Report {
    check_opened(text, lookup, &|_| Vec::new())
}

/// The same with what is wrong in the files, which `opened` finds. It is asked whatever else is wrong, as far as the
/// study can be read; what it finds where something is known to be wrong already is left out.
pub fn check_opened(text: &str, lookup: &FileLookup<'_>, opened: &OpenedFiles<'_>) -> Report {
    let mut issues = Issues::default();
    let study = examine(text, &Files { lookup, opened }, &mut issues);
    let issues = issues.into_sorted();
    let errors = issues.iter().any(|issue| issue.severity == Severity::Error);
    Report { issues, study: study.filter(|_| !errors) }
}

fn examine(text: &str, files: &Files<'_>, issues: &mut Issues) -> Option<CheckedStudy> {
    let value = match parse(text) {
        Ok(value) => value,
        Err(error) => {
            issues.error("", error.into());
            return None;
        }
    };
    let schema = json_schema();
    let (texts, damage) = structure::examine(&schema, &value, issues);
    let config_hash = config_hash(&value);
    if !damage.is_none() || issues.has_errors() {
        let readable = readable::readable(&Schemas { root: &schema }, &damage.corrected(&value));
        let study = Study::from_value(&readable).ok()?;
        let mut found = Issues::default();
        examine_study(&study, &value, &config_hash, &texts, files, &mut found);
        for issue in found.into_sorted().into_iter().filter(|issue| damage.leaves(issue)) {
            issues.push(damage.placed(issue));
        }
        return None;
    }
    let study = match Study::from_value(&value) {
        Ok(study) => study,
        Err(error) => {
            // The structure is sound, so this is a rule that only the reader knows.
            issues.error("", Problem::Shape { what: error.to_string() });
            return None;
        }
    };
    examine_study(&study, &value, &config_hash, &texts, files, issues);
    Some(CheckedStudy { study, value, config_hash })
}

/// What no type can say.
fn examine_study(
    study: &Study,
    value: &Value,
    hash: &str,
    texts: &[String],
    files: &Files<'_>,
    issues: &mut Issues,
) {
    let lookup = files.lookup;
    let clips = study.clips();
    let subject = Subject { study, value, clips: &clips, hash };
    general::examine(&subject, texts, issues);
    questions::examine(&subject, issues);
    conduct::examine(&subject, issues);
    media::examine(&subject, lookup, issues);
    mimicry::examine(&subject, lookup, issues);
    stimuli::examine(&subject, lookup, issues);
    sound::examine(&subject, lookup, issues);
    sequence::examine(&subject, issues);
    hypotheses::examine(&subject, issues);
    scales::examine(&subject, issues);
    tables::examine(&subject, issues);
    let known: Vec<String> = issues.errors().map(str::to_owned).collect();
    for issue in (files.opened)(study) {
        if !known.iter().any(|place| damage::is_within(&issue.pointer, place)) {
            issues.push(issue);
        }
    }
}

/// What is checked.
struct Subject<'a> {
    study: &'a Study,
    value: &'a Value,
    clips: &'a [Clip],
    hash: &'a str,
}
