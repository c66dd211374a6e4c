//! The table of an export: its columns over all versions of the study, and how the rows of one session are
//! written under them.

use std::collections::BTreeMap;

use mimique_session::Record;
use mimique_session::rows::{Column, TidyForm, WideForm, exclusion_columns};
use mimique_session::wire::SessionStarted;
use mimique_study::columns::ColumnKind;
use serde_json::Value;

use super::csv::{self, Cells};
use super::error::ExportError;
use super::lines;
use super::sources::Sources;

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Csv(Cells),
    JsonLines,
}

/// The rows of one version of the study.
#[derive(Debug, Clone)]
pub(super) enum Rows {
    /// A row for each response.
    Tidy(TidyForm),
    /// A row for each participant.
    Wide(WideForm),
}

impl Rows {
    fn columns(&self) -> Vec<Column> {
        match self {
            Self::Tidy(form) => form.columns().to_vec(),
            Self::Wide(form) => form.columns(),
        }
    }

    fn of(&self, started: &SessionStarted, record: &Record) -> Vec<Vec<Value>> {
        match self {
            Self::Tidy(form) => form.rows(started, record),
            Self::Wide(form) => form.row(started, record).into_iter().collect(),
        }
    }
}

/// The table of an export.
pub(super) struct Layout {
    study_id: String,
    form: Form,
    columns: Vec<Column>,
    /// Place of the first of the two columns on exclusion.
    exclusion: usize,
    /// Places of the columns with identifiers, and their names.
    identifiers: Vec<(usize, String)>,
    /// Of each version its rows, and where in them each column is.
    versions: BTreeMap<String, (Rows, Vec<Option<usize>>)>,
    /// Places of the columns in alphabetical order, and how their names stand in JSON.
    alphabetical: Vec<(usize, String)>,
}

/// What is known of a participant beside what was answered.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct About {
    /// Why a researcher has excluded them.
    pub excluded: Option<String>,
    /// Recruitment identifiers by name, where they are exported.
    pub identifiers: BTreeMap<String, String>,
}

/// Rows, written.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Lines {
    pub bytes: Vec<u8>,
    pub rows: usize,
}

impl Layout {
    /// The table of these versions in the order of their service; `identifiers` are the names of those that
    /// are exported.
    pub fn new(
        form: Form,
        study_id: &str,
        versions: impl IntoIterator<Item = (String, Rows)>,
        identifiers: &[String],
    ) -> Self {
        let versions: Vec<(String, Rows)> = versions.into_iter().collect();
        let mut columns: Vec<Column> = Vec::new();
        for (_, rows) in &versions {
            add_columns(&mut columns, rows.columns());
        }
        let exclusion = columns.len();
        columns.extend(exclusion_columns());
        add_columns(&mut columns, identifiers.iter().map(|name| identifier_column(name)));
        let place = |name: &str| columns.iter().position(|column| column.name == name);
        let identifiers =
            identifiers.iter().filter_map(|name| Some((place(name)?, name.clone()))).collect();
        let places = |rows: &Rows| -> Vec<Option<usize>> {
            let own = rows.columns();
            let place = |column: &Column| own.iter().position(|own| own.name == column.name);
            columns.iter().map(place).collect()
        };
        let versions = versions
            .into_iter()
            .map(|(hash, rows)| {
                let places = places(&rows);
                (hash, (rows, places))
            })
            .collect();
        let mut alphabetical: Vec<(usize, &str)> =
            columns.iter().map(|column| &*column.name).enumerate().collect();
        alphabetical.sort_by_key(|(_, name)| *name);
        let alphabetical = alphabetical
            .into_iter()
            .map(|(place, name)| (place, Value::from(name).to_string()))
            .collect();
        let study_id = study_id.to_owned();
        Self { study_id, form, columns, exclusion, identifiers, versions, alphabetical }
    }

    /// The tidy table of a study's versions.
    pub fn tidy(form: Form, sources: &Sources, identifiers: &[String]) -> Self {
        let rows = sources.versions.iter().map(|version| {
            let form = TidyForm::new(&version.study, &version.clips);
            (version.config_hash.clone(), Rows::Tidy(form))
        });
        Self::new(form, &sources.study_id, rows, identifiers)
    }

    /// The columns, in their order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// What stands before the rows.
    pub fn header(&self) -> Result<Vec<u8>, ExportError> {
        match self.form {
            Form::Csv(_) => csv::header(&self.columns),
            Form::JsonLines => Ok(Vec::new()),
        }
    }

    /// The rows of a session of one of the versions.
    pub fn lines(
        &self,
        started: &SessionStarted,
        record: &Record,
        about: &About,
    ) -> Result<Lines, ExportError> {
        let hash = &started.config_hash;
        let (form, places) =
            self.versions.get(hash).ok_or_else(|| ExportError::missing(&self.study_id, hash))?;
        let mut rows = form.of(started, record);
        for row in &mut rows {
            let mut cells: Vec<Value> = places
                .iter()
                .map(|place| place.map_or(Value::Null, |place| std::mem::take(&mut row[place])))
                .collect();
            cells[self.exclusion] = about.excluded.is_some().into();
            cells[self.exclusion + 1] = about.excluded.as_deref().into();
            for (place, name) in &self.identifiers {
                if let Some(value) = about.identifiers.get(name) {
                    cells[*place] = value.as_str().into();
                }
            }
            *row = cells;
        }
        let bytes = match self.form {
            Form::Csv(cells) => csv::lines(&rows, cells)?,
            Form::JsonLines => lines::rows(&self.alphabetical, &rows)?,
        };
        Ok(Lines { bytes, rows: rows.len() })
    }
}

/// Adds the columns that are not there yet, at the end.
fn add_columns(columns: &mut Vec<Column>, more: impl IntoIterator<Item = Column>) {
    for column in more {
        if !columns.iter().any(|known| known.name == column.name) {
            columns.push(column);
        }
    }
}

fn identifier_column(name: &str) -> Column {
    Column {
        name: name.to_owned(),
        description: "Recruitment identifier".to_owned(),
        kind: ColumnKind::Text,
        unit: None,
        levels: Vec::new(),
    }
}
