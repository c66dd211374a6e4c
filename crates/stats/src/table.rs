//! A table read from CSV as people have it, and its columns as numbers or factors.
//!
//! In: bytes of a file. Out: named columns of text cells. The separator (`,` `;` tab) is found, a byte
//! order mark dropped, CRLF and quotes understood, UTF-8 taken first, then UTF-16 with a mark, then
//! Windows-1252 (a superset of Latin-1). Blank, `NA` and `NaN` cells are missing.

use std::collections::HashMap;

use crate::csv;
use crate::factor::Factor;
use crate::outcome::Refusal;

/// What keeps a file from being a table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// Nothing in the file.
    #[error("line 1: the file is empty; give a CSV file with a header line")]
    Empty,
    /// A header without rows.
    #[error("line 2: no rows below the header; give at least one row of data")]
    NoRows,
    /// Two columns of one name.
    #[error("line 1: two columns are called \"{name}\"; rename one of them")]
    RepeatedColumn {
        /// The name.
        name: String,
    },
    /// A row with too many or too few cells.
    #[error(
        "line {line}: {found} cells, the header has {expected}; check quotes, separators and decimal commas on this line"
    )]
    Ragged {
        /// Line of the file, from 1.
        line: usize,
        /// Cells found.
        found: usize,
        /// Cells of the header.
        expected: usize,
    },
    /// A quote that is opened and never closed.
    #[error("line {line}: a quoted cell is opened and never closed; close the quote")]
    OpenQuote {
        /// Line of the file, from 1.
        line: usize,
    },
    /// More than 4 GiB.
    #[error("the file has {bytes} bytes, at most 4294967295 can be read; split the file")]
    TooLarge {
        /// Size.
        bytes: usize,
    },
}

/// A table of text cells.
#[derive(Debug, Clone)]
pub struct Table {
    text: String,
    names: Vec<String>,
    by_name: HashMap<String, usize>,
    /// Start and end of each cell in `text`, row after row.
    cells: Vec<(u32, u32)>,
    /// Line of the file where each row starts.
    lines: Vec<u32>,
    separator: char,
}

/// A column of numbers; missing cells are NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbers {
    /// Name of the column.
    pub name: String,
    /// One a row, NaN where missing.
    pub values: Vec<f64>,
}

impl Table {
    /// Reads a table from the bytes of a file.
    pub fn parse(bytes: &[u8]) -> Result<Self, TableError> {
        let text = csv::decode(bytes);
        if text.len() > u32::MAX as usize {
            return Err(TableError::TooLarge { bytes: text.len() });
        }
        if text.trim().is_empty() {
            return Err(TableError::Empty);
        }
        let separator = csv::find_separator(&text);
        let raw = csv::split(text, separator)?;
        let mut names = Vec::with_capacity(raw.width);
        let mut by_name = HashMap::new();
        for (position, &(start, end)) in raw.cells[..raw.width].iter().enumerate() {
            let mut name = raw.text[start as usize..end as usize].trim().to_owned();
            if name.is_empty() {
                // Row names of `write.csv`, or separators at the end of each line.
                name = format!("column {}", position + 1);
            }
            if by_name.insert(name.clone(), position).is_some() {
                return Err(TableError::RepeatedColumn { name });
            }
            names.push(name);
        }
        if raw.lines.len() < 2 {
            return Err(TableError::NoRows);
        }
        let cells = raw.cells[raw.width..].to_vec();
        let lines = raw.lines[1..].to_vec();
        Ok(Self { text: raw.text, names, by_name, cells, lines, separator })
    }

    /// Number of rows below the header.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// Names of the columns, in the file's order.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Whether there is a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// The separator found.
    pub fn separator(&self) -> char {
        self.separator
    }

    /// Line of the file where a row starts, from 1.
    pub fn line(&self, row: usize) -> usize {
        self.lines[row] as usize
    }

    /// A cell without surrounding blanks; `None` where missing (blank, `NA`, `NaN`).
    pub fn cell(&self, row: usize, column: usize) -> Option<&str> {
        let (start, end) = self.cells[row * self.names.len() + column];
        let cell = self.text[start as usize..end as usize].trim();
        (!matches!(cell, "" | "NA" | "NaN" | "nan")).then_some(cell)
    }

    /// Position of a column by name.
    pub fn position(&self, name: &str) -> Result<usize, Refusal> {
        self.by_name.get(name.trim()).copied().ok_or_else(|| {
            Refusal::column(
                name,
                "there is no such column",
                format!("the columns are {}", list_of_names(&self.names)),
            )
        })
    }

    /// The cells of a column.
    pub fn column(&self, name: &str) -> Result<impl Iterator<Item = Option<&str>>, Refusal> {
        let position = self.position(name)?;
        Ok((0..self.rows()).map(move |row| self.cell(row, position)))
    }

    /// A column as numbers. A decimal comma is understood where the separator is not a comma.
    pub fn numbers(&self, name: &str) -> Result<Numbers, Refusal> {
        let position = self.position(name)?;
        let mut values = Vec::with_capacity(self.rows());
        for row in 0..self.rows() {
            let value = match self.cell(row, position) {
                None => f64::NAN,
                Some(cell) => self.number(cell).ok_or_else(|| {
                    let problem = format!("line {}: \"{cell}\" is not a number", self.line(row));
                    let remedy = "give a number, or leave the cell blank or NA if it is missing";
                    Refusal::column(name, problem, remedy)
                })?,
            };
            values.push(value);
        }
        Ok(Numbers { name: name.trim().to_owned(), values })
    }

