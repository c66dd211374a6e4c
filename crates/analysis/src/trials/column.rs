//! A column of the tidy export: its cells as text or numbers, or why they are not.

use mimique_stats::{Table, parse_number};

use crate::trials::error::ExportError;

/// The cells of a column, if the table has it.
pub(crate) struct Column<'t> {
    table: &'t Table,
    name: String,
    place: Option<usize>,
}

impl<'t> Column<'t> {
    pub(crate) fn of(table: &'t Table, name: &str) -> Self {
        Self { table, name: name.to_owned(), place: table.position(name).ok() }
    }

    /// Whether the export has it.
    pub(crate) fn is_there(&self) -> bool {
        self.place.is_some()
    }

    pub(crate) fn text(&self, row: usize) -> Option<&'t str> {
        self.table.cell(row, self.place?)
    }

    pub(crate) fn needed(&self, row: usize) -> Result<&'t str, ExportError> {
        self.text(row).ok_or_else(|| ExportError::Blank {
            column: self.name.clone(),
            line: self.table.line(row),
        })
    }

    pub(crate) fn number(&self, row: usize) -> Result<Option<f64>, ExportError> {
        let Some(cell) = self.text(row) else { return Ok(None) };
        parse_number(cell, true).map(Some).ok_or_else(|| {
            let (column, line) = (self.name.clone(), self.table.line(row));
            ExportError::NotANumber { column, line, cell: cell.to_owned() }
        })
    }
}
