//! Why an export cannot be analysed.

use std::collections::BTreeMap;

use crate::trials::reason::Reason;

/// Why an export cannot be analysed. Its words name the column and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// A column of the tidy form is absent.
    #[error(
        "column \"{column}\": there is no such column; give the tidy form that `mimique export --format csv` writes"
    )]
    NoColumn {
        /// The column.
        column: &'static str,
    },
    /// The table of stimuli cannot be used.
    #[error(transparent)]
    Stimuli(#[from] StimuliError),
    /// The tables of participants' faces and of the clips' courses cannot be used.
    #[error(transparent)]
    Mimicry(#[from] MimicryError),
    /// A cell that every row has is blank.
    #[error("column \"{column}\": line {line}: the cell is blank; export the study again")]
    Blank {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
    },
    /// A cell of a column of numbers is none.
    #[error("column \"{column}\": line {line}: \"{cell}\" is not a number; export the study again")]
    NotANumber {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The cell.
        cell: String,
    },
    /// Answers to another study.
    #[error(
        "column \"config_hash\": the answers of version {} belong to {}, not to the study \"{study}\"; give the study file that was served with this export",
        .config_hash.chars().take(12).collect::<String>(),
        .of.as_ref().map_or_else(|| "another study".to_owned(), |of| format!("the study \"{of}\""))
    )]
    AnotherStudy {
        /// Hash of the study file that was served.
        config_hash: String,
        /// Identifier of the study that was served, if its file is known.
        of: Option<String>,
        /// Identifier of the study of the analysis.
        study: String,
    },
    /// Every trial is left out, or there is none.
    #[error(
        "column \"trial_type\": no trial is left: {people_left_out} of {people} people and {trials_left_out} of {trials} trials are left out{}; collect answers first, or look at the study's exclusions",
        counted(reasons)
    )]
    NoTrial {
        /// People left out.
        people_left_out: usize,
        /// All people.
        people: usize,
        /// Trials left out, of the people used.
        trials_left_out: usize,
        /// All trials of the people used.
        trials: usize,
        /// People and trials left out, by reason.
        reasons: BTreeMap<Reason, usize>,
    },
    /// No trial that is left has an answer.
    #[error(
        "column \"answer\": no answer of a trial is left after the study's exclusions; give an export with answers"
    )]
    NoAnswer,
}

/// Why a table of stimuli cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StimuliError {
    /// It does not say which stimulus a row is about.
    #[error(
        "column \"stimulus\": there is no such column; give the table that `mimique export --stimuli` writes"
    )]
    NoStimulus,
    /// A cell of a column of numbers is none.
    #[error(
        "column \"{column}\": line {line}: \"{cell}\" is not a number; correct it, or leave the cell blank"
    )]
    NotANumber {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The cell.
        cell: String,
    },
}

/// Why tables of faces and courses cannot be used. `table` is `tracks` or `courses`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MimicryError {
    /// A column is absent.
    #[error(
        "column \"{column}\": there is no such column; give the table of {table} that `mimique export` writes"
    )]
    NoColumn {
        /// The table.
        table: &'static str,
        /// The column.
        column: String,
    },
    /// A cell of a column of numbers is none.
    #[error(
        "column \"{column}\": line {line}: \"{cell}\" is not a number; export the table of {table} again"
    )]
    NotANumber {
        /// The table.
        table: &'static str,
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The cell.
        cell: String,
    },
    /// Times that run backwards, or a row without one.
    #[error(
        "column \"time_ms\": line {line}: no time, or none after that of the row before; export the table of {table} again"
    )]
    Time {
        /// The table.
        table: &'static str,
        /// Line of the file, from 1.
        line: usize,
    },
}

impl MimicryError {
    /// The table that is at fault: `tracks` or `courses`.
    pub fn table(&self) -> &'static str {
        match self {
            Self::NoColumn { table, .. }
            | Self::NotANumber { table, .. }
            | Self::Time { table, .. } => table,
        }
    }
}

/// The reasons and their counts, in brackets; empty where there are none.
fn counted(reasons: &BTreeMap<Reason, usize>) -> String {
    let words: Vec<String> =
        reasons.iter().map(|(reason, count)| format!("{}: {count}", reason.english())).collect();
    if words.is_empty() { String::new() } else { format!(" ({})", words.join(", ")) }
}
