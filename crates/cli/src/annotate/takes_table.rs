//! `takes.csv`: a line a take, its weights, its labels, whose face it is, what was performed.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};

/// A line of the table.
pub struct TakeLine {
    /// Line of the file, 1 = the first.
    pub line: u64,
    /// The take as the table names it.
    pub name: String,
    /// Its weights or capture.
    pub weights: PathBuf,
    /// Its labels: .eaf or .csv.
    pub labels: PathBuf,
    /// Whose face it is; empty where the table does not say.
    pub person: String,
    /// What was performed; empty where the table does not say.
    pub kind: String,
}

/// The table.
pub struct TakesTable {
    /// Its lines.
    pub lines: Vec<TakeLine>,
    /// What stands in it after `#`: what the takes are.
    pub description: Vec<String>,
}

const COLUMNS: [&str; 4] = ["weights", "labels", "person", "kind"];

impl TakesTable {
    /// Reads a table; files are named from its own folder.
    pub fn read(file: &Path) -> anyhow::Result<Self> {
        let blame = |line: u64, what: String| anyhow!("{}: line {line}: {what}", file.display());
        let text = std::fs::read_to_string(file)
            .map_err(|e| anyhow!("{}: open: {e}; check the path", file.display()))?;
        let text = text.trim_start_matches('\u{feff}');
        let said = text.lines().filter_map(|line| line.strip_prefix('#'));
        let description: Vec<String> =
            said.map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect();
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| blame(line_of(&e), shown(&e)))?.clone();
        if let Some(other) = header.iter().find(|name| !COLUMNS.contains(name)) {
            let what = format!("column {other:?}; name the columns {}", COLUMNS.join(","));
            return Err(blame(1, what));
        }
        let column = |name: &str| header.iter().position(|own| own == name);
        let (Some(weights), Some(labels)) = (column("weights"), column("labels")) else {
            return Err(blame(1, "open with weights,labels,person,kind".to_owned()));
        };
        let (person, kind) = (column("person"), column("kind"));
        let folder = file.parent().unwrap_or(Path::new(""));
        let mut lines = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| blame(line_of(&e), shown(&e)))?;
            let line = record.position().map_or(0, csv::Position::line);
            let cell = |at: usize| record.get(at).unwrap_or_default().to_owned();
            for (name, at) in [("weights", weights), ("labels", labels)] {
                if cell(at).is_empty() {
                    return Err(blame(line, format!("column {name}: no file; name one")));
                }
            }
            lines.push(TakeLine {
                line,
                name: cell(weights),
                weights: folder.join(cell(weights)),
                labels: folder.join(cell(labels)),
                person: person.map(cell).unwrap_or_default(),
                kind: kind.map(cell).unwrap_or_default(),
            });
        }
        if lines.is_empty() {
            bail!("{}: no take; write a line for each", file.display());
        }
        Ok(Self { lines, description })
    }
}

fn line_of(error: &csv::Error) -> u64 {
    error.position().map_or(1, csv::Position::line)
}

fn shown(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!(
                "{len} cells where the header has {expected_len}; write every column in every line"
            )
        }
        _ => format!("{error}; write a table with commas"),
    }
}
