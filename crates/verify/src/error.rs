//! What is wrong with a folder of cases, as values that name file, place and remedy.

use std::path::{Path, PathBuf};

/// Why cases cannot be read. A number that is computed wrongly is no error but a wrong case.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// A file or folder cannot be read.
    #[error("{}: cannot be read ({why}); check the path and its permissions", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system says.
        why: String,
    },
    /// A file in the place of a folder.
    #[error("{}: a file, and cases are folders; give the folder that holds it", file.display())]
    NoFolder {
        /// The file.
        file: PathBuf,
    },
    /// A text is not JSON.
    #[error("{}: line {line}, column {column}: no JSON ({why}); copy the file again", file.display())]
    Json {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What the reader says.
        why: String,
    },
    /// A part of a JSON document is missing or something else.
    #[error(
        "{}: {place}: {found} where {wanted} is needed; correct the case as its README says",
        file.display()
    )]
    Part {
        /// The file.
        file: PathBuf,
        /// Where, as a JSON pointer.
        place: String,
        /// What stands there.
        found: String,
        /// What must stand there.
        wanted: &'static str,
    },
    /// A cell of a table is something else.
    #[error(
        "{}: line {line}, column {column}: {found:?} where {wanted} is needed; correct the case as \
         its README says",
        file.display()
    )]
    Cell {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What stands there.
        found: String,
        /// What must stand there.
        wanted: &'static str,
    },
    /// What a reader of avatars, captures, marker maps or ELAN documents says of a file.
    #[error("{}: {why}", file.display())]
    File {
        /// The file.
        file: PathBuf,
        /// What it says, with a remedy.
        why: String,
    },
    /// A folder holds no case that is known.
    #[error(
        "{}: holds no case that is known; give a folder of cases ({})",
        folder.display(),
        families.join(", ")
    )]
    NoCase {
        /// The folder.
        folder: PathBuf,
        /// The families of cases that are known.
        families: Vec<&'static str>,
    },
}

impl VerifyError {
    /// What the system says of a file.
    pub(crate) fn read(file: &Path, error: &std::io::Error) -> Self {
        Self::Read { file: file.to_owned(), why: error.to_string() }
    }

    /// What a reader says of a file.
    pub(crate) fn file(file: &Path, error: &dyn std::fmt::Display) -> Self {
        Self::File { file: file.to_owned(), why: error.to_string() }
    }
}
