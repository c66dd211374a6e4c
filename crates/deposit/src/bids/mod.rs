//! The answers as a BIDS data set of behaviour without recordings: `sub-*/beh/*_events.tsv` on one clock a participant,
//! `participants.tsv`, and a sidecar that says what every column means.

mod events;
mod participants;
mod tsv;

use std::collections::BTreeMap;

use mimique_session::rows::Column;
use serde_json::{Map, Value, json};

use crate::about::{About, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::file::{DepositFile, NotWritten, json_bytes};
use crate::responses::Responses;
use crate::stimuli::StimulusRow;

/// Its folder in the deposit.
pub const FOLDER: &str = "bids";

/// The version of the specification that the files follow.
const BIDS_VERSION: &str = "1.10.0";

/// The files of the data set.
pub(crate) fn files(
    about: &About,
    responses: &Responses,
    known: &BTreeMap<String, Column>,
    stimuli: &[StimulusRow],
    people: &[String],
) -> Result<Vec<DepositFile>, NotWritten> {
    let task = label(&about.study);
    let factors = events::factor_columns(responses, known);
    let mut made = Vec::new();
    let mut add = |path: String, bytes: Vec<u8>| {
        made.push(DepositFile::made(format!("{FOLDER}/{path}"), bytes));
    };
    add("dataset_description.json".to_owned(), json_bytes(&description(about))?);
    add("README.md".to_owned(), readme(about, &task).into_bytes());
    add(format!("task-{task}_events.json"), json_bytes(&events::sidecar(known, &factors))?);
    let (table, sidecar) = participants::table(responses, known, people);
    add("participants.tsv".to_owned(), table);
    add("participants.json".to_owned(), json_bytes(&sidecar)?);
    let durations: BTreeMap<&str, f64> =
        (stimuli.iter()).filter_map(|row| Some((&*row.clip, row.duration_ms? / 1e3))).collect();
    for (person, table) in events::tables(responses, &factors, &durations) {
        let subject = label(&person);
        add(format!("sub-{subject}/beh/sub-{subject}_task-{task}_events.tsv"), table);
    }
    Ok(made)
}

/// What is between `sub-` and `_`: letters and digits alone.
fn label(text: &str) -> String {
    text.chars().filter(char::is_ascii_alphanumeric).collect()
}

fn description(about: &About) -> Value {
    let authors: Vec<String> = about.authors.iter().map(crate::Author::said_name).collect();
    json!({
        "Name": about.title,
        "BIDSVersion": BIDS_VERSION,
        "DatasetType": "raw",
        "License": about.data_licence.spdx,
        "Authors": authors,
        "GeneratedBy": [{
            "Name": "Mimique",
            "Version": SOFTWARE_VERSION,
            "CodeURL": SOFTWARE_REPOSITORY,
        }],
    })
}

fn readme(about: &About, task: &str) -> String {
    format!(
        "# {}\n\n{}\n\n\
         Behaviour of {} participants without recordings, as BIDS {BIDS_VERSION} has it: a table of events for each\n\
         participant (`sub-*/beh/*_task-{task}_events.tsv`), in seconds after the opening of the session. A clip is a row\n\
         (`trial_type` is `stimulus`), a page with questions (`page`), and each answer (`response`), whose onset is its last\n\
         change; what has no time stands in `../psych-ds` alone. `task-{task}_events.json` and `participants.json` say what every column means. The same answers stand in\n\
         `../psych-ds`, with all columns.\n",
        about.title, about.description, about.participants
    )
}

/// What a column means, as a sidecar has it.
fn meaning(column: &Column) -> Value {
    let mut entry = Map::new();
    entry.insert("Description".to_owned(), column.description.as_str().into());
    if let Some(unit) = &column.unit {
        entry.insert("Units".to_owned(), unit.as_str().into());
    }
    if !column.levels.is_empty() {
        let level = |(value, meaning): &(Value, String)| {
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            let meaning = if meaning.is_empty() { value.clone() } else { meaning.clone() };
            (value, Value::from(meaning))
        };
        entry.insert("Levels".to_owned(), Value::Object(column.levels.iter().map(level).collect()));
    }
    Value::Object(entry)
}

#[cfg(test)]
mod tests {
    #[test]
    fn labels_are_letters_and_digits() {
        assert_eq!(super::label("jnd-alpha.2"), "jndalpha2");
    }
}
