//! What has been deleted since a backup was made, taken out of the backup itself.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use super::error::BackupError;
use super::file::{Line, Reader, Writer};
use crate::records::{Deletion, PERSONAL_TABLES};

/// Takes out of a backup what has been deleted since it was made. Gives how many sessions' answers
/// or identifiers it held; a file that holds none is left as it is.
pub fn scrub_backup(path: &Path, deletions: &[Deletion]) -> Result<u64, BackupError> {
    let mut reader = Reader::open(path)?;
    let mut writer = Writer::create(path, reader.facts.schema, reader.facts.made_ms)?;
    let mut scrubber = Scrubber::new(deletions);
    while let Some(line) = reader.next()? {
        match line {
            Line::Table { table, columns } => {
                writer.table(&table, &columns)?;
                (scrubber.table, scrubber.columns) = (table, columns);
            }
            Line::Row(row) => {
                if let Some(row) = scrubber.kept(row) {
                    writer.row(row)?;
                }
            }
            _ => {}
        }
    }
    if !scrubber.touched.is_empty() {
        writer.finish()?;
    }
    Ok(scrubber.touched.len() as u64)
}

/// Goes through the rows of a backup, table by table.
struct Scrubber<'d> {
    /// What was deleted of a session, by its token's hash.
    wanted: BTreeMap<&'d str, BTreeSet<&'d str>>,
    table: String,
    columns: Vec<String>,
    /// Sessions found here, by key: whether all of their answers go, or the identifiers alone.
    found: BTreeMap<i64, bool>,
    /// Sessions of which something was taken out.
    touched: BTreeSet<i64>,
}

impl<'d> Scrubber<'d> {
    fn new(deletions: &'d [Deletion]) -> Self {
        let mut wanted: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for deletion in deletions {
            wanted.entry(&deletion.token_hash).or_default().insert(&deletion.what);
        }
        Self {
            wanted,
            table: String::new(),
            columns: Vec::new(),
            found: BTreeMap::new(),
            touched: BTreeSet::new(),
        }
    }

    /// What is left of a row, if anything is.
    fn kept(&mut self, mut row: Vec<Value>) -> Option<Vec<Value>> {
        let cell = |name: &str| row.get(self.columns.iter().position(|column| column == name)?);
        let Some(key) = cell("session_key").and_then(Value::as_i64) else { return Some(row) };
        if self.table == "sessions" {
            let token = cell("token_hash").and_then(Value::as_str);
            if let Some(what) = token.and_then(|token| self.wanted.get(token)) {
                let all = what.iter().any(|what| *what != "identifiers");
                self.found.insert(key, all);
                if all && empty_session(&self.columns, &mut row) {
                    self.touched.insert(key);
                }
            }
            return Some(row);
        }
        let identifying = self.table == "recruitment" || self.table == "repeat_marks";
        let is_personal = PERSONAL_TABLES.contains(&self.table.as_str());
        let is_deleted = self.found.get(&key).is_some_and(|all| *all || identifying);
        if is_personal && is_deleted {
            self.touched.insert(key);
            return None;
        }
        Some(row)
    }
}

/// Empties a session's row as deleting does; whether there was anything in it.
fn empty_session(columns: &[String], row: &mut [Value]) -> bool {
    let mut changed = false;
    for (column, empty) in [
        ("client", Value::from("{}")),
        ("event_count", 0.into()),
        ("next_sequence", 0.into()),
        ("first_gap", 0.into()),
        ("stored_bytes", 0.into()),
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
