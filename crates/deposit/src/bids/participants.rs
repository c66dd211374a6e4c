//! `participants.tsv`: a row for each person, what they said of themselves, how their session stands.

use std::collections::BTreeMap;

use mimique_session::rows::Column;
use mimique_study::columns::{ASSIGNED_CONDITION, EXCLUSION_COLUMNS};
use serde_json::{Map, Value, json};

use super::tsv::{cell, line};
use super::{label, meaning};
use crate::responses::Responses;

/// Columns of every export that say something of a person.
const OF_PEOPLE: [&str; 5] =
    ["stage", "status", ASSIGNED_CONDITION, "language", EXCLUSION_COLUMNS[0]];

/// The table, and its sidecar. `of_people` are the columns of the study's questions about people.
pub(super) fn table(
    responses: &Responses,
    known: &BTreeMap<String, Column>,
    of_people: &[String],
) -> (Vec<u8>, Value) {
    let names: Vec<&str> = (OF_PEOPLE.into_iter())
        .chain(of_people.iter().map(String::as_str))
        .filter(|name| responses.column(name).is_some())
        .collect();
    let head = std::iter::once("participant_id").chain(names.iter().copied());
    let mut text = line(&head.map(str::to_owned).collect::<Vec<_>>());
    for (person, rows) in responses.by_person() {
        // The same in every row but where there is nothing to be said.
        let value = |name: &&str| {
            let mut values = rows.iter().map(|row| responses.cell(*row, name));
            cell(values.find(|value| !value.is_empty()).unwrap_or_default())
        };
        let mut cells = vec![format!("sub-{}", label(person))];
        cells.extend(names.iter().map(value));
        text.push_str(&line(&cells));
    }
    let mut sidecar = Map::new();
    sidecar.insert(
        "participant_id".to_owned(),
        json!({ "Description": "Public identifier of the participant" }),
    );
    for name in names {
        if let Some(column) = known.get(name) {
            sidecar.insert(name.to_owned(), meaning(column));
        }
    }
    (text.into_bytes(), Value::Object(sidecar))
}
