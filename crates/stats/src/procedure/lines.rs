//! Results as lines of text for people.

use mimique_locale::{format_number, format_p};

/// A text that grows by lines.
#[derive(Default)]
pub(crate) struct Lines(String);

impl Lines {
    /// Adds a line, without blanks at its end.
    pub(crate) fn add(&mut self, line: impl AsRef<str>) {
        self.0.push_str(line.as_ref().trim_end());
        self.0.push('\n');
    }

    /// Adds a note per warning.
    pub(crate) fn warnings(&mut self, warnings: &[String]) {
        for warning in warnings {
            self.add(format!("note: {warning}"));
        }
    }

    /// Adds rows in columns: the first flush left, the others flush right.
    pub(crate) fn table(&mut self, rows: &[Vec<String>]) {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            let cells = rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for row in rows {
            let mut line = String::from("  ");
            for (column, cell) in row.iter().enumerate() {
                let blanks = " ".repeat(widths[column] - cell.chars().count());
                line += &match column {
                    0 => format!("{cell}{blanks}"),
                    _ => format!("  {blanks}{cell}"),
                };
            }
            self.add(line);
        }
    }

    /// The text.
    pub(crate) fn into_text(self) -> String {
        self.0
    }
}

/// A number, or `undefined`.
pub(crate) fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "undefined".to_owned(), format_number)
}

/// `= 0.0123`, or `undefined`.
pub(crate) fn p_value(p: Option<f64>) -> String {
    p.map_or_else(|| "undefined".to_owned(), |p| format_p(p, p.ln()))
}

/// The line of paired differences: how many pairs, how many of them without difference, how many rows were
/// dropped.
pub(crate) fn pairs(count: usize, without_difference: usize, rows_dropped: usize) -> String {
    let left_out = dropped(rows_dropped);
    format!("{count} pairs, {without_difference} of them without difference{left_out}")
}

/// How many rows were dropped, behind a count of those used.
pub(crate) fn dropped(rows: usize) -> String {
    match rows {
        0 => String::new(),
        1 => ", 1 row with missing values dropped".to_owned(),
        rows => format!(", {rows} rows with missing values dropped"),
    }
}

/// The cells of a row.
pub(crate) fn row(cells: impl IntoIterator<Item = impl Into<String>>) -> Vec<String> {
    cells.into_iter().map(Into::into).collect()
}
