//! The table of a study's responses over all its versions and sessions, and its CSV form.

use std::collections::BTreeMap;

use mimique_study::Study;
use mimique_study::responses::{self, Column, ColumnKind, Table};
use mimique_study::wire::{ClipSource, Event, SessionStarted};
use serde_json::Value;

use super::ExportError;
use crate::storage::{SessionRecord, Status, Storage, StorageError, StudyVersion};

/// What an export is made from: versions, sessions, identifiers. Events are read session by session.
pub(crate) struct Sources {
    pub study_id: String,
    pub versions: Vec<Version>,
    pub sessions: Vec<SessionRecord>,
    identifiers: Option<Identifiers>,
}

/// A version of the study, read.
pub(crate) struct Version {
    pub config_hash: String,
    pub file: Value,
    pub study: Study,
    pub clips: BTreeMap<String, ClipSource>,
}

impl Version {
    /// Reads a stored version.
    pub fn read(stored: &StudyVersion) -> Result<Self, StorageError> {
        let damaged = |problem: String| StorageError::Damaged { table: "study_versions", problem };
        let file: Value = serde_json::from_str(&stored.file).map_err(|e| damaged(e.to_string()))?;
        let clips = serde_json::from_str(&stored.clips).map_err(|e| damaged(e.to_string()))?;
        let study = Study::from_value(&file).map_err(|error| {
            damaged(format!("study {}, {}: {error}", stored.study_id, stored.config_hash))
        })?;
        Ok(Self { config_hash: stored.config_hash.clone(), file, study, clips })
    }
}

/// Recruitment identifiers: their names, and their values by participant.
struct Identifiers {
    names: Vec<String>,
    values: BTreeMap<(u64, String), String>,
}

/// Rows of all versions under the columns of all versions.
pub(crate) struct Merged {
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<Value>>,
    pub participants: usize,
}

impl Sources {
    pub async fn load(
        storage: &Storage,
        study_id: &str,
        with_identifiers: bool,
    ) -> Result<Self, ExportError> {
        let versions = storage.study_versions().await?;
        let versions = versions
            .iter()
            .filter(|version| version.study_id == study_id)
            .map(Version::read)
            .collect::<Result<_, _>>()?;
        let identifiers = match with_identifiers {
            true => Some(Identifiers::load(storage, study_id).await?),
            false => None,
        };
        let sessions = storage.sessions(study_id).await?;
        Ok(Self { study_id: study_id.to_owned(), versions, sessions, identifiers })
    }

    /// A study of one version whose sessions lie elsewhere.
    pub fn without_storage(study_id: String, version: Version) -> Self {
        Self { study_id, versions: vec![version], sessions: Vec::new(), identifiers: None }
    }

    /// The version that is served now, or was served last.
    pub fn latest(&self) -> Result<&Version, ExportError> {
        self.versions.last().ok_or_else(|| ExportError::UnknownStudy {
            id: self.study_id.clone(),
            known: "none".into(),
        })
    }

    pub fn version(&self, config_hash: &str) -> Result<&Version, ExportError> {
        self.versions.iter().find(|version| version.config_hash == config_hash).ok_or_else(|| {
            ExportError::MissingVersion {
                id: self.study_id.clone(),
                config_hash: config_hash.to_owned(),
            }
        })
    }

    /// One row a participant x trial x response.
    pub async fn tidy(&self, storage: &Storage) -> Result<Merged, ExportError> {
        let mut merged = self.merged();
        for version in &self.versions {
            merged.add_columns(&responses::tidy(&version.study, &version.clips, []).columns);
        }
        self.add_identifier_columns(&mut merged);
        for session in &self.sessions {
            let version = self.version(&session.config_hash)?;
            let events = storage.events(session.key).await?;
            let started = as_started(session);
            let record = response_session(&started, session, &events);
            let table = responses::tidy(&version.study, &version.clips, [record]);
            self.add_rows(&mut merged, &table);
        }
        Ok(merged)
    }

    /// One row a participant.
    pub async fn wide(&self, storage: &Storage) -> Result<Merged, ExportError> {
        let mut merged = self.merged();
        let mut tables = Vec::new();
        for version in &self.versions {
            let mut sessions = Vec::new();
            for session in self.sessions.iter().filter(|s| s.config_hash == version.config_hash) {
                let events = storage.events(session.key).await?;
                sessions.push((as_started(session), session, events));
            }
            let records = sessions
                .iter()
                .map(|(started, session, events)| response_session(started, session, events));
            let table = responses::wide(&version.study, &version.clips, records);
            merged.add_columns(&table.columns);
            tables.push(table);
        }
        self.add_identifier_columns(&mut merged);
        for table in &tables {
            self.add_rows(&mut merged, table);
        }
        let number = merged.columns.iter().position(|column| column.name == "participant");
        if let Some(number) = number {
            merged.rows.sort_by_key(|row| row[number].as_u64());
        }
        Ok(merged)
    }

