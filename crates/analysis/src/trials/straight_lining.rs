//! The longest run of equal answers of each person (the long-string index of Johnson 2005, Journal of
//! Research in Personality 39, 103-129), where the study has a rule about it.

use std::collections::HashMap;

use mimique_stats::Table;
use mimique_study::Study;

use crate::trials::column::Column;
use crate::trials::error::ExportError;
use crate::trials::export::Person;

/// Runs of equal answers of one person, response by response.
#[derive(Debug, Default)]
pub(crate) struct Runs<'a> {
    /// Last answer to each response, and how often it came in a row.
    last: HashMap<&'a str, (String, usize)>,
    longest: usize,
}

impl<'a> Runs<'a> {
    /// Takes the next answer to a response.
    pub(crate) fn add(&mut self, response: &'a str, answer: &str) {
        let run = match self.last.get_mut(response) {
            Some((last, run)) if last == answer => {
                *run += 1;
                *run
            }
            _ => {
                self.last.insert(response, (answer.to_owned(), 1));
                1
            }
        };
        self.longest = self.longest.max(run);
    }

    /// The longest run so far, answers.
    pub(crate) fn longest(&self) -> usize {
        self.longest
    }
}

/// The responses, as the export names them, that the study's rule is about; none without a rule.
pub(crate) fn responses(study: &Study) -> Vec<String> {
    study.straight_lining_questions().into_iter().flat_map(|each| each.response_ids()).collect()
}

/// Finds the longest run of each person of a tidy table. Rows are taken by `trial_order`, those of equal
/// order as they stand.
pub(super) fn count_runs(
    table: &Table,
    study: &Study,
    person_of_row: &[usize],
    people: &mut [Person],
) -> Result<(), ExportError> {
    let responses = responses(study);
    if responses.is_empty() {
        return Ok(());
    }
    let [kind, response, answer, order] =
        ["trial_type", "response_id", "answer", "trial_order"].map(|name| Column::of(table, name));
    let mut rows: Vec<(usize, f64, usize)> = Vec::new();
    for (row, &person) in person_of_row.iter().enumerate() {
        let is_meant = kind.text(row) == Some("trial")
            && response.text(row).is_some_and(|id| responses.iter().any(|each| each == id))
            && answer.text(row).is_some();
        if is_meant {
            rows.push((person, order.number(row)?.unwrap_or(0.0), row));
        }
    }
    rows.sort_by(|left, right| left.0.cmp(&right.0).then(left.1.total_cmp(&right.1)));
    for of_person in rows.chunk_by(|left, right| left.0 == right.0) {
        let mut runs = Runs::default();
        for &(_, _, row) in of_person {
            if let (Some(response), Some(answer)) = (response.text(row), answer.text(row)) {
                runs.add(response, answer);
            }
        }
        people[of_person[0].0].longest_run = runs.longest();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_counted_by_response() {
        let mut runs = Runs::default();
        for (response, answer) in [("a", "4"), ("b", "4"), ("a", "4"), ("b", "5"), ("a", "4")] {
            runs.add(response, answer);
        }
        assert_eq!(runs.longest(), 3);
        runs.add("a", "3");
        runs.add("a", "4");
        assert_eq!(runs.longest(), 3);
    }
}
