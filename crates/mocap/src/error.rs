//! What can go wrong while a file is read: place, what, value and remedy in one sentence.

use std::path::PathBuf;

/// Why a file could not be read. The text is `PLACE: what is wrong, the value; remedy`, without
/// the file's name, which the caller knows.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened.
    #[error("open: {source}; check the path and its permissions")]
    Open {
        /// The path as given.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// The system could not read on in an open file.
    #[error("read: {0}; copy the file again, or check the disk")]
    Read(std::io::Error),
    /// No known format starts like this.
    #[error("byte 0: not a capture in a known format, {found}; give one of {}", names(readable))]
    Unrecognised {
        /// What the file starts with.
        found: String,
        /// The names of the formats that are read.
        readable: Vec<&'static str>,
    },
    /// The file holds blendshape weights where markers are asked for.
    #[error("byte 0: {format} holds no marker; give it as weights, not as a capture")]
    WeightsNotMarkers {
        /// The name of its format.
        format: &'static str,
    },
    /// Not a file of weights.
    #[error("byte 0: no weights in a known format, {found}; give one of {}", names(readable))]
    NotWeights {
        /// What the file starts with.
        found: String,
        /// The names of the formats of weights that are read.
        readable: Vec<&'static str>,
    },
    /// Not a file of an activity.
    #[error("byte 0: no activity in a known format, {found}; give one of {}", names(readable))]
    NotActivity {
        /// What the file starts with.
        found: String,
        /// The names of the formats of activities that are read.
        readable: Vec<&'static str>,
    },
    /// What stands beside the file and belongs to it is wrong.
    #[error("{file}, beside it: {what}; {remedy}")]
    Beside {
        /// Name of the file beside it.
        file: String,
        /// What is wrong, with the value.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A binary file is wrong at a byte.
    #[error("byte {offset}, {section}: {what}; {remedy}")]
    Binary {
        /// Offset from the start of the file.
        offset: u64,
        /// Part of the file, e.g. `parameter section`.
        section: &'static str,
        /// What is wrong, with the value.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A JSON document is wrong at a value.
    #[error("{at}: {what}; {remedy}")]
    Json {
        /// Which value, e.g. `frame 12, weights`.
        at: String,
        /// What is wrong, with the value.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A text file is wrong at a line.
    #[error("line {line}, {section}: {what}; {remedy}")]
    Text {
        /// Line, 1 = the first.
        line: usize,
        /// Part of the line or of the file, e.g. `header` or `column 7`.
        section: String,
        /// What is wrong, with the value.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
}

/// Names as a list in a sentence.
fn names(names: &[&str]) -> String {
    names.join(", ")
}

/// Why a capture cannot be written in a format.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// No format is written under that ending of the file's name.
    #[error("the name ends in {found:?}; end it in {}", extensions.join(" or "))]
    Extension {
        /// The ending.
        found: String,
        /// The endings of the formats that are written, with their dots.
        extensions: Vec<String>,
    },
    /// A label the format cannot hold.
    #[error("marker \"{label}\": {what}; rename the marker")]
    Label {
        /// The label.
        label: String,
        /// What the format cannot hold.
        what: &'static str,
    },
    /// A position the format cannot hold.
    #[error("frame {frame}, marker \"{label}\": {value} does not fit; {remedy}")]
    Position {
        /// Frame, 0 = the first of the capture.
        frame: usize,
        /// Label of the marker.
        label: String,
        /// The coordinate.
        value: f64,
        /// What to do about it.
        remedy: &'static str,
    },
    /// More of something than the format can count.
    #[error("{what}: {count}, the format holds {limit}; {remedy}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How much there is.
        count: usize,
        /// How much the format holds.
        limit: usize,
        /// What to do about it.
        remedy: &'static str,
    },
}

impl ReadError {
    /// An error at a byte of a binary file.
    pub(crate) fn at_byte(
        offset: u64,
        section: &'static str,
        what: impl Into<String>,
        remedy: &'static str,
    ) -> Self {
        Self::Binary { offset, section, what: what.into(), remedy }
    }

    /// An error at a value of a JSON document.
    pub(crate) fn in_json(
        at: impl Into<String>,
        what: impl Into<String>,
        remedy: &'static str,
    ) -> Self {
        Self::Json { at: at.into(), what: what.into(), remedy }
    }

    /// An error at a line of a text file.
    pub(crate) fn at_line(
        line: usize,
        section: impl Into<String>,
        what: impl Into<String>,
        remedy: &'static str,
    ) -> Self {
        Self::Text { line, section: section.into(), what: what.into(), remedy }
    }
}
