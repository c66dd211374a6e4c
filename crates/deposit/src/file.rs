//! A file of a deposit: made here, or copied from somewhere.

use std::path::PathBuf;

use serde::Serialize;
use sha2::{Digest as _, Sha256};

/// A file of a deposit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DepositFile {
    /// Its path in the deposit, with `/`.
    pub path: String,
    /// What is in it.
    pub content: Content,
    /// SHA-256, hexadecimal.
    pub sha256: String,
    /// Its size.
    pub bytes: u64,
}

/// What is in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Content {
    /// These bytes.
    Made(Vec<u8>),
    /// The bytes of this file.
    Copied(PathBuf),
}

/// A file cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum NotWritten {
    /// A table.
    #[error("a table cannot be written: {0}; this is a mistake of Mimique's")]
    Csv(#[from] csv::Error),
    /// JSON.
    #[error("JSON cannot be written: {0}; this is a mistake of Mimique's")]
    Json(#[from] serde_json::Error),
    /// The list of what the program is made of.
    #[error("the program's own list of crates cannot be read: {0}; this is a mistake of Mimique's")]
    Lock(#[from] toml::de::Error),
    /// Two files are to stand at one place.
    #[error("{path}: two files are to stand there; this is a mistake of Mimique's")]
    Twice {
        /// The place.
        path: String,
    },
}

impl DepositFile {
    /// A file of these bytes.
    pub fn made(path: impl Into<String>, bytes: Vec<u8>) -> Self {
        let sha256 = hex::encode(Sha256::digest(&bytes));
        let size = bytes.len() as u64;
        Self { path: path.into(), content: Content::Made(bytes), sha256, bytes: size }
    }

    /// The copy of a file that has this hash and size.
    pub fn copied(path: impl Into<String>, from: PathBuf, sha256: String, bytes: u64) -> Self {
        Self { path: path.into(), content: Content::Copied(from), sha256, bytes }
    }
}

/// JSON for people: indented, with a line break at its end.
pub(crate) fn json_bytes(value: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}