    fn merged(&self) -> Merged {
        Merged { columns: Vec::new(), rows: Vec::new(), participants: 0 }
    }

    fn add_identifier_columns(&self, merged: &mut Merged) {
        let names = self.identifiers.iter().flat_map(|identifiers| &identifiers.names);
        let columns: Vec<Column> = names
            .map(|name| Column {
                name: name.clone(),
                description: "Recruitment identifier".to_owned(),
                kind: ColumnKind::Text,
                unit: None,
                levels: Vec::new(),
            })
            .collect();
        merged.add_columns(&columns);
    }

    fn add_rows(&self, merged: &mut Merged, table: &Table) {
        let places: Vec<Option<usize>> =
            merged.columns.iter().map(|column| table.column(&column.name)).collect();
        let mut last_participant = None;
        for (index, row) in table.rows.iter().enumerate() {
            let participant = table.cell(index, "participant").as_u64();
            if participant != last_participant {
                merged.participants += 1;
                last_participant = participant;
            }
            let identifier = |name: &str| {
                let values = &self.identifiers.as_ref()?.values;
                values.get(&(participant?, name.to_owned())).map(|value| value.as_str().into())
            };
            let cells = merged.columns.iter().zip(&places).map(|(column, place)| match place {
                Some(place) => row[*place].clone(),
                None => identifier(&column.name).unwrap_or(Value::Null),
            });
            merged.rows.push(cells.collect());
        }
    }
}

impl Merged {
    /// Adds the columns that are not there yet, at the end.
    fn add_columns(&mut self, columns: &[Column]) {
        for column in columns {
            if !self.columns.iter().any(|known| known.name == column.name) {
                self.columns.push(column.clone());
            }
        }
    }
}

impl Identifiers {
    async fn load(storage: &Storage, study_id: &str) -> Result<Self, ExportError> {
        let entries = storage.recruitment(study_id).await?;
        let mut names: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
        names.sort();
        names.dedup();
        let values = entries.into_iter().map(|e| ((e.participant, e.name), e.value)).collect();
        Ok(Self { names, values })
    }
}

/// The session as `study` knows it, without its secrets.
pub(crate) fn as_started(session: &SessionRecord) -> SessionStarted {
    SessionStarted {
        session: String::new(),
        participant_id: crate::participant_id(session.participant),
        participant: session.participant,
        seed: session.seed,
        stage: session.stage.clone(),
        config_hash: session.config_hash.clone(),
        withdrawal_code: String::new(),
    }
}

/// A session and its events as `study` reads them. That a session is complete is the server's word
/// only together with the page's: one that was declined has a receipt too.
fn response_session<'a>(
    started: &'a SessionStarted,
    session: &SessionRecord,
    events: &'a [Event],
) -> responses::SessionRecord<'a> {
    let status = (session.status == Status::Withdrawn).then_some("withdrawn");
    responses::SessionRecord { started, events, status }
}

/// A table as CSV: comma, quotes where needed, one line break (LF) a row, empty where there is no value.
pub(super) fn csv(table: &Merged) -> Result<Vec<u8>, ExportError> {
    let mut bytes = csv_header(&table.columns)?;
    bytes.extend(csv_rows(&table.rows)?);
    Ok(bytes)
}

/// The first line of a CSV file.
pub(super) fn csv_header(columns: &[Column]) -> Result<Vec<u8>, ExportError> {
    records(std::iter::once(columns.iter().map(|column| column.name.clone())))
}

/// The lines below it.
pub(super) fn csv_rows(rows: &[Vec<Value>]) -> Result<Vec<u8>, ExportError> {
    records(rows.iter().map(|row| row.iter().map(cell)))
}

fn records(
    rows: impl Iterator<Item = impl Iterator<Item = String>>,
) -> Result<Vec<u8>, ExportError> {
    let form = |error: csv::Error| ExportError::Form(error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(form)?;
    }
    writer.into_inner().map_err(|error| ExportError::Form(error.to_string()))
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
