//! JSON documents and tables of the cases, read part by part: what is not there is said with its place.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::VerifyError;

/// The text of a file.
pub(crate) fn text(file: &Path) -> Result<String, VerifyError> {
    std::fs::read_to_string(file).map_err(|error| VerifyError::read(file, &error))
}

/// A JSON document and the file that it is from.
pub(crate) struct Document {
    file: PathBuf,
    value: Value,
}

impl Document {
    /// Reads a file.
    pub fn read(file: &Path) -> Result<Self, VerifyError> {
        let value = serde_json::from_str(&text(file)?).map_err(|error| VerifyError::Json {
            file: file.to_owned(),
            line: error.line(),
            column: error.column(),
            why: error.to_string(),
        })?;
        Ok(Self { file: file.to_owned(), value })
    }

    /// The whole of it.
    pub fn root(&self) -> Part<'_> {
        Part { file: &self.file, place: String::new(), value: &self.value }
    }
}

/// A part of a document, with its place.
#[derive(Clone)]
pub(crate) struct Part<'a> {
    file: &'a Path,
    place: String,
    value: &'a Value,
}

impl<'a> Part<'a> {
    /// What stands there.
    pub fn value(&self) -> &'a Value {
        self.value
    }

    /// That something else is needed here.
    pub fn wrong(&self, wanted: &'static str) -> VerifyError {
        let found = match self.value {
            Value::Array(items) => format!("a list of {}", items.len()),
            Value::Object(_) => "an object".to_owned(),
            other => other.to_string(),
        };
        let place = if self.place.is_empty() { "/".to_owned() } else { self.place.clone() };
        VerifyError::Part { file: self.file.to_owned(), place, found, wanted }
    }

    /// A member, where there is one.
    pub fn find(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key)?;
        let place = format!("{}/{}", self.place, key.replace('~', "~0").replace('/', "~1"));
        Some(Self { file: self.file, place, value })
    }

    /// A member.
    pub fn get(&self, key: &str) -> Result<Self, VerifyError> {
        self.find(key).ok_or_else(|| VerifyError::Part {
            file: self.file.to_owned(),
            place: format!("{}/{key}", self.place),
            found: "nothing".to_owned(),
            wanted: "a value",
        })
    }

    /// The names of the members and the members.
    pub fn members(&self) -> Result<Vec<(&'a str, Self)>, VerifyError> {
        let members = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        Ok(members.keys().filter_map(|key| Some((key.as_str(), self.find(key)?))).collect())
    }

    /// The entries of a list.
    pub fn list(&self) -> Result<Vec<Self>, VerifyError> {
        let items = self.value.as_array().ok_or_else(|| self.wrong("a list"))?;
        let entry =
            |(i, value)| Self { file: self.file, place: format!("{}/{i}", self.place), value };
        Ok(items.iter().enumerate().map(entry).collect())
    }

    /// The first entry of a list.
    pub fn first(&self) -> Result<Self, VerifyError> {
        self.list()?.into_iter().next().ok_or_else(|| self.wrong("a list with an entry"))
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, VerifyError> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    /// A list of texts.
    pub fn texts(&self) -> Result<Vec<&'a str>, VerifyError> {
        self.list()?.iter().map(Self::text).collect()
    }

    /// A number; `"-inf"` is minus infinity.
    pub fn number(&self) -> Result<f64, VerifyError> {
        if self.value == "-inf" {
            return Ok(f64::NEG_INFINITY);
        }
        self.value.as_f64().ok_or_else(|| self.wrong("a number"))
    }

    /// All numbers inside lists of lists, in order.
    pub fn numbers(&self) -> Result<Vec<f64>, VerifyError> {
        if !self.value.is_array() {
            return Ok(vec![self.number()?]);
        }
        let mut all = Vec::new();
        for entry in self.list()? {
            all.extend(entry.numbers()?);
        }
        Ok(all)
    }

    /// A whole number from 0.
    pub fn index(&self) -> Result<usize, VerifyError> {
        let index = self.value.as_u64().and_then(|index| usize::try_from(index).ok());
        index.ok_or_else(|| self.wrong("a whole number from 0"))
    }

    /// A list of whole numbers from 0.
    pub fn indices(&self) -> Result<Vec<usize>, VerifyError> {
        self.list()?.iter().map(Self::index).collect()
    }

    /// A list of whole numbers below a bound.
    pub fn indices_below(
        &self,
        bound: usize,
        wanted: &'static str,
    ) -> Result<Vec<usize>, VerifyError> {
        let below = |entry: &Self| match entry.index()? {
            index if index < bound => Ok(index),
            _ => Err(entry.wrong(wanted)),
        };
        self.list()?.iter().map(below).collect()
    }
}

/// A table of texts: a CSV without quotes.
pub(crate) struct Table {
    file: PathBuf,
    /// Names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a file.
    pub fn read(file: &Path) -> Result<Self, VerifyError> {
        let text = text(file)?;
        let split = |line: &str| -> Vec<String> {
            line.split(',').map(|cell| cell.trim().to_owned()).collect()
        };
        let mut lines = text.lines();
        let header = split(lines.next().unwrap_or_default());
        let rows: Vec<Vec<String>> = lines.filter(|l| !l.trim().is_empty()).map(split).collect();
        let table = Self { file: file.to_owned(), header, rows };
        match table.rows.iter().position(|row| row.len() != table.header.len()) {
            Some(row) => Err(VerifyError::Cell {
                file: file.to_owned(),
                line: row + 2,
                column: table.rows[row].len(),
                found: table.rows[row].join(","),
                wanted: "as many cells as the header has",
            }),
            None => Ok(table),
        }
    }

    /// A cell as something else; `wanted` says what is needed.
    pub fn cell<T>(
        &self,
        row: usize,
        column: usize,
        wanted: &'static str,
        of: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, VerifyError> {
        let found = self.rows[row].get(column).map_or("", String::as_str);
        of(found).ok_or_else(|| VerifyError::Cell {
            file: self.file.clone(),
            line: row + 2,
            column: column + 1,
            found: found.to_owned(),
            wanted,
        })
    }

    /// The column of a name.
    pub fn column(&self, name: &'static str) -> Result<usize, VerifyError> {
        self.header.iter().position(|own| own == name).ok_or_else(|| VerifyError::Cell {
            file: self.file.clone(),
            line: 1,
            column: 1,
            found: self.header.join(","),
            wanted: name,
        })
    }

    /// A cell as a whole number from 0.
    pub fn index(&self, row: usize, column: usize) -> Result<usize, VerifyError> {
        self.cell(row, column, "a whole number from 0", |cell| cell.parse().ok())
    }

    /// The numbers of a row from a column on; empty cells are NaN.
    pub fn numbers(&self, row: usize, from: usize) -> Result<Vec<f64>, VerifyError> {
        let number = |cell: &str| if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
        (from..self.header.len()).map(|c| self.cell(row, c, "a number", number)).collect()
    }
}
