//! One problem: where, how bad, what, and what to do about it.

use serde::Serialize;

/// How bad a problem is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The study cannot run.
    Error,
    /// It can, but probably not as meant.
    Warning,
}

/// One problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Issue {
    /// JSON pointer (RFC 6901) into the file; empty for the file itself.
    pub pointer: String,
    /// How bad it is.
    pub severity: Severity,
    /// Stable word for the kind of problem: `unknown-key`.
    pub code: &'static str,
    /// What is wrong, with the value.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

/// The problems found so far.
#[derive(Debug, Default)]
pub(super) struct Issues(Vec<Issue>);

impl Issues {
    pub fn error(
        &mut self,
        pointer: impl Into<String>,
        code: &'static str,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.add(pointer.into(), Severity::Error, code, message.into(), hint.into());
    }

    pub fn warning(
        &mut self,
        pointer: impl Into<String>,
        code: &'static str,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.add(pointer.into(), Severity::Warning, code, message.into(), hint.into());
    }

    fn add(
        &mut self,
        pointer: String,
        severity: Severity,
        code: &'static str,
        message: String,
        hint: String,
    ) {
        self.push(Issue { pointer, severity, code, message, hint });
    }

    /// Adds a problem that is not known yet.
    pub fn push(&mut self, issue: Issue) {
        if !self.0.contains(&issue) {
            self.0.push(issue);
        }
    }

    pub fn count(&self) -> usize {
        self.0.len()
    }

    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|issue| issue.severity == Severity::Error)
    }

    /// Pointers of the errors.
    pub fn errors(&self) -> impl Iterator<Item = &str> {
        let errors = self.0.iter().filter(|issue| issue.severity == Severity::Error);
        errors.map(|issue| issue.pointer.as_str())
    }

    /// Errors first, each kind in the order found.
    pub fn into_sorted(self) -> Vec<Issue> {
        let mut issues = self.0;
        issues.sort_by_key(|issue| issue.severity);
        issues
    }
}

/// A pointer one step deeper; `~` and `/` in keys are escaped as RFC 6901 says.
pub(super) fn below(pointer: &str, key: impl std::fmt::Display) -> String {
    let key = key.to_string().replace('~', "~0").replace('/', "~1");
    format!("{pointer}/{key}")
}

/// A list for people: `"a", "b" or "c"`.
pub(super) fn listed<T: AsRef<str>>(names: &[T]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{}\"", name.as_ref())).collect();
    match quoted.split_last() {
        None => "nothing".to_owned(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}
