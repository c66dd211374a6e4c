//! The wide form: one row a participant, one column a trial x response.

use std::collections::BTreeMap;

use serde_json::Value;

use super::SessionRecord;
use super::column::{Column, Table};
use super::tidy::tidy;
use mimique_study::columns::{ASSIGNED_CONDITION, ColumnKind};
use mimique_study::{ClipSource, Study};

/// Columns of the tidy form that are the same in all rows of a participant.
const PERSONAL: [&str; 10] = [
    "participant_id",
    "participant",
    "slot",
    ASSIGNED_CONDITION,
    "stage",
    "status",
    "language",
    "consent_version",
    "seed",
    "config_hash",
];

/// The wide form: the participant's columns, then `TRIAL.RESPONSE` for each answer (in alphabetical
/// order of trial, so that all participants share one order) and `TRIAL.RESPONSE.rt`.
pub fn wide<'a>(
    study: &Study,
    clips: &BTreeMap<String, ClipSource>,
    sessions: impl IntoIterator<Item = SessionRecord<'a>>,
) -> Table {
    let long = tidy(study, clips, sessions);
    let mut columns: Vec<Column> = PERSONAL
        .iter()
        .filter_map(|name| long.column(name).map(|index| long.columns[index].clone()))
        .collect();
    let mut answers: BTreeMap<(String, String), Column> = BTreeMap::new();
    let mut people: Vec<(Value, BTreeMap<String, Value>)> = Vec::new();
    for row in 0..long.rows.len() {
        let text = |name: &str| long.cell(row, name).as_str().unwrap_or_default().to_owned();
        let who = long.cell(row, "participant_id");
        if people.last().is_none_or(|(last, _)| last != who) {
            let cells =
                PERSONAL.iter().map(|name| ((*name).to_owned(), long.cell(row, name).clone()));
            people.push((who.clone(), cells.collect()));
        }
        let (trial, response) = (text("trial_id"), text("response_id"));
        let name = if text("trial_type") == "demographics" {
            response.clone()
        } else {
            format!("{trial}.{response}")
        };
        if let Some((_, cells)) = people.last_mut() {
            cells.insert(name.clone(), long.cell(row, "answer").clone());
            cells.insert(format!("{name}.rt"), long.cell(row, "rt").clone());
        }
        answers.entry((trial.clone(), response.clone())).or_insert_with(|| {
            Column::new(&name, ColumnKind::Any, &format!("Answer to {response} in {trial}"))
        });
    }
    for answer in answers.into_values() {
        let rt_name = format!("{}.rt", answer.name);
        let mut rt =
            Column::new(&rt_name, ColumnKind::Number, "Response time of the column before");
        rt.unit = Some("ms".to_owned());
        columns.extend([answer, rt]);
    }
    let rows = people
        .into_iter()
        .map(|(_, mut cells)| {
            columns.iter().map(|column| cells.remove(&column.name).unwrap_or(Value::Null)).collect()
        })
        .collect();
    Table { columns, rows }
}
