//! The people of an export: one session each, which has rows of the table.

use std::collections::HashMap;

use mimique_stats::Table;
use mimique_study::Study;
use mimique_study::columns::ASSIGNED_CONDITION;

use crate::trials::column::Column;
use crate::trials::error::ExportError;
use crate::trials::export::{EXCLUDED, Person};

/// The people of an export before any is left out.
pub(super) struct Sessions<'t> {
    pub people: Vec<Person>,
    /// Stage of each person.
    pub stages: Vec<&'t str>,
    /// The researcher's reason for excluding each person, where one is given.
    pub reasons: Vec<Option<&'t str>>,
    /// Place in `people` of each row of the table.
    pub person_of_row: Vec<usize>,
}

impl<'t> Sessions<'t> {
    /// Reads everybody who has a row.
    pub(super) fn read(table: &'t Table) -> Result<Self, ExportError> {
        let [participant, status, stage, attention, sound] =
            ["participant_id", "status", "stage", "attention_passed", "sound_check"]
                .map(|name| Column::of(table, name));
        let mut people: Vec<Person> = Vec::new();
        let mut place: HashMap<&str, usize> = HashMap::new();
        let mut person_of_row = Vec::with_capacity(table.rows());
        let mut stages: Vec<&str> = Vec::new();
        // Rows of one person mostly follow each other.
        let mut last: Option<(&str, usize)> = None;
        for row in 0..table.rows() {
            let id = participant.needed(row)?;
            let same = last.filter(|(known, _)| *known == id).map(|(_, person)| person);
            let person = same.unwrap_or_else(|| {
                *place.entry(id).or_insert_with(|| {
                    people.push(Person {
                        id: id.to_owned(),
                        status: status.text(row).unwrap_or("unknown").to_owned(),
                        trials: 0,
                        failed_checks: 0,
                        longest_run: 0,
                        heard: sound.text(row) == Some("heard"),
                        excluded: None,
                    });
                    stages.push(stage.text(row).unwrap_or("live"));
                    people.len() - 1
                })
            });
            last = Some((id, person));
            if attention.text(row) == Some("false") {
                people[person].failed_checks += 1;
            }
            person_of_row.push(person);
        }
        let reasons = vec![None; people.len()];
        let mut sessions = Self { people, stages, reasons, person_of_row };
        sessions.mark_excluded(table);
        Ok(sessions)
    }

    /// The server marks whom the researcher excluded; how the session stood is kept beside it.
    fn mark_excluded(&mut self, table: &'t Table) {
        if !(table.has("excluded") && table.has("exclusion_reason")) {
            return;
        }
        let [excluded, reason] =
            ["excluded", "exclusion_reason"].map(|name| Column::of(table, name));
        for (row, &person) in self.person_of_row.iter().enumerate() {
            if excluded.text(row) == Some("true") {
                EXCLUDED.clone_into(&mut self.people[person].status);
                self.reasons[person] = reason.text(row);
            }
        }
    }
}

/// Columns of answers about the person, and of the assigned condition: the same in each of the person's
/// rows.
pub(super) fn about_people(
    table: &Table,
    study: &Study,
    person_of_row: &[usize],
    people: usize,
) -> Vec<(String, Vec<Option<String>>)> {
    let questions: Vec<&str> = study
        .demographics
        .iter()
        .flat_map(|page| &page.questions)
        .map(|question| question.id.as_str())
        .collect();
    let conditions = !study.conditions().is_empty();
    let own = |name: &String| {
        (conditions && name == ASSIGNED_CONDITION)
            || questions.iter().any(|id| {
                name == id || name.strip_prefix(id).is_some_and(|rest| rest.starts_with('.'))
            })
    };
    let mut about = Vec::new();
    for (place, name) in table.names().iter().enumerate().filter(|(_, name)| own(name)) {
        let mut cells: Vec<Option<String>> = vec![None; people];
        for (row, &person) in person_of_row.iter().enumerate() {
            if cells[person].is_none() {
                cells[person] = table.cell(row, place).map(str::to_owned);
            }
        }
        about.push((name.clone(), cells));
    }
    about
}
