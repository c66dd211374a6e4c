//! Tables that the study lays out: that they name what there is, and as much as their layout takes.

use std::ops::RangeInclusive;

use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Count;
use super::{Subject, assigned, responses};
use crate::question::KindOfQuestion as _;
use crate::study_file::{Layout, Measure, TableLayout};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let tables = &subject.study.tables;
    for (index, table) in tables.iter().enumerate() {
        let pointer = below("/tables", index);
        if tables[..index].iter().any(|each| each.id == table.id) {
            issues.error(below(&pointer, "id"), Problem::TableTwice { id: table.id.clone() });
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
        let layout = table.layout.word();
        let problem = match *wanted.end() {
            0 => Problem::NoneTaken { found, key, layout },
            _ => Problem::TakenCount { found, key, layout, wanted: Count(wanted) },
        };
        issues.error(below(pointer, key), problem);
    }
    if table.layout == Layout::Hypotheses && subject.study.hypotheses.is_empty() {
        issues.error(below(pointer, "layout"), Problem::NoHypotheses);
    }
}

fn names(subject: &Subject<'_>, table: &TableLayout, pointer: &str, issues: &mut Issues) {
    for (index, response) in table.responses.iter().enumerate() {
        let place = below(&below(pointer, "responses"), index);
        let found = responses::tested(subject, response, place.clone(), false, issues);
        let Some(question) = found else { continue };
        if table.layout == Layout::Confusion && question.kind.truth().is_none() {
            issues.error(&place, Problem::NoTruthInTable { response: response.clone() });
        }
        for factor in table.factors.iter().chain(table.crossings.iter().flatten()) {
            let measure = Measure::Answer;
            if let Some(of_pair) = subject.study.answer_of_pair(question, measure, factor, &[]) {
                issues.error(&place, of_pair.into());
            }
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
