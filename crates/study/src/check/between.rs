//! Conditions between participants: each is one sequence, and everybody who is in it is shown it.

use std::collections::BTreeMap;

use super::issue::{Issues, below};
use crate::study_file::{Sequence, SequenceItem, Study};

/// Most letters of a condition's name.
const LONGEST: usize = 64;

/// The study's conditions; none once, where everybody is shown the same.
pub(super) fn each(study: &Study) -> Vec<Option<&str>> {
    match study.conditions() {
        none if none.is_empty() => vec![None],
        some => some.into_iter().map(Some).collect(),
    }
}

/// Where each component is named, and in which condition (none: in all of them).
pub(super) type Named<'a> = BTreeMap<&'a str, Vec<(Option<&'a str>, String)>>;

/// Where somebody of this condition is shown the component already.
pub(super) fn shown_before(
    named: &Named<'_>,
    name: &str,
    condition: Option<&str>,
) -> Option<String> {
    let meet = |other: &Option<&str>| other.is_none() || condition.is_none() || *other == condition;
    let places = named.get(name)?;
    places.iter().rev().find(|(other, _)| meet(other)).map(|(_, place)| place.clone())
}

pub(super) fn examine(sequence: &Sequence, issues: &mut Issues) {
    let mut found = Vec::new();
    if sequence.conditional {
        let message =
            "the whole study is conditional: nobody outside of the condition is shown anything";
        let hint = "write \"conditional\" in nested sequences, one for each condition";
        issues.error("/sequence/conditional", "bad-condition", message, hint);
    }
    nested(sequence, "/sequence", None, false, &mut found, issues);
    if let [(name, pointer)] = found.as_slice() {
        let message = format!("\"{name}\" is the only condition: everybody is in it");
        let hint = "write a second conditional sequence; \"components\": [] for a condition with \
                    nothing of its own";
        issues.warning(below(pointer, "conditional"), "one-condition", message, hint);
    }
}

/// The sequences in `here`; `condition` is the one that encloses them, `sampled` says whether somebody
/// may be shown none of them.
fn nested<'a>(
    here: &'a Sequence,
    pointer: &str,
    condition: Option<&str>,
    sampled: bool,
    found: &mut Vec<(&'a str, String)>,
    issues: &mut Issues,
) {
    let sampled = sampled || here.num_samples.is_some();
    for (index, item) in here.components.iter().enumerate() {
        let SequenceItem::Sequence(inner) = item else { continue };
        let place = format!("{pointer}/components/{index}");
        if inner.conditional {
            one(inner, &place, condition, sampled, found, issues);
        }
        let own = inner.id.as_deref().filter(|_| inner.conditional);
        nested(inner, &place, own.or(condition), sampled, found, issues);
    }
}

fn one<'a>(
    sequence: &'a Sequence,
    pointer: &str,
    condition: Option<&str>,
    sampled: bool,
    found: &mut Vec<(&'a str, String)>,
    issues: &mut Issues,
) {
    let flag = below(pointer, "conditional");
    let Some(id) = sequence.id.as_deref() else {
        let message = "a condition without a name";
        let hint = "add \"id\": the name that addresses say (?condition=...)";
        issues.error(flag, "bad-condition", message, hint);
        return;
    };
    let place = below(pointer, "id");
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    if id.is_empty() || id.len() > LONGEST || !id.chars().all(plain) {
        let message = format!("\"{id}\" cannot be the name of a condition: it stands in addresses");
        let hint = format!("use letters, digits, _ and -, {LONGEST} at most");
        issues.error(&place, "bad-id", message, hint);
    }
    if let Some(around) = condition {
        let message = format!("no condition shows it: it stands inside the condition \"{around}\"");
        let hint = "move it beside that sequence, or remove \"conditional\"";
        issues.error(&flag, "never-shown", message, hint);
    } else if sampled {
        let message = format!(
            "somebody in the condition \"{id}\" may not be shown it: a sequence around it shows only \
             some of its parts"
        );
        let hint = "remove numSamples there, or move the condition out";
        issues.error(&flag, "bad-condition", message, hint);
    }
    if let Some((_, first)) = found.iter().find(|(name, _)| *name == id) {
        let message = format!("the condition \"{id}\" is at {first} already");
        let hint = "give it another name, or put all that the condition shows into one sequence; two \
                    conditions may name the same component";
        issues.error(place, "duplicate", message, hint);
        return;
    }
    found.push((id, pointer.to_owned()));
}
