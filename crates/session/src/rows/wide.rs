//! The wide form: one row a participant, one column a trial x response.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::SessionRecord;
use super::column::{Column, Table};
use super::tidy::TidyForm;
use crate::record::Record;
use crate::wire::SessionStarted;
use mimique_study::columns::{ASSIGNED_CONDITION, ColumnKind};
use mimique_study::{ClipSource, KindOfQuestion as _, Study};

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

/// What stands behind the columns of a choice between two clips: the clip on each side, and the one chosen.
const OF_CHOICES: [(&str, &str); 3] = [
    ("left", "Clip on the left where"),
    ("right", "Clip on the right where"),
    ("chosen", "Clip that was chosen where"),
];

/// The wide form: the participant's columns, then `TRIAL.RESPONSE` for each answer (in alphabetical
/// order of trial, so that all participants share one order) and `TRIAL.RESPONSE.rt`; behind an answer that
/// chooses between two clips `TRIAL.RESPONSE.left`, `.right` and `.chosen`, the clips.
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
    /// Column of each trial and response.
    answers: BTreeMap<(String, String), AnswerColumn>,
    /// Questions that choose between two clips.
    choices: BTreeSet<String>,
}

/// The column of an answer.
#[derive(Debug, Clone)]
struct AnswerColumn {
    name: String,
    /// Whether it chooses between two clips.
    is_choice: bool,
}

impl WideForm {
    /// The form of a version of a study and its clips as they were prepared, without a session.
    pub fn new(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Self {
        let choices = study.all_questions().filter(|question| question.kind.compares_clips());
        let choices = choices.map(|question| question.id.clone()).collect();
        Self { tidy: TidyForm::new(study, clips), answers: BTreeMap::new(), choices }
    }

    /// Makes columns for the answers of a record. What was measured of plays is not asked for.
    pub fn look_at(&mut self, record: &Record) {
        for (trial, response, is_demographics) in self.tidy.responses(record) {
            let is_choice = self.choices.contains(&response);
            let column = |(trial, response): &(String, String)| AnswerColumn {
                name: name(trial, response, is_demographics),
                is_choice,
            };
            self.answers.entry((trial, response)).or_insert_with_key(column);
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
        for ((trial, response), AnswerColumn { name, is_choice }) in &self.answers {
            let about = format!("Answer to {response} in {trial}");
            let mut rt = Column::new(
                &format!("{name}.rt"),
                ColumnKind::Number,
                "Response time of the column before",
            );
            rt.unit = Some("ms".to_owned());
            columns.extend([Column::new(name, ColumnKind::Any, &about), rt]);
            let of_choices = OF_CHOICES.iter().filter(|_| *is_choice).map(|(suffix, what)| {
                let about = format!("{what} {response} was asked in {trial}");
                Column::new(&format!("{name}.{suffix}"), ColumnKind::Text, &about)
            });
            columns.extend(of_choices);
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
        let places = ["answer", "rt"].map(|name| self.tidy.place(name));
        let [Some(answer), Some(rt)] = places else { return None };
        // The rows come in the order of the responses.
        let keys = self.tidy.responses(record).into_iter().map(|(trial, kept, _)| (trial, kept));
        let given: BTreeMap<(String, String), &Vec<Value>> = keys.zip(&rows).collect();
        for (key, column) in &self.answers {
            let row = given.get(key);
            let own = |place: usize| row.map_or(Value::Null, |row| row[place].clone());
            cells.extend([own(answer), own(rt)]);
            if column.is_choice {
                let row = row.map(|row| row.as_slice());
                cells.extend(row.map_or([const { Value::Null }; 3], |row| self.sides(row)));
            }
        }
        Some(cells)
    }

    /// The clips on the left and on the right of a row of the tidy form, and the one chosen.
    fn sides(&self, row: &[Value]) -> [Value; 3] {
        let own = |name| self.tidy.place(name).map_or(Value::Null, |place| row[place].clone());
        let [clip, beside, chosen] = ["stimulus", "beside", "chosen"].map(own);
        if own("beside_side") == "left" { [beside, clip, chosen] } else { [clip, beside, chosen] }
    }
}

/// The name of the column of an answer.
fn name(trial: &str, response: &str, is_demographics: bool) -> String {
    if is_demographics { response.to_owned() } else { format!("{trial}.{response}") }
}
