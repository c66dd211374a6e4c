//! Rows of all versions of a study under the columns of all versions.

use mimique_session::rows::{Column, Table};
use mimique_study::columns::{ColumnKind, EXCLUSION_COLUMNS};
use serde_json::Value;

/// Rows of all versions under the columns of all versions.
#[derive(Default)]
pub(crate) struct Merged {
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<Value>>,
    pub participants: usize,
    /// Place of the first of the two columns on exclusion.
    exclusion: Option<usize>,
}

impl Merged {
    /// A table as it is, with the columns on exclusion and nobody excluded.
    pub fn of_everybody(table: Table, participants: usize) -> Self {
        let mut merged = Self { participants, ..Self::default() };
        merged.columns = table.columns;
        merged.add_exclusion_columns();
        for mut row in table.rows {
            row.resize(merged.columns.len(), Value::Null);
            merged.write_exclusion(&mut row, None);
            merged.rows.push(row);
        }
        merged
    }

    /// Adds the two columns that the researcher decides on, at the end.
    pub(super) fn add_exclusion_columns(&mut self) {
        self.exclusion = Some(self.columns.len());
        self.columns.extend(exclusion_columns());
    }

    /// Writes whether the participant of a row is excluded, and why.
    pub(super) fn write_exclusion(&self, row: &mut [Value], reason: Option<&str>) {
        let Some(place) = self.exclusion else { return };
        row[place] = reason.is_some().into();
        row[place + 1] = reason.map_or(Value::Null, Value::from);
    }

    /// Adds the columns that are not there yet, at the end.
    pub(super) fn add_columns(&mut self, columns: &[Column]) {
        for column in columns {
            if !self.columns.iter().any(|known| known.name == column.name) {
                self.columns.push(column.clone());
            }
        }
    }
}

/// Whether the researcher excluded the participant, and why.
fn exclusion_columns() -> [Column; 2] {
    let column = |name: &str, kind, description: &str| Column {
        name: name.to_owned(),
        description: description.to_owned(),
        kind,
        unit: None,
        levels: Vec::new(),
    };
    [
        column(
            EXCLUSION_COLUMNS[0],
            ColumnKind::Boolean,
            "Whether the researcher excluded the participant; every answer is kept",
        ),
        column(
            EXCLUSION_COLUMNS[1],
            ColumnKind::Text,
            "Why the researcher excluded the participant",
        ),
    ]
}
