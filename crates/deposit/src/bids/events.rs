//! `*_events.tsv`: what was shown and answered, in seconds after the opening of the session.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::rows::Column;
use serde_json::{Map, Value, json};

use super::meaning;
use super::tsv::{cell, line, seconds};
use crate::responses::Responses;

/// Columns of the export that events have as they are, where the export has them.
const AS_THEY_ARE: [&str; 6] =
    ["trial_id", "trial_index", "condition", "stimulus", "beside", "beside_side"];
/// The same of answers alone.
const OF_ANSWERS: [&str; 4] = ["response_id", "answer", "truth", "correct"];

/// One event of a person.
struct Event {
    onset_s: f64,
    duration_s: Option<f64>,
    kind: &'static str,
    phase: String,
    response_time_s: Option<f64>,
    as_they_are: Vec<String>,
    of_answers: Vec<String>,
}

/// The factors of the clips that an export has: the columns between `stimulus` and `beside`.
pub(super) fn factor_columns(
    responses: &Responses,
    known: &BTreeMap<String, Column>,
) -> Vec<String> {
    let columns = responses.columns();
    let place = |name| responses.column(name).unwrap_or(columns.len());
    let (from, to) = (place("stimulus") + 1, place("beside"));
    let own = columns.get(from..to).unwrap_or_default().iter();
    own.filter(|name| known.contains_key(*name)).cloned().collect()
}

/// The table of each participant, in the order of their identifiers.
pub(super) fn tables(
    responses: &Responses,
    factors: &[String],
    durations: &BTreeMap<&str, f64>,
) -> Vec<(String, Vec<u8>)> {
    let carried = carried(responses, factors);
    let answers = present(responses, &OF_ANSWERS);
    let table = |(person, rows): (&str, Vec<usize>)| {
        let mut events = Vec::new();
        let mut told = BTreeSet::new();
        for row in rows {
            let shown = responses.cell(row, "stimulus");
            // A panel has several clips in one trial.
            if told.insert((responses.cell(row, "trial_index"), shown)) {
                events.extend(shown_event(responses, row, &carried, &answers, durations));
            }
            if !responses.cell(row, "response_id").is_empty() {
                events.extend(answer_event(responses, row, &carried, &answers));
            }
        }
        events.sort_by(|left: &Event, right| left.onset_s.total_cmp(&right.onset_s));
        let mut text = line(&header(&carried, &answers));
        events.into_iter().for_each(|event| text.push_str(&line(&event.cells())));
        (person.to_owned(), text.into_bytes())
    };
    responses.by_person().into_iter().map(table).collect()
}

/// What every column of the tables means.
pub(super) fn sidecar(known: &BTreeMap<String, Column>, factors: &[String]) -> Value {
    let mut entries = Map::new();
    let mut add = |name: &str, value: Value| drop(entries.insert(name.to_owned(), value));
    add(
        "onset",
        json!({
            "Description": "First frame of the clip, showing of the page, or last change of the answer, after the opening of the session",
            "Units": "s",
        }),
    );
    add(
        "duration",
        json!({
            "Description": "How long the clip is, or the page was shown; 0 of an answer",
            "Units": "s",
        }),
    );
    add(
        "trial_type",
        json!({
            "Description": "What happens",
            "Levels": {
                "stimulus": "A clip is shown",
                "page": "A page with questions is shown",
                "response": "A question is answered",
            },
        }),
    );
    add(
        "response_time",
        json!({
            "Description": "Of an answer: from the first frame of the first whole play (of a page: from its showing) to its last change",
            "Units": "s",
        }),
    );
    add(
        "phase",
        json!({ "Description": "trial, training, demographics, questionnaire, or screening" }),
    );
    let all = AS_THEY_ARE.into_iter().chain(OF_ANSWERS);
    for name in all.chain(factors.iter().map(String::as_str)) {
        if let Some(column) = known.get(name) {
            add(name, meaning(column));
        }
    }
    Value::Object(entries)
}

/// Columns that stand in every event.
fn carried(responses: &Responses, factors: &[String]) -> Vec<String> {
    let mut names = present(responses, &AS_THEY_ARE);
    names.extend(factors.iter().cloned());
    names
}

fn present(responses: &Responses, names: &[&str]) -> Vec<String> {
    let there = names.iter().filter(|name| responses.column(name).is_some());
    there.map(|name| (*name).to_owned()).collect()
}

fn header(carried: &[String], answers: &[String]) -> Vec<String> {
    let own = ["onset", "duration", "trial_type", "response_time", "phase"].map(str::to_owned);
    own.into_iter().chain(carried.iter().chain(answers).cloned()).collect()
}

impl Event {
    fn cells(self) -> Vec<String> {
        let mut cells = vec![
            seconds(Some(self.onset_s)),
            seconds(self.duration_s),
            self.kind.to_owned(),
            seconds(self.response_time_s),
            cell(&self.phase),
        ];
        cells.extend(self.as_they_are);
        cells.extend(self.of_answers);
        cells
    }
}

/// When a trial or page was shown, in seconds: its first frame, else its beginning.
fn onset_s(responses: &Responses, row: usize) -> Option<f64> {
    let number = |name: &str| responses.cell(row, name).parse::<f64>().ok();
    let begun = || Some(number("time_elapsed")? - number("duration")?);
    Some(number("onset_ms").or_else(begun)? / 1e3)
}

/// The event of a clip or of a page; none whose time is not known.
fn shown_event(
    responses: &Responses,
    row: usize,
    carried: &[String],
    answers: &[String],
    durations: &BTreeMap<&str, f64>,
) -> Option<Event> {
    let stimulus = responses.cell(row, "stimulus");
    let of_page = || Some(responses.cell(row, "duration").parse::<f64>().ok()? / 1e3);
    let (kind, duration_s) = match stimulus {
        "" => ("page", of_page()),
        clip => ("stimulus", durations.get(clip).copied()),
    };
    Some(Event {
        onset_s: onset_s(responses, row)?,
        duration_s,
        kind,
        phase: responses.cell(row, "trial_type").to_owned(),
        response_time_s: None,
        as_they_are: carried.iter().map(|name| cell(responses.cell(row, name))).collect(),
        of_answers: vec!["n/a".to_owned(); answers.len()],
    })
}

/// The event of an answer; none whose time is not known.
fn answer_event(
    responses: &Responses,
    row: usize,
    carried: &[String],
    answers: &[String],
) -> Option<Event> {
    let time_s = responses.cell(row, "rt").parse::<f64>().ok().map(|time| time / 1e3);
    let shown_s = onset_s(responses, row)?;
    let values = |names: &[String]| -> Vec<String> {
        names.iter().map(|name| cell(responses.cell(row, name))).collect()
    };
    Some(Event {
        onset_s: shown_s + time_s.unwrap_or_default(),
        duration_s: Some(0.0),
        kind: "response",
        phase: responses.cell(row, "trial_type").to_owned(),
        response_time_s: time_s,
        as_they_are: values(carried),
        of_answers: values(answers),
    })
}
