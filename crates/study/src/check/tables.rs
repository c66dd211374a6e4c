//! Tables that the study lays out: that they name what there is, and as much as their layout takes.

use std::ops::RangeInclusive;

use super::issue::{Issues, below};
use super::{Subject, assigned, responses};
use crate::study_file::{Layout, QuestionKind, TableLayout};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let tables = &subject.study.tables;
    for (index, table) in tables.iter().enumerate() {
        let pointer = below("/tables", index);
        if tables[..index].iter().any(|each| each.id == table.id) {
            let message = format!("two tables \"{}\"", table.id);
            issues.error(below(&pointer, "id"), "duplicate", message, "give it another name");
        }
        counts(subject, table, &pointer, issues);
        names(subject, table, &pointer, issues);
        assigned::table(subject, table, &pointer, issues);
    }
}

/// How many of each list a layout takes.
fn counts(subject: &Subject<'_>, table: &TableLayout, pointer: &str, issues: &mut Issues) {
    const NONE: RangeInclusive<usize> = 0..=0;
    const SOME: RangeInclusive<usize> = 1..=usize::MAX;
    let (responses, factors, crossings) = match table.layout {
        Layout::Hypotheses => (NONE, NONE, NONE),
        Layout::Pairs => (SOME, 1..=1, NONE),
        Layout::Means => (SOME, 1..=2, NONE),
        Layout::Interactions => (SOME, NONE, SOME),
        Layout::Influences => (SOME, SOME, NONE),
        Layout::Confusion => (1..=1, 0..=1, NONE),
    };
    for (key, wanted, found) in [
        ("responses", responses, table.responses.len()),
        ("factors", factors, table.factors.len()),
        ("crossings", crossings, table.crossings.len()),
    ] {
        if wanted.contains(&found) {
            continue;
        }
        let message = format!("{found} {key} in the layout \"{}\"", table.layout.word());
        let hint = match (*wanted.start(), *wanted.end()) {
            (_, 0) => "leave them out".to_owned(),
            (low, usize::MAX) => format!("name at least {low}"),
            (low, high) if low == high => format!("name {low}"),
            (low, high) => format!("name {low} to {high}"),
        };
        issues.error(below(pointer, key), "wrong-length", message, hint);
    }
    if table.layout == Layout::Hypotheses && subject.study.hypotheses.is_empty() {
        let message = "the study has no hypotheses";
        issues.error(below(pointer, "layout"), "unknown-reference", message, "state hypotheses");
    }
}

fn names(subject: &Subject<'_>, table: &TableLayout, pointer: &str, issues: &mut Issues) {
    for (index, response) in table.responses.iter().enumerate() {
        let place = below(&below(pointer, "responses"), index);
        let found = responses::tested(subject, response, place.clone(), false, issues);
        let Some(question) = found else { continue };
        let has_truth =
            matches!(&question.kind, QuestionKind::SingleChoice(choice) if choice.truth.is_some());
        if table.layout == Layout::Confusion && !has_truth {
            let message = format!("\"{response}\" has no right answer");
            issues.error(place, "no-truth", message, "give the question \"truth\"");
        }
    }
    let lists = [("factors".to_owned(), table.factors.as_slice())].into_iter().chain(
        table
            .crossings
            .iter()
            .enumerate()
            .map(|(index, pair)| (format!("crossings/{index}"), pair.as_slice())),
    );
    for (key, factors) in lists {
        for (index, factor) in factors.iter().enumerate() {
            assigned::factor(subject, factor, below(&format!("{pointer}/{key}"), index), issues);
        }
    }
}
