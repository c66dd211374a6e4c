//! What and whose a submission is.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SubmissionProblem;
use crate::arena_file::is_identifier;

/// What and whose a submission is.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct SubmissionDetails {
    /// The method's name in tables and file names: lower-case letters, digits and hyphens.
    pub name: String,
    /// Who made it.
    pub authors: Vec<String>,
    /// What to cite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
    /// The licence of what was submitted.
    pub licence: String,
    /// Where its code is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub code: Option<String>,
    /// The day it was submitted, YYYY-MM-DD.
    pub submitted: String,
    /// Whether it is what was recorded, which the others are held against.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub reference: bool,
}

/// Everything that is wrong with them.
pub fn check_details(details: &SubmissionDetails) -> Vec<SubmissionProblem> {
    let mut found = Vec::new();
    let mut wrong = |what, value: &str, remedy| {
        found.push(SubmissionProblem::Detail { what, value: value.to_owned(), remedy });
    };
    if !is_identifier(&details.name) {
        wrong("method", &details.name, "write lower-case letters, digits and single hyphens");
    }
    if details.authors.is_empty() || details.authors.iter().any(|name| name.trim().is_empty()) {
        wrong("author", "", "name who made it");
    }
    if details.licence.trim().is_empty() {
        wrong("licence", "", "name one, as in CC-BY-4.0: others are to use the weights");
    }
    if let Some(code) = &details.code
        && !["https://", "http://"].iter().any(|start| code.starts_with(start))
    {
        wrong("code", code, "give an address that begins with https://");
    }
    if !is_day(&details.submitted) {
        wrong("date", &details.submitted, "write it as 2026-11-27");
    }
    found
}

/// Whether a text is a day as `2026-11-27`.
pub(crate) fn is_day(text: &str) -> bool {
    mimique_study::instant_ms(&format!("{text}T00:00:00.000Z"))
        .is_some_and(|ms| mimique_study::iso_time(ms as f64).starts_with(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_wrong_with_the_details_is_said_at_once() {
        let details = SubmissionDetails {
            name: "My Method".to_owned(),
            code: Some("somewhere".to_owned()),
            submitted: "2026-02-31".to_owned(),
            ..SubmissionDetails::default()
        };
        let found: Vec<String> = check_details(&details).iter().map(ToString::to_string).collect();
        assert_eq!(found.len(), 5, "{found:#?}");
        assert!(found[0].starts_with("method \"My Method\": write lower-case"), "{found:?}");
        let sound = SubmissionDetails {
            name: "lsts-30".to_owned(),
            authors: vec!["A. Uthor".to_owned()],
            licence: "CC0-1.0".to_owned(),
            code: Some("https://example.org/code".to_owned()),
            submitted: "2026-02-28".to_owned(),
            ..SubmissionDetails::default()
        };
        assert!(check_details(&sound).is_empty());
    }
}
