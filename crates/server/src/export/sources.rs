//! What an export is made from, and the tables over all versions and sessions of a study.

use std::collections::BTreeMap;

use mimique_session::rows::{self, Column, Table};
use mimique_session::wire::SessionStarted;
use mimique_storage::{SessionRecord, Storage, StorageError, StudyVersion};
use mimique_study::ClipSource;
use mimique_study::Study;
use mimique_study::columns::ColumnKind;
use serde_json::Value;

use super::error::ExportError;
use super::merged::Merged;

/// What an export is made from: versions, sessions, identifiers. Events are read session by session.
pub(crate) struct Sources {
    pub study_id: String,
    pub versions: Vec<Version>,
    pub sessions: Vec<SessionRecord>,
    identifiers: Option<Identifiers>,
    /// Reason of each exclusion that counts now, by session key.
    excluded: BTreeMap<i64, String>,
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
        let mut excluded = BTreeMap::new();
        for change in storage.exclusions(study_id).await? {
            match change.reason {
                Some(reason) => excluded.insert(change.session_key, reason),
                None => excluded.remove(&change.session_key),
            };
        }
        Ok(Self { study_id: study_id.to_owned(), versions, sessions, identifiers, excluded })
    }

    /// A study of one version whose sessions lie elsewhere.
    pub fn without_storage(study_id: String, version: Version) -> Self {
        Self {
            study_id,
            versions: vec![version],
            sessions: Vec::new(),
            identifiers: None,
            excluded: BTreeMap::new(),
        }
    }

    /// Reason of each exclusion that counts now, by session key.
    pub fn excluded(&self) -> &BTreeMap<i64, String> {
        &self.excluded
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
        let mut merged = self.tidy_columns();
        for session in &self.sessions {
            self.add_tidy(storage, session, &mut merged).await?;
        }
        Ok(merged)
    }

    /// The tidy table without rows.
    pub fn tidy_columns(&self) -> Merged {
        let mut merged = Merged::default();
        for version in &self.versions {
            merged.add_columns(&rows::tidy(&version.study, &version.clips, []).columns);
        }
        merged.add_exclusion_columns();
        self.add_identifier_columns(&mut merged);
        merged
    }

    /// Adds the rows of a session to the tidy table.
    pub async fn add_tidy(
        &self,
        storage: &Storage,
        session: &SessionRecord,
        merged: &mut Merged,
    ) -> Result<(), ExportError> {
        let version = self.version(&session.config_hash)?;
        let events = storage.counted_events(session.key).await?;
        let started = as_started(session);
        let record = rows::SessionRecord { started: &started, events: &events };
        let table = rows::tidy(&version.study, &version.clips, [record]);
        self.add_rows(merged, &table);
        Ok(())
    }

    /// One row a participant.
    pub async fn wide(&self, storage: &Storage) -> Result<Merged, ExportError> {
        let mut merged = Merged::default();
        let mut tables = Vec::new();
        for version in &self.versions {
            let mut sessions = Vec::new();
            for session in self.sessions.iter().filter(|s| s.config_hash == version.config_hash) {
                let events = storage.counted_events(session.key).await?;
                sessions.push((as_started(session), events));
            }
            let records =
                sessions.iter().map(|(started, events)| rows::SessionRecord { started, events });
            let table = rows::wide(&version.study, &version.clips, records);
            merged.add_columns(&table.columns);
            tables.push(table);
        }
        merged.add_exclusion_columns();
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

    /// The columns of the tidy form.
    pub fn columns(&self) -> Vec<Column> {
        let mut merged = Merged::default();
        for version in &self.versions {
            merged.add_columns(&rows::tidy(&version.study, &version.clips, []).columns);
        }
        merged.add_exclusion_columns();
        merged.columns
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
        // The reason of each excluded participant of the table.
        let excluded: BTreeMap<u64, &str> = self
            .sessions
            .iter()
            .filter_map(|s| Some((s.participant, self.excluded.get(&s.key)?.as_str())))
            .collect();
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
            let mut cells: Vec<Value> = cells.collect();
            let reason = participant.and_then(|number| excluded.get(&number).copied());
            merged.write_exclusion(&mut cells, reason);
            merged.rows.push(cells);
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
        participant_id: mimique_storage::participant_id(session.participant),
        participant: session.participant,
        slot: session.slot,
        condition: session.condition.clone(),
        seed: session.seed,
        stage: session.stage.clone(),
        config_hash: session.config_hash.clone(),
        withdrawal_code: String::new(),
    }
}
