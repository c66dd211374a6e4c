//! The tidy export as it lies in a file: names of columns, and cells as they are written.

use std::collections::BTreeMap;

/// What keeps a file from being a tidy export.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotResponses {
    /// It is no CSV.
    #[error("line {line}: {what}; give a tidy export as `mimique export` writes it")]
    Csv {
        /// Line of the file, from 1.
        line: u64,
        /// What the reader says.
        what: String,
    },
    /// A column that every tidy export has is not there.
    #[error(
        "line 1: there is no column {name}; give a tidy export as `mimique export --format csv` writes it"
    )]
    NoColumn {
        /// The column.
        name: &'static str,
    },
    /// There is nothing below the header.
    #[error("line 2: there are no answers; export a study that people have taken part in")]
    Empty,
}

/// Columns without which nothing can be made of an export; none of them can be left out.
pub const NEEDED: [&str; 9] = [
    "participant_id",
    "trial_id",
    "trial_index",
    "trial_type",
    "response_id",
    "answer",
    "response",
    "status",
    "config_hash",
];

/// A tidy export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Responses {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Responses {
    /// Reads a CSV file.
    ///
    /// # Errors
    /// It is no CSV, or a column of `NEEDED` or any row is missing.
    pub fn read(bytes: &[u8]) -> Result<Self, NotResponses> {
        let read = Self::read_any(bytes)?;
        if let Some(name) = NEEDED.into_iter().find(|name| read.column(name).is_none()) {
            return Err(NotResponses::NoColumn { name });
        }
        if read.rows.is_empty() {
            return Err(NotResponses::Empty);
        }
        Ok(read)
    }

    /// Reads any table in CSV with a header, such as the table of stimuli.
    ///
    /// # Errors
    /// It is no CSV.
    pub fn read_any(bytes: &[u8]) -> Result<Self, NotResponses> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::Reader::from_reader(bytes);
        let fields = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let columns = reader.headers().map(fields).map_err(not_csv)?;
        let mut rows = Vec::new();
        for record in reader.records() {
            rows.push(fields(&record.map_err(not_csv)?));
        }
        Ok(Self { columns, rows })
    }

    /// Names of the columns, in order.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Place of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|own| own == name)
    }

    /// A cell by its row and column; empty where there is no such column.
    pub fn cell(&self, row: usize, column: &str) -> &str {
        self.column(column).map_or("", |column| &self.rows[row][column])
    }

    /// The rows.
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The values of a column, each once, in order.
    pub fn values(&self, column: &str) -> Vec<&str> {
        let Some(column) = self.column(column) else { return Vec::new() };
        let mut values: Vec<&str> = self.rows.iter().map(|row| &*row[column]).collect();
        values.sort_unstable();
        values.dedup();
        values.retain(|value| !value.is_empty());
        values
    }

    /// The rows of each person, by their identifier.
    pub fn by_person(&self) -> BTreeMap<&str, Vec<usize>> {
        let mut rows: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for row in 0..self.rows.len() {
            rows.entry(self.cell(row, "participant_id")).or_default().push(row);
        }
        rows
    }

    /// Takes columns out.
    pub fn without_columns(&mut self, is_dropped: impl Fn(&str) -> bool) {
        let kept: Vec<bool> = self.columns.iter().map(|name| !is_dropped(name)).collect();
        let keep = |cells: &mut Vec<String>| {
            let mut kept = kept.iter();
            cells.retain(|_| kept.next().copied().unwrap_or(true));
        };
        keep(&mut self.columns);
        self.rows.iter_mut().for_each(keep);
    }

    /// Empties cells of the rows that answer one of some questions.
    pub fn without_answers(&mut self, cells: &[&str], is_dropped: impl Fn(&str) -> bool) {
        let Some(asked) = self.column("response_id") else { return };
        let cells: Vec<usize> = cells.iter().filter_map(|name| self.column(name)).collect();
        for row in &mut self.rows {
            if is_dropped(&row[asked]) {
                cells.iter().for_each(|cell| row[*cell].clear());
            }
        }
    }

    /// As CSV, as exports are written: comma, quotes where needed, one line break a row.
    ///
    /// # Errors
    /// The writer of CSV fails, which it does not in memory.
    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.columns)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}

fn not_csv(error: csv::Error) -> NotResponses {
    let line = error.position().map_or(1, csv::Position::line);
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cells, the header has {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "this is not UTF-8".to_owned(),
        _ => error.to_string(),
    };
    NotResponses::Csv { line, what }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_export_is_refused_with_its_place() {
        let header = NEEDED.join(",");
        let refused = |text: &str| Responses::read(text.as_bytes()).unwrap_err().to_string();
        assert!(refused("a,b\n1,2\n").starts_with("line 1: there is no column participant_id; "));
        assert!(refused(&format!("{header}\n")).starts_with("line 2: there are no answers; "));
        let ragged = refused(&format!("{header}\n1,2\n"));
        assert!(ragged.starts_with("line 2: 2 cells, the header has 9; "), "{ragged}");
        assert!(refused("").contains("no column participant_id"));
    }

    #[test]
    fn a_table_is_written_as_it_was_read() {
        let text = "a,b\n\"x, y\",\"z \"\"q\"\"\"\n,2\n";
        let mut table = Responses::read_any(text.as_bytes()).unwrap();
        assert_eq!(table.to_csv().unwrap(), text.as_bytes());
        table.without_columns(|name| name == "a");
        assert_eq!(table.to_csv().unwrap(), b"b\n\"z \"\"q\"\"\"\n2\n");
    }
}
