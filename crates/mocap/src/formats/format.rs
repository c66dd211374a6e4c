//! What is known of a file format: each reader's file defines one value of this type.

use std::path::{Path, PathBuf};

use super::source::Source;
use super::text::Lines;
use crate::{Capture, ReadError, ReadOptions, Recording, WeightOptions, WeightsTable, WriteError};

/// A file format of captures, or of weights: its names, how it is recognised, who reads and writes it.
pub struct Format {
    /// Short name, in JSON and of the folder of its samples in `fuzz/corpus`.
    pub id: &'static str,
    /// The name that people use.
    pub name: &'static str,
    /// Endings of its files' names, without the dot, the usual one first.
    pub extensions: &'static [&'static str],
    /// What its files are recognised by, in words for the documentation.
    pub recognised_by: &'static str,
    /// What its reader takes, in words for the documentation.
    pub reads: &'static str,
    /// Whether a file is of this format.
    pub(crate) recognise: Recognise,
    /// The reader.
    pub(crate) read: Read,
    /// The writer, where there is one.
    pub(crate) write: Option<Write>,
}

/// How a format is recognised by content, never by the file's name.
pub(crate) enum Recognise {
    /// By the first 512 bytes.
    Beginning(fn(&[u8]) -> bool),
    /// By the first line of a text that is neither blank nor a comment.
    FirstLine(fn(&str) -> bool),
}

/// A reader.
pub(crate) enum Read {
    /// Markers from bytes.
    Binary(fn(&mut dyn Source, &ReadOptions) -> Result<Recording, ReadError>),
    /// Markers from lines of text.
    Text(fn(&mut Lines<'_>, &ReadOptions) -> Result<Recording, ReadError>),
    /// Weights from bytes, and from what stands beside the file of that path.
    BinaryWeights(WeightsReader),
    /// Weights from lines of text.
    TextWeights(fn(&mut Lines<'_>, &WeightOptions<'_>) -> Result<WeightsTable, ReadError>),
}

/// A reader of weights from bytes.
pub(crate) type WeightsReader =
    fn(&mut dyn Source, Option<&Path>, &WeightOptions<'_>) -> Result<WeightsTable, ReadError>;

/// A writer. It gives the whole file, so that what cannot be written leaves nothing behind.
pub(crate) enum Write {
    /// Of a capture; the name of the file, which some formats hold.
    Capture(fn(&Capture, &str) -> Result<Vec<u8>, WriteError>),
    /// Of weights.
    Weights {
        /// The columns that the format's files have, where it is not free: what is written has these
        /// names.
        columns: Option<&'static [&'static str]>,
        /// Gives the files, each with its path; that of the path given is the last one.
        write: WeightsWriter,
    },
}

/// A writer of weights: the files, each with its path and bytes.
pub(crate) type WeightsWriter = fn(&WeightsTable, &Path) -> Vec<(PathBuf, Vec<u8>)>;

impl Format {
    /// What to tell of a file that was read: what it was taken for.
    pub fn taken_for(&self) -> String {
        format!("read as {}", self.name)
    }

    /// Whether its files hold weights, and no markers.
    pub fn holds_weights(&self) -> bool {
        !matches!(self.read, Read::Binary(_) | Read::Text(_))
    }

    /// How long the ending of a file's name is that asks for this format; `None` where it asks for another.
    pub(crate) fn asked_for_by(&self, path: &Path) -> Option<usize> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let ends =
            |known: &&&str| name.strip_suffix(**known).is_some_and(|rest| rest.ends_with('.'));
        self.extensions.iter().filter(ends).map(|known| known.len()).max()
    }
}

impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Format {}

impl std::fmt::Debug for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id)
    }
}
