//! What is to become of what is personal: each finding is kept or left out by its name, all texts by one word.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::rows::Column;

use super::{ANSWER_CELLS, Finding, Kind};
use crate::responses::{NEEDED, Responses};

/// What becomes of all texts that people wrote.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texts {
    /// They are deposited; what looks like an address or a number in them is asked about all the same.
    Keep,
    /// They are left out.
    Drop,
}

/// What somebody has answered.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Answers {
    /// Names of columns and questions that are deposited as they are.
    pub keep: BTreeSet<String>,
    /// Names of columns and questions that are left out.
    pub drop: BTreeSet<String>,
    /// All texts that people wrote.
    pub texts: Option<Texts>,
}

/// An answer that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotAnswered {
    /// One name is both kept and left out.
    #[error("{name}: --keep and --drop both name it; leave one of them out")]
    Both {
        /// The name.
        name: String,
    },
    /// An identifier is to be kept.
    #[error(
        "--keep {name}: it identifies people to a recruiting service, and is never deposited; leave the option out"
    )]
    Identifies {
        /// The column.
        name: String,
    },
    /// Nothing is called so.
    #[error("{option} {name}: the export has neither a column nor a question of that name; {hint}")]
    Unknown {
        /// `--keep` or `--drop`.
        option: &'static str,
        /// The name.
        name: String,
        /// What there is.
        hint: String,
    },
    /// A column that nothing goes without.
    #[error(
        "--drop {name}: no analysis goes without this column; replace its values in the export"
    )]
    Needed {
        /// The column.
        name: String,
    },
}

/// What was decided.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Judged {
    /// What is deposited though it is personal.
    pub kept: Vec<Finding>,
    /// What was found and is left out.
    pub dropped: Vec<Finding>,
    /// Columns and questions that are left out, found or not.
    pub left_out: BTreeSet<String>,
    /// What nobody has answered.
    pub unanswered: Vec<Finding>,
}

impl Answers {
    /// Whether every name is that of a column or of a question, and can be what is wished.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(
        &self,
        responses: &Responses,
        findings: &[Finding],
        known: &BTreeMap<String, Column>,
    ) -> Result<(), NotAnswered> {
        if let Some(name) = self.keep.intersection(&self.drop).next() {
            return Err(NotAnswered::Both { name: name.clone() });
        }
        let questions = responses.values("response_id");
        let of = |option, names: &'_ BTreeSet<String>| {
            names.iter().map(move |name| (option, name.clone())).collect::<Vec<_>>()
        };
        for (option, name) in [of("--keep", &self.keep), of("--drop", &self.drop)].concat() {
            let is_there = responses.column(&name).is_some()
                || questions.contains(&&*name)
                || known.contains_key(&name)
                || findings.iter().any(|finding| finding.key == name);
            if !is_there {
                let keys: BTreeSet<&str> = findings.iter().map(|finding| &*finding.key).collect();
                let keys: Vec<&str> = keys.into_iter().collect();
                let hint = match keys.as_slice() {
                    [] => "nothing personal was found; leave the option out".to_owned(),
                    keys => format!("what was found is called {}", keys.join(", ")),
                };
                return Err(NotAnswered::Unknown { option, name, hint });
            }
            if option == "--drop" && NEEDED.contains(&&*name) {
                return Err(NotAnswered::Needed { name });
            }
        }
        let identifies = |finding: &&Finding| {
            finding.kind == Kind::RecruitmentIdentifier && self.keep.contains(&finding.key)
        };
        match findings.iter().find(identifies) {
            Some(finding) => Err(NotAnswered::Identifies { name: finding.key.clone() }),
            None => Ok(()),
        }
    }

    /// What becomes of each finding.
    pub fn judge(&self, findings: &[Finding]) -> Judged {
        let mut judged = Judged { left_out: self.drop.clone(), ..Judged::default() };
        let texts: BTreeSet<&str> = (findings.iter())
            .filter(|finding| finding.kind == Kind::FreeText)
            .map(|finding| &*finding.key)
            .collect();
        for finding in findings {
            let is_text = texts.contains(&*finding.key);
            let (kept, dropped) =
                (self.keep.contains(&finding.key), self.drop.contains(&finding.key));
            let place = if finding.kind == Kind::RecruitmentIdentifier || dropped {
                &mut judged.dropped
            } else if kept {
                &mut judged.kept
            } else {
                match self.texts {
                    Some(Texts::Drop) if is_text => &mut judged.dropped,
                    Some(Texts::Keep) if finding.kind == Kind::FreeText => &mut judged.kept,
                    _ => &mut judged.unanswered,
                }
            };
            place.push(finding.clone());
        }
        judged.left_out.extend(judged.dropped.iter().map(|finding| finding.key.clone()));
        judged
    }
}

impl Judged {
    /// Takes out of an export what is left out: columns of these names, and the answers to questions of these names.
    pub fn apply(&self, responses: &mut Responses) {
        responses.without_columns(|name| self.left_out.contains(name));
        responses.without_answers(&ANSWER_CELLS, |asked| self.left_out.contains(asked));
    }
}
