//! The backup file: every row of the database at one instant, as gzipped JSON lines that restore on
//! either kind of database.
//!
//! ```text
//! {"mimique_backup":1,"schema":2,"made_ms":1767225600000}
//! {"table":"studies","columns":["study_id","config_hash","next_participant"]}
//! ["faces","9f…",12]
//! {"end":1}
//! ```
//!
//! Tables stand in the order of their making, so that no row refers to a later one. The file holds
//! the server's keys and the recruitment identifiers: it wants the same care as the database.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tempfile::NamedTempFile;

use super::error::{BackupError, at};
use crate::durable_file;

/// Version of this format.
const FORMAT: u64 = 1;

/// What a backup holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BackupFacts {
    /// Version of the database's schema.
    pub schema: i64,
    /// When it was made, milliseconds since 1970.
    pub made_ms: i64,
    /// Rows of all tables.
    pub rows: u64,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum Line {
    Row(Vec<Value>),
    Table { table: String, columns: Vec<String> },
    Head { mimique_backup: u64, schema: i64, made_ms: i64 },
    End { end: u64 },
}

/// Writes a backup under a second name; whole or absent.
pub(super) struct Writer {
    path: PathBuf,
    file: GzEncoder<BufWriter<NamedTempFile>>,
    rows: u64,
}

impl Writer {
    pub fn create(path: &Path, schema: i64, made_ms: i64) -> Result<Self, BackupError> {
        let file = durable_file::begin(path).map_err(|error| at(path, error))?;
        let file = GzEncoder::new(BufWriter::new(file), Compression::default());
        let mut writer = Self { path: path.to_owned(), file, rows: 0 };
        writer.line(&Line::Head { mimique_backup: FORMAT, schema, made_ms })?;
        Ok(writer)
    }

    pub fn table(&mut self, table: &str, columns: &[String]) -> Result<(), BackupError> {
        self.line(&Line::Table { table: table.to_owned(), columns: columns.to_vec() })
    }

    pub fn row(&mut self, row: Vec<Value>) -> Result<(), BackupError> {
        self.rows += 1;
        self.line(&Line::Row(row))
    }

    /// Ends the file, brings it to disk and gives it its name.
    pub fn finish(mut self) -> Result<u64, BackupError> {
        let rows = self.rows;
        self.line(&Line::End { end: rows })?;
        let Self { path, file, .. } = self;
        let end = |file: GzEncoder<BufWriter<NamedTempFile>>| -> io::Result<()> {
            let file = file.finish()?.into_inner().map_err(io::IntoInnerError::into_error)?;
            durable_file::finish(file, &path)
        };
        end(file).map_err(|error| at(&path, error))?;
        Ok(rows)
    }

    fn line(&mut self, line: &Line) -> Result<(), BackupError> {
        serde_json::to_writer(&mut self.file, line)
            .map_err(io::Error::from)
            .and_then(|()| self.file.write_all(b"\n"))
            .map_err(|error| at(&self.path, error))
    }
}

/// Reads a backup, line by line, and sees that it is whole.
pub(super) struct Reader {
    path: PathBuf,
    lines: BufReader<MultiGzDecoder<BufReader<File>>>,
    line: u64,
    rows: u64,
    ended: bool,
    pub facts: BackupFacts,
}

impl Reader {
    pub fn open(path: &Path) -> Result<Self, BackupError> {
        let file = File::open(path).map_err(|error| at(path, error))?;
        let lines = BufReader::new(MultiGzDecoder::new(BufReader::new(file)));
        let facts = BackupFacts { schema: 0, made_ms: 0, rows: 0 };
        let mut reader =
            Self { path: path.to_owned(), lines, line: 0, rows: 0, ended: false, facts };
        match reader.next_line()? {
            Line::Head { mimique_backup: FORMAT, schema, made_ms } => {
                reader.facts = BackupFacts { schema, made_ms, rows: 0 };
                Ok(reader)
            }
            Line::Head { mimique_backup, .. } => {
                Err(reader.damaged(format!("format {mimique_backup}, this binary reads {FORMAT}")))
            }
            _ => Err(reader.damaged("it is no backup of Mimique")),
        }
    }

    /// The next table or row; `None` at the end of a whole backup.
    pub fn next(&mut self) -> Result<Option<Line>, BackupError> {
        if self.ended {
            return Ok(None);
        }
        match self.next_line()? {
            Line::End { end } if end == self.rows => {
                self.ended = true;
                // What comes after is gzip's own check of all that was read.
                match self.lines.read_line(&mut String::new()) {
                    Ok(0) => Ok(None),
                    _ => Err(self.damaged("the file does not end where it should")),
                }
            }
            Line::End { end } => {
                Err(self.damaged(format!("{} rows where {end} were written", self.rows)))
            }
            Line::Head { .. } => Err(self.damaged("a second head")),
            line => {
                self.rows += u64::from(matches!(line, Line::Row(_)));
                Ok(Some(line))
            }
        }
    }

    pub fn damaged(&self, problem: impl Into<String>) -> BackupError {
        let path = self.path.display().to_string();
        BackupError::Damaged { path, line: self.line, problem: problem.into() }
    }

    fn next_line(&mut self) -> Result<Line, BackupError> {
        let mut text = String::new();
        self.line += 1;
        match self.lines.read_line(&mut text) {
            Ok(0) => Err(self.damaged("the file ends in the middle")),
            Ok(_) => {
                serde_json::from_str(&text).map_err(|_| self.damaged("not a line of a backup"))
            }
            Err(error) => Err(self.damaged(format!("not a whole gzip file ({error})"))),
        }
    }
}
