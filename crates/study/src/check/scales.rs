//! Scales: that their questions are there, give numbers, and are asked in the same way.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Counted;
use super::{Subject, responses};
use crate::question::KindOfQuestion as _;
use crate::study_file::{CompositeScale, Study};

/// Questions that a scale needs.
const ITEMS: usize = 2;

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    for (name, scale) in &subject.study.scales {
        let pointer = below("/scales", name);
        items(subject, scale, &pointer, issues);
        reversed(subject, scale, &pointer, issues);
    }
}

fn items(subject: &Subject<'_>, scale: &CompositeScale, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "items");
    if scale.items.len() < ITEMS {
        issues.error(
            &place,
            Problem::TooFewItems { items: Counted(scale.items.len(), "question"), needed: ITEMS },
        );
    }
    let mut in_trials = None;
    for (index, item) in scale.items.iter().enumerate() {
        let place = below(&place, index);
        if scale.items[..index].contains(item) {
            issues.error(place, Problem::NamedTwice { name: item.clone() });
            continue;
        }
        let Some(question) = responses::named(subject.study, item, &place, issues) else {
            continue;
        };
        let id = || question.id.clone();
        if !question.kind.is_numeric() || question.kind.truth().is_some() {
            issues.error(place, Problem::ItemWithoutNumber { question: id() });
            continue;
        }
        let shared = subject.study.questions.iter().any(|each| each.id == question.id);
        if *in_trials.get_or_insert(shared) != shared {
            issues.error(place, Problem::ItemsAskedApart { question: id() });
        }
    }
}

fn reversed(subject: &Subject<'_>, scale: &CompositeScale, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "reversed");
    for (index, item) in scale.reversed.iter().enumerate() {
        let place = below(&place, index);
        if !scale.items.contains(item) {
            let known: Vec<&str> = scale.items.iter().map(String::as_str).collect();
            issues.error(place, Problem::unknown("item of this scale", item, known));
        } else if scale.reversed[..index].contains(item) {
            issues.error(place, Problem::NamedTwice { name: item.clone() });
        } else if let Some(question) = responses::question(subject.study, item)
            && Study::answer_range(question).is_none()
        {
            issues.error(place, Problem::ItemWithoutRange { question: question.id.clone() });
        }
    }
}
