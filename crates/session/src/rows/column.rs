//! Tables: columns that explain themselves, and rows.

use mimique_study::columns::ColumnKind;
use serde::Serialize;
use serde_json::Value;

/// A column and what it means.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Column {
    /// Its name in the first line of the file.
    pub name: String,
    /// What it means.
    pub description: String,
    /// What it holds.
    pub kind: ColumnKind,
    /// Unit of its numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Value and meaning, where they are few and known beforehand.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<(Value, String)>,
}

impl Column {
    pub(super) fn new(name: &str, kind: ColumnKind, description: &str) -> Self {
        Self {
            name: name.to_owned(),
            description: description.to_owned(),
            kind,
            unit: None,
            levels: Vec::new(),
        }
    }
}

/// Columns and rows; a cell without value is `Value::Null`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// The columns, in the order they are written.
    pub columns: Vec<Column>,
    /// The rows; each as long as there are columns.
    pub rows: Vec<Vec<Value>>,
}

impl Table {
    /// Place of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The cell of a row by the column's name; null where there is no such column.
    pub fn cell(&self, row: usize, name: &str) -> &Value {
        self.column(name).and_then(|column| self.rows.get(row)?.get(column)).unwrap_or(&Value::Null)
    }
}
