//! Conditions between participants: nested sequences that only some are shown.

use super::{Sequence, SequenceItem, Study};

/// An address, or a command, names a condition that the study does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no condition {name:?}; the study has: {conditions}")]
pub struct UnknownCondition {
    /// As it was named.
    pub name: String,
    /// Those that the study has, with commas; a dash where it has none.
    pub conditions: String,
}

impl Sequence {
    /// Whether a participant of this condition is shown it.
    pub fn is_shown_in(&self, condition: Option<&str>) -> bool {
        !self.conditional || (self.id.is_some() && self.id.as_deref() == condition)
    }

    /// Names of the conditions, in the order of the file; none where everybody is shown the same.
    pub fn conditions(&self) -> Vec<&str> {
        fn add<'a>(sequence: &'a Sequence, names: &mut Vec<&'a str>) {
            for item in &sequence.components {
                let SequenceItem::Sequence(nested) = item else { continue };
                if let Some(id) = nested.id.as_deref().filter(|_| nested.conditional) {
                    names.push(id);
                }
                add(nested, names);
            }
        }
        let mut names = Vec::new();
        add(self, &mut names);
        names
    }

    /// The conditions that a participant can have: the one that the address names; all of them where it
    /// names none.
    pub fn conditions_for(&self, asked: Option<&str>) -> Result<Vec<&str>, UnknownCondition> {
        let all = self.conditions();
        let Some(name) = asked else { return Ok(all) };
        match all.iter().find(|each| **each == name) {
            Some(found) => Ok(vec![found]),
            None => Err(UnknownCondition {
                name: name.to_owned(),
                conditions: if all.is_empty() { "–".to_owned() } else { all.join(", ") },
            }),
        }
    }
}

impl Study {
    /// Names of the conditions: [`Sequence::conditions`] of the whole sequence.
    pub fn conditions(&self) -> Vec<&str> {
        self.sequence.conditions()
    }
}
