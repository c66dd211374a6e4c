//! Tables as CSV: comma, quotes where needed, one line break (LF) a row, empty where there is no value.

use std::borrow::Cow;

use mimique_session::rows::Column;
use mimique_study::columns::ColumnKind;
use serde_json::Value;

use super::error::ExportError;

/// The lines below the header, with such cells.
pub(super) fn lines(rows: &[Vec<Value>], cells: Cells) -> Result<Vec<u8>, ExportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        for value in row {
            let cell = match cells {
                Cells::AsTheyAre => cell(value),
                Cells::Neutralised => neutral(value),
            };
            writer.write_field(&*cell).map_err(form)?;
        }
        writer.write_record(None::<&[u8]>).map_err(form)?;
    }
    writer.into_inner().map_err(|error| ExportError::Form(error.to_string()))
}

/// Columns as rows: name, kind, unit, levels, description.
pub(super) fn dictionary(columns: &[Column]) -> Result<Vec<u8>, ExportError> {
    let head = ["name", "kind", "unit", "levels", "description"].map(str::to_owned);
    let rows = columns.iter().map(|column| {
        let kind = match column.kind {
            ColumnKind::Text => "text",
            ColumnKind::Integer => "integer",
            ColumnKind::Number => "number",
            ColumnKind::Boolean => "boolean",
            ColumnKind::Time => "time",
            ColumnKind::Any => "any",
        };
        let levels =
            column.levels.iter().map(|(value, meaning)| format!("{}={meaning}", cell(value)));
        [
            column.name.clone(),
            kind.to_owned(),
            column.unit.clone().unwrap_or_default(),
            levels.collect::<Vec<_>>().join("|"),
            column.description.clone(),
        ]
    });
    records([head].into_iter().chain(rows).map(|row| row.into_iter()))
}

/// The first line of a CSV file.
pub(super) fn header(columns: &[Column]) -> Result<Vec<u8>, ExportError> {
    header_of(columns.iter().map(|column| column.name.as_str()))
}

/// The same of columns by their names.
pub(super) fn header_of<'n>(names: impl Iterator<Item = &'n str>) -> Result<Vec<u8>, ExportError> {
    records(std::iter::once(names.map(str::to_owned)))
}

fn records(
    rows: impl Iterator<Item = impl Iterator<Item = String>>,
) -> Result<Vec<u8>, ExportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(form)?;
    }
    writer.into_inner().map_err(|error| ExportError::Form(error.to_string()))
}

fn form(error: csv::Error) -> ExportError {
    ExportError::Form(error.to_string())
}

/// How cells of a CSV file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cells {
    /// As they were answered: what scripts need.
    #[default]
    AsTheyAre,
    /// Texts that a spreadsheet would take for a formula (they begin with `=`, `+`, `-`, `@`, also in
    /// their full width of East Asian keyboards, a tabulator or a line break) get an apostrophe before them; numbers stay as they are.
    Neutralised,
}

/// First characters of what spreadsheets compute; those of full width are read like the plain ones.
const FORMULA_STARTS: [char; 11] =
    ['=', '+', '-', '@', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}', '\t', '\r', '\n'];

fn neutral(value: &Value) -> Cow<'_, str> {
    let text = cell(value);
    let is_text = value.is_string() && text.parse::<f64>().is_err();
    if is_text && text.starts_with(FORMULA_STARTS) {
        return format!("'{text}").into();
    }
    text
}

fn cell(value: &Value) -> Cow<'_, str> {
    match value {
        Value::Null => "".into(),
        Value::String(text) => text.as_str().into(),
        other => other.to_string().into(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn formulas_are_neutralised_and_numbers_are_not() {
        for (given, written) in [
            (json!("=1+1"), "'=1+1"),
            (json!("+cmd"), "'+cmd"),
            (json!("-2+3"), "'-2+3"),
            (json!("@sum"), "'@sum"),
            (json!("\t=1"), "'\t=1"),
            (json!("\u{ff1d}1+1"), "'\u{ff1d}1+1"),
            (json!("\u{ff0b}1"), "'\u{ff0b}1"),
            (json!("\u{ff0d}1"), "'\u{ff0d}1"),
            (json!("\u{ff20}sum"), "'\u{ff20}sum"),
            (json!("-2.5"), "-2.5"),
            (json!(-2.5), "-2.5"),
            (json!("a=1"), "a=1"),
            (Value::Null, ""),
        ] {
            assert_eq!(neutral(&given), written, "{given}");
        }
    }
}
