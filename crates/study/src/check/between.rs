//! Conditions between participants: each is one sequence, and everybody who is in it is shown it.

use std::collections::BTreeMap;

use super::issue::{Issues, below};
use super::problem::Problem;
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
        issues.error("/sequence/conditional", Problem::WholeStudyConditional);
    }
    nested(sequence, "/sequence", None, false, &mut found, issues);
    if let [(name, pointer)] = found.as_slice() {
        issues.warning(
            below(pointer, "conditional"),
            Problem::OnlyCondition { name: (*name).to_owned() },
        );
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
        issues.error(flag, Problem::NamelessCondition);
        return;
    };
    let place = below(pointer, "id");
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    if id.is_empty() || id.len() > LONGEST || !id.chars().all(plain) {
        issues.error(&place, Problem::ConditionName { name: id.to_owned(), longest: LONGEST });
    }
    if let Some(around) = condition {
        issues.error(&flag, Problem::ConditionInside { around: around.to_owned() });
    } else if sampled {
        issues.error(&flag, Problem::ConditionSampled { name: id.to_owned() });
    }
    if let Some((_, first)) = found.iter().find(|(name, _)| *name == id) {
        issues.error(place, Problem::ConditionTwice { name: id.to_owned(), first: first.clone() });
        return;
    }
    found.push((id, pointer.to_owned()));
}
