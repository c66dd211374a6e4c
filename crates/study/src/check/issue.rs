//! A problem with its place in the file, and the list of all that were found.

use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};

use super::problem::Problem;

/// How bad a problem is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The study cannot run.
    Error,
    /// It can, but probably not as meant.
    Warning,
}

/// A problem, where it is, and how bad it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Issue {
    /// JSON pointer (RFC 6901) into the file; empty for the file itself.
    pub pointer: String,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, with the values that the words name.
    pub problem: Problem,
}

impl Issue {
    /// A problem for which the study cannot run.
    pub fn error(pointer: impl Into<String>, problem: Problem) -> Self {
        Self { pointer: pointer.into(), severity: Severity::Error, problem }
    }

    /// Stable word for the kind of problem: `unknown-key`.
    pub fn code(&self) -> &'static str {
        self.problem.code()
    }

    /// What is wrong, with the value.
    pub fn message(&self) -> String {
        self.problem.message()
    }

    /// What to do about it.
    pub fn remedy(&self) -> String {
        self.problem.remedy()
    }

    /// The place as people read it: `/` for the file itself.
    pub fn place(&self) -> &str {
        if self.pointer.is_empty() { "/" } else { &self.pointer }
    }
}

/// As `mimique check --json` prints it: `pointer`, `severity`, `code`, `message` and `hint`, the remedy.
impl Serialize for Issue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Issue", 5)?;
        fields.serialize_field("pointer", &self.pointer)?;
        fields.serialize_field("severity", &self.severity)?;
        fields.serialize_field("code", self.code())?;
        fields.serialize_field("message", &self.message())?;
        fields.serialize_field("hint", &self.remedy())?;
        fields.end()
    }
}

/// The problems found so far.
#[derive(Debug, Default)]
pub struct Issues(Vec<Issue>);

impl Issues {
    /// Adds a problem for which the study cannot run.
    pub fn error(&mut self, pointer: impl Into<String>, problem: Problem) {
        self.push(Issue::error(pointer, problem));
    }

    /// Adds a problem with which it can run.
    pub fn warning(&mut self, pointer: impl Into<String>, problem: Problem) {
        self.push(Issue { pointer: pointer.into(), severity: Severity::Warning, problem });
    }

    /// Adds a problem that is not known yet.
    pub(super) fn push(&mut self, issue: Issue) {
        if !self.0.contains(&issue) {
            self.0.push(issue);
        }
    }

    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn has_errors(&self) -> bool {
        self.0.iter().any(|issue| issue.severity == Severity::Error)
    }

    /// Pointers of the errors.
    pub(super) fn errors(&self) -> impl Iterator<Item = &str> {
        let errors = self.0.iter().filter(|issue| issue.severity == Severity::Error);
        errors.map(|issue| issue.pointer.as_str())
    }

    /// Errors first, each kind in the order found.
    pub(super) fn into_sorted(self) -> Vec<Issue> {
        let mut issues = self.0;
        issues.sort_by_key(|issue| issue.severity);
        issues
    }
}

/// A pointer one step deeper; `~` and `/` in keys are escaped as RFC 6901 says.
pub(crate) fn below(pointer: &str, key: impl std::fmt::Display) -> String {
    let key = key.to_string().replace('~', "~0").replace('/', "~1");
    format!("{pointer}/{key}")
}
