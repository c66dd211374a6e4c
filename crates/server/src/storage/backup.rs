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

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::records::Deletion;
use super::{PERSONAL_TABLES, StorageError};

/// Version of this format.
const FORMAT: u64 = 1;

/// A backup cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum BackupError {
    /// The file cannot be read or written.
    #[error("{path}: {error}; see that the place can be read and written and has room")]
    File {
        /// The file.
        path: String,
        /// What went wrong.
        error: io::Error,
    },
    /// The file is no whole backup.
    #[error("{path}: line {line}: {problem}; take another backup")]
    Damaged {
        /// The file.
        path: String,
        /// Where, from 1.
        line: u64,
        /// What is wrong.
        problem: String,
    },
    /// The place to restore to holds something.
    #[error("{place}: it is not empty; give a database that does not exist yet, or an empty one")]
    NotEmpty {
        /// The database.
        place: String,
    },
    /// The database failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
}

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

/// How a backup is restored.
#[derive(Debug, Clone, Copy, Default)]
pub struct RestoreOptions<'a> {
    /// Participant numbers go on in the next thousand, so that none is given twice that was given
    /// after the backup was made.
    pub skip_numbers: bool,
    /// What was deleted after the backup was made, to be deleted again.
    pub deletions: &'a [Deletion],
}

/// What was restored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restored {
    /// Rows of all tables.
    pub rows: u64,
    /// Sessions or identifiers that were deleted again.
    pub deleted_again: u64,
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
    temporary: PathBuf,
    file: GzEncoder<BufWriter<File>>,
    rows: u64,
}

impl Writer {
    pub fn create(path: &Path, schema: i64, made_ms: i64) -> Result<Self, BackupError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let temporary = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
        let mut options = File::options();
        options.write(true).create(true).truncate(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let file = options.open(&temporary).map_err(|error| at(path, error))?;
        let file = GzEncoder::new(BufWriter::new(file), Compression::default());
        let mut writer = Self { path: path.to_owned(), temporary, file, rows: 0 };
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
        let end = |file: &mut GzEncoder<BufWriter<File>>| -> io::Result<()> {
            file.try_finish()?;
            file.get_mut().flush()?;
            file.get_ref().get_ref().sync_all()
        };
        end(&mut self.file).map_err(|error| at(&self.path, error))?;
        std::fs::rename(&self.temporary, &self.path).map_err(|error| at(&self.path, error))?;
        Ok(rows)
    }

    fn line(&mut self, line: &Line) -> Result<(), BackupError> {
        serde_json::to_writer(&mut self.file, line)
            .map_err(io::Error::from)
            .and_then(|()| self.file.write_all(b"\n"))
            .map_err(|error| at(&self.path, error))
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // Gone already when it was finished.
        let _ = std::fs::remove_file(&self.temporary);
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

/// Takes out of a backup what has been deleted since it was made. Gives how many sessions' answers
/// or identifiers it held; a file that holds none is left as it is.
pub fn scrub_backup(path: &Path, deletions: &[Deletion]) -> Result<u64, BackupError> {
    let mut wanted: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for deletion in deletions {
        wanted.entry(&deletion.token_hash).or_default().insert(&deletion.what);
    }
    let mut reader = Reader::open(path)?;
    let mut writer = Writer::create(path, reader.facts.schema, reader.facts.made_ms)?;
    let mut table = String::new();
    let mut columns: Vec<String> = Vec::new();
    // Sessions found here, by key: whether all of their answers go, or the identifiers alone.
    let mut found: BTreeMap<i64, bool> = BTreeMap::new();
    let mut touched: BTreeSet<i64> = BTreeSet::new();
    while let Some(line) = reader.next()? {
        match line {
            Line::Table { table: name, columns: names } => {
                writer.table(&name, &names)?;
                (table, columns) = (name, names);
            }
            Line::Row(mut row) => {
                let place = |name: &str| columns.iter().position(|column| column == name);
                let number =
                    |name: &str| place(name).and_then(|at| row.get(at)).and_then(Value::as_i64);
                let key = number("session_key");
                if table == "sessions" {
                    let token = place("token_hash").and_then(|at| row.get(at)?.as_str());
                    if let (Some(key), Some(what)) = (key, token.and_then(|t| wanted.get(t))) {
                        let all = what.iter().any(|what| *what != "identifiers");
                        found.insert(key, all);
                        if all && empty_session(&columns, &mut row) {
                            touched.insert(key);
                        }
                    }
                } else if let Some((key, all)) = key.and_then(|k| Some((k, *found.get(&k)?))) {
                    let identifying = table == "recruitment" || table == "repeat_marks";
                    if PERSONAL_TABLES.contains(&table.as_str()) && (all || identifying) {
                        touched.insert(key);
                        continue;
                    }
                }
                writer.row(row)?;
            }
            _ => {}
        }
    }
    if !touched.is_empty() {
        writer.finish()?;
    }
    Ok(touched.len() as u64)
}

/// The deletions beside a folder's backups: a JSON line each.
pub fn read_deletions(path: &Path) -> Result<Vec<Deletion>, BackupError> {
    let text = std::fs::read_to_string(path).map_err(|error| at(path, error))?;
    text.lines()
        .enumerate()
        .map(|(index, line)| {
            serde_json::from_str(line).map_err(|error| BackupError::Damaged {
                path: path.display().to_string(),
                line: index as u64 + 1,
                problem: error.to_string(),
            })
        })
        .collect()
}

/// Writes the deletions as [`read_deletions`] reads them.
pub fn write_deletions(path: &Path, deletions: &[Deletion]) -> Result<(), BackupError> {
    let mut text = String::new();
    for deletion in deletions {
        text.push_str(&serde_json::to_string(deletion).unwrap_or_default());
        text.push('\n');
    }
    crate::atomic_file::write(path, text.as_bytes()).map_err(|error| at(path, error))
}

/// Empties a session's row as deleting does; whether there was anything in it.
fn empty_session(columns: &[String], row: &mut [Value]) -> bool {
    let mut changed = false;
    for (column, empty) in [
        ("client", Value::from("{}")),
        ("event_count", 0.into()),
        ("next_sequence", 0.into()),
        ("last_event_ms", Value::Null),
        ("receipt", Value::Null),
        ("receipt_events", Value::Null),
    ] {
        let cell = columns.iter().position(|name| name == column).and_then(|at| row.get_mut(at));
        if let Some(cell) = cell {
            changed |= *cell != empty;
            *cell = empty;
        }
    }
    changed
}

fn at(path: &Path, error: io::Error) -> BackupError {
    BackupError::File { path: path.display().to_string(), error }
}
