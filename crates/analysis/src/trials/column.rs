//! A column of the tidy export: its cells as text or numbers, or why they are not.

use mimique_stats::{Refusal, Table, parse_number};

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

    pub(crate) fn needed(&self, row: usize) -> Result<&'t str, Refusal> {
        self.text(row).ok_or_else(|| {
            let problem = format!("line {}: the cell is blank", self.table.line(row));
            Refusal::column(&self.name, problem, "export the study again")
        })
    }

    pub(crate) fn number(&self, row: usize) -> Result<Option<f64>, Refusal> {
        let Some(cell) = self.text(row) else { return Ok(None) };
        parse_number(cell, true).map(Some).ok_or_else(|| {
            let problem = format!("line {}: \"{cell}\" is not a number", self.table.line(row));
            Refusal::column(&self.name, problem, "export the study again")
        })
    }
}
