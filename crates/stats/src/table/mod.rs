//! A table read from CSV as people have it, and its columns as numbers or factors.
//!
//! In: bytes of a file. Out: named columns of text cells. The separator (`,` `;` tab) is found, a byte
//! order mark dropped, CRLF and quotes understood, UTF-8 taken first, then UTF-16 with a mark, then
//! Windows-1252 (a superset of Latin-1). Blank, `NA` and `NaN` cells are missing.

pub(crate) mod blocks;
pub(crate) mod cells;
pub(crate) mod coded;
pub(crate) mod comparisons;
pub(crate) mod contingency;
pub(crate) mod csv;
pub(crate) mod factor;
pub(crate) mod number;
pub(crate) mod pairs;
pub(crate) mod sample;

use std::collections::HashMap;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::refusal::Refusal;
use cells::{Cells, Mistake, Records};
use coded::Coded;
use factor::Factor;
use number::{parse_number, plain_decimal};

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
    /// UTF-8.
    bytes: Vec<u8>,
    names: Vec<String>,
    by_name: HashMap<String, usize>,
    /// The rows below the header, piece after piece.
    pieces: Vec<Records>,
    /// The first row of each piece, and the number of rows.
    firsts: Vec<usize>,
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
    /// Reads a table from the bytes of a file, which it keeps.
    pub fn parse(bytes: impl Into<Vec<u8>>) -> Result<Self, TableError> {
        let (mut bytes, start) = csv::decode(bytes.into());
        if bytes.len() >= u32::MAX as usize {
            return Err(TableError::TooLarge { bytes: bytes.len() });
        }
        let separator = csv::find_separator(&bytes[start..]);
        let Cells { width, header, pieces } =
            cells::cut(&mut bytes, start, separator as u8, cells::PIECE).map_err(
                |(mistake, width)| {
                    let line = |at: usize| line_of(&bytes, at);
                    match mistake {
                        Mistake::OpenQuote { at } => TableError::OpenQuote { line: line(at) },
                        Mistake::Ragged { at, found } => {
                            TableError::Ragged { line: line(at), found, expected: width }
                        }
                    }
                },
            )?;
        if width == 0 {
            return Err(TableError::Empty);
        }
        let mut names = Vec::with_capacity(width);
        let mut by_name = HashMap::new();
        for column in 0..width {
            let (start, end) = header.place(0, column, width);
            let mut name = text(cells::unquoted(&bytes[start..end])).trim().to_owned();
            if name.is_empty() {
                // Row names of `write.csv`, or separators at the end of each line.
                name = format!("column {}", column + 1);
            }
            if by_name.insert(name.clone(), column).is_some() {
                return Err(TableError::RepeatedColumn { name });
            }
            names.push(name);
        }
        let mut firsts = vec![0];
        for piece in &pieces {
            firsts.push(firsts[firsts.len() - 1] + piece.len(width));
        }
        if firsts[firsts.len() - 1] == 0 {
            return Err(TableError::NoRows);
        }
        Ok(Self { bytes, names, by_name, pieces, firsts, separator })
    }

    /// Number of rows below the header.
    pub fn rows(&self) -> usize {
        self.firsts[self.firsts.len() - 1]
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

    /// Line of the file where a row starts, from 1. Counts the lines before it: for messages.
    pub fn line(&self, row: usize) -> usize {
        let piece = self.piece(row);
        let at = self.pieces[piece].start(row - self.firsts[piece], self.names.len());
        line_of(&self.bytes, at)
    }

    /// The piece that a row is in.
    fn piece(&self, row: usize) -> usize {
        self.firsts.partition_point(|&first| first <= row) - 1
    }

    /// A cell without surrounding blanks; `None` where missing (blank, `NA`, `NaN`).
    pub fn cell(&self, row: usize, column: usize) -> Option<&str> {
        let piece = self.piece(row);
        self.written(piece, row - self.firsts[piece], column).map(text)
    }

    /// What is written in a cell of a piece.
    #[inline]
    fn written(&self, piece: usize, record: usize, column: usize) -> Option<&[u8]> {
        let (start, end) = self.pieces[piece].place(record, column, self.names.len());
        let cell = &self.bytes[start..end];
        // Neither quote nor blank nor anything that could be another blank than that of ASCII.
        let plain = |byte: u8| byte.is_ascii_graphic() && byte != b'"';
        let cell = match cell {
            [] => return None,
            [first, .., last] if plain(*first) && plain(*last) => cell,
            [only] if plain(*only) => return Some(cell),
            _ => text(cells::unquoted(cell)).trim().as_bytes(),
        };
        (!matches!(cell, b"" | b"NA" | b"NaN" | b"nan")).then_some(cell)
    }

    /// Position of a column by name.
    pub fn position(&self, name: &str) -> Result<usize, Refusal> {
        self.by_name.get(name.trim()).copied().ok_or_else(|| Refusal::NoColumn {
            column: name.to_owned(),
            columns: self.names.clone(),
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
        let mut values = vec![0.0; self.rows()];
        let mut rest = values.as_mut_slice();
        let mut stretches = Vec::with_capacity(self.pieces.len());
        for (piece, ends) in self.firsts.windows(2).enumerate() {
            let (own, after) = rest.split_at_mut(ends[1] - ends[0]);
            stretches.push((piece, own));
            rest = after;
        }
        let mistakes: Vec<Option<usize>> = stretches
            .into_par_iter()
            .map(|(piece, values)| {
                values.iter_mut().enumerate().find_map(|(record, value)| {
                    let (start, end) = self.pieces[piece].place(record, position, self.names.len());
                    if let Some(number) = plain_decimal(&self.bytes[start..end]) {
                        *value = number;
                        return None;
                    }
                    *value = match self.written(piece, record, position) {
                        None => f64::NAN,
                        Some(cell) => match self.number(text(cell)) {
                            Some(number) => number,
                            None => return Some(self.firsts[piece] + record),
                        },
                    };
                    None
                })
            })
            .collect();
        if let Some(row) = mistakes.into_iter().flatten().next() {
            let cell = self.cell(row, position).unwrap_or_default();
            return Err(Refusal::NotANumber {
                column: name.to_owned(),
                line: self.line(row),
                cell: cell.to_owned(),
            });
        }
        Ok(Numbers { name: name.trim().to_owned(), values })
    }

    /// A column as a factor: levels in numeric order if all are numbers, else alphabetical.
    pub fn factor(&self, name: &str) -> Result<Factor, Refusal> {
        let position = self.position(name)?;
        let pieces: Vec<Coded> = (0..self.pieces.len())
            .into_par_iter()
            .map(|piece| {
                let rows = self.firsts[piece + 1] - self.firsts[piece];
                Coded::of((0..rows).map(|record| self.written(piece, record, position)))
            })
            .collect();
        let coded = Coded::joined(pieces);
        Ok(Factor::of_coded(name.trim(), &coded.labels(text), coded.codes, |cell| {
            self.number(cell)
        }))
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
        parse_number(cell, self.separator != ',')
    }
}

/// Bytes that are UTF-8.
fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap_or_default()
}

/// Line of a file, from 1, that a place is in.
fn line_of(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers<const N: usize>(bytes: &[u8; N], name: &str) -> Vec<f64> {
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
        assert_eq!(Table::parse(utf16).unwrap().cell(0, 0), Some("é"));
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
        assert!(table.numbers("q").unwrap_err().to_string().contains("\"y\" and \"g\""));
        assert!(Table::parse(b"y\ninf\n").unwrap().numbers("y").is_err());
    }

    #[test]
    fn levels_sort_as_numbers_or_as_words() {
        let table = Table::parse(b"g,h\n10,b\n9,A\n10.0,c\n").unwrap();
        assert_eq!(table.factor("g").unwrap().levels, ["9", "10"]);
        assert_eq!(table.factor("h").unwrap().levels, ["A", "b", "c"]);
    }
}