    /// A column as a factor: levels in numeric order if all are numbers, else alphabetical.
    pub fn factor(&self, name: &str) -> Result<Factor, Refusal> {
        let position = self.position(name)?;
        let cells = (0..self.rows()).map(|row| self.cell(row, position));
        Ok(Factor::from_cells(name.trim(), cells, |cell| self.number(cell)))
    }

    /// One column as a factor, or the combination of several named with commas between them
    /// (`participant,expression`): the levels of a combination are joined by ` / `.
    pub fn combined_factor(&self, names: &str) -> Result<Factor, Refusal> {
        if self.has(names.trim()) || !names.contains(',') {
            return self.factor(names);
        }
        let columns =
            names.split(',').map(|name| self.position(name)).collect::<Result<Vec<_>, _>>()?;
        let joined: Vec<Option<String>> = (0..self.rows())
            .map(|row| {
                let cells: Option<Vec<&str>> =
                    columns.iter().map(|&column| self.cell(row, column)).collect();
                cells.map(|cells| cells.join(" / "))
            })
            .collect();
        Ok(Factor::from_cells(names.trim(), joined.iter().map(Option::as_deref), |_| None))
    }

    /// A cell as a finite number.
    fn number(&self, cell: &str) -> Option<f64> {
        csv::parse_number(cell, self.separator != ',')
    }
}

/// At most twelve names, quoted.
pub(crate) fn list_of_names(names: &[String]) -> String {
    let mut text =
        names.iter().take(12).map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    if names.len() > 12 {
        text.push_str(&format!(" and {} more", names.len() - 12));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(bytes: &[u8], name: &str) -> Vec<f64> {
        Table::parse(bytes).unwrap().numbers(name).unwrap().values
    }

    #[test]
    fn separators_and_decimal_commas_are_found() {
        assert_eq!(numbers(b"a,b\n1.5,2\n", "a"), [1.5]);
        assert_eq!(numbers(b"a;b\r\n1,5;2,25\r\n", "b"), [2.25]);
        assert_eq!(numbers(b"a\tb\n1,5\t2\n", "a"), [1.5]);
        assert_eq!(numbers(b"a\n1,5\n2\n", "a"), [1.5, 2.0]);
        assert_eq!(numbers(b"\"a,x\";b\n\"1,5\";2\n", "a,x"), [1.5]);
    }

    #[test]
    fn marks_quotes_and_encodings_are_understood() {
        let table = Table::parse("\u{feff}\"né, e\",b\n\"x \"\"y\"\"\",1\n".as_bytes()).unwrap();
        assert_eq!(table.names(), ["né, e", "b"]);
        assert_eq!(table.cell(0, 0), Some("x \"y\""));
        let latin = Table::parse(b"g,y\nm\xe9thode,1\n").unwrap();
        assert_eq!(latin.cell(0, 0), Some("méthode"));
        let utf16: Vec<u8> = std::iter::once(0xfeffu16)
            .chain("g\ty\ré\t1\r".replace('\r', "\r\n").encode_utf16())
            .flat_map(u16::to_le_bytes)
            .collect();
        assert_eq!(Table::parse(&utf16).unwrap().cell(0, 0), Some("é"));
        let lines = Table::parse(b"a,b\n\"x\ny\",1\n\n2,3\n").unwrap();
        assert_eq!(lines.cell(0, 0), Some("x\ny"));
        assert_eq!(lines.line(1), 5);
    }

    #[test]
    fn columns_without_a_name_are_counted() {
        let table = Table::parse(b"\"\",y,\n\"1\",4,\n\"2\",5,\n").unwrap();
        assert_eq!(table.names(), ["column 1", "y", "column 3"]);
        assert_eq!(table.numbers("y").unwrap().values, [4.0, 5.0]);
    }

    #[test]
    fn missing_cells_are_missing() {
        let values = numbers(b"y,z\n1,a\n,a\nNA,a\nNaN,a\n 2 ,a\n", "y");
        assert_eq!(values.iter().filter(|v| v.is_nan()).count(), 3);
        assert_eq!(values[4], 2.0);
    }

    #[test]
    fn errors_name_line_and_column() {
        let text = |bytes: &[u8]| Table::parse(bytes).unwrap_err().to_string();
        assert!(text(b"").contains("empty"));
        assert!(text(b"a,b\n").contains("no rows"));
        assert!(text(b"a,b\n1,2\n1,2,3\n").contains("line 3: 3 cells, the header has 2"));
        assert!(text(b"a,a\n1,2\n").contains("two columns are called \"a\""));
        assert!(text(b"a,b\n1,\"2\n").contains("line 2: a quoted cell is opened"));
        let table = Table::parse(b"y,g\n1,a\nx,b\n").unwrap();
        assert_eq!(
            table.numbers("y").unwrap_err().to_string(),
            "column \"y\": line 3: \"x\" is not a number; give a number, or leave the cell blank or NA if it is missing"
        );
        assert!(table.numbers("q").unwrap_err().to_string().contains("\"y\", \"g\""));
        assert!(Table::parse(b"y\ninf\n").unwrap().numbers("y").is_err());
    }

    #[test]
    fn levels_sort_as_numbers_or_as_words() {
        let table = Table::parse(b"g,h\n10,b\n9,A\n10.0,c\n").unwrap();
        assert_eq!(table.factor("g").unwrap().levels, ["9", "10"]);
        assert_eq!(table.factor("h").unwrap().levels, ["A", "b", "c"]);
    }
}
