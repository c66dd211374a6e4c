//! The wide form: one row a participant, one column a trial x response.

use std::collections::BTreeMap;

use serde_json::Value;

use super::SessionRecord;
use super::column::{Column, Table};
use super::tidy::TidyForm;
use crate::record::Record;
use crate::wire::SessionStarted;
use mimique_study::columns::{ASSIGNED_CONDITION, ColumnKind};
use mimique_study::{ClipSource, Study};

/// Columns of the tidy form that are the same in all rows of a participant.
const PERSONAL: [&str; 13] = [
    "participant_id",
    "participant",
    "slot",
    ASSIGNED_CONDITION,
    "stage",
    "status",
    "language",
    "consent_version",
    "sound_check",
    "sound_check_correct",
    "sound_check_attempts",
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
    let mut form = WideForm::new(study, clips);
    let record = |session: SessionRecord<'a>| (session.started, Record::of(None, session.events));
    let sessions: Vec<_> = sessions.into_iter().map(record).collect();
    sessions.iter().for_each(|(_, record)| form.look_at(record));
    let rows = sessions.iter().filter_map(|(started, record)| form.row(started, record)).collect();
    Table { columns: form.columns(), rows }
}

/// The wide form of a version of a study. Which columns it has, all sessions say: they are looked at first.
#[derive(Debug, Clone)]
pub struct WideForm {
    tidy: TidyForm,
    /// Name of the column of each trial and response.
    answers: BTreeMap<(String, String), String>,
}

impl WideForm {
    /// The form of a version of a study and its clips as they were prepared, without a session.
    pub fn new(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Self {
        Self { tidy: TidyForm::new(study, clips), answers: BTreeMap::new() }
    }

    /// Makes columns for the answers of a record. What was measured of plays is not asked for.
    pub fn look_at(&mut self, record: &Record) {
        for (trial, response, is_demographics) in self.tidy.responses(record) {
            self.answers
                .entry((trial, response))
                .or_insert_with_key(|(trial, response)| name(trial, response, is_demographics));
        }
    }

    /// The columns that two forms have, of the same version.
    pub fn join(&mut self, other: Self) {
        self.answers.extend(other.answers);
    }

    /// The columns of the rows.
    pub fn columns(&self) -> Vec<Column> {
        let known = self.tidy.columns();
        let personal = PERSONAL.iter().filter_map(|name| known.iter().find(|c| c.name == *name));
        let mut columns: Vec<Column> = personal.cloned().collect();
        for ((trial, response), name) in &self.answers {
            let about = format!("Answer to {response} in {trial}");
            let mut rt = Column::new(
                &format!("{name}.rt"),
                ColumnKind::Number,
                "Response time of the column before",
            );
            rt.unit = Some("ms".to_owned());
            columns.extend([Column::new(name, ColumnKind::Any, &about), rt]);
        }
        columns
    }

    /// The row of a session, in the order of [`Self::columns`]; none of who answered nothing. What has no
    /// column, since the record was another one when it was looked at, is left out.
    pub fn row(&self, started: &SessionStarted, record: &Record) -> Option<Vec<Value>> {
        let rows = self.tidy.rows(started, record);
        let first = rows.first()?;
        let personal = PERSONAL.iter().filter_map(|name| self.tidy.place(name));
        let mut cells: Vec<Value> = personal.map(|place| first[place].clone()).collect();
        let places = ["trial_id", "response_id", "answer", "rt"].map(|name| self.tidy.place(name));
        let [Some(trial), Some(response), Some(answer), Some(rt)] = places else { return None };
        let text = |cell: &'_ Value| cell.as_str().unwrap_or_default().to_owned();
        let given: BTreeMap<(String, String), [&Value; 2]> = rows
            .iter()
            .map(|row| ((text(&row[trial]), text(&row[response])), [&row[answer], &row[rt]]))
            .collect();
        for key in self.answers.keys() {
            let pair = given.get(key).copied().unwrap_or([&Value::Null, &Value::Null]);
            cells.extend(pair.map(Value::clone));
        }
        Some(cells)
    }
}

/// The name of the column of an answer.
fn name(trial: &str, response: &str, is_demographics: bool) -> String {
    if is_demographics { response.to_owned() } else { format!("{trial}.{response}") }
}
