//! Why an avatar file was refused: the place in the file, what is wrong there, and what to do.

/// An avatar file that cannot be used.
///
/// The text reads "PLACE: what is wrong; remedy"; callers put the file's name in front.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file, or a file beside it that it names, could not be read.
    #[error("{place}: cannot be read: {source}; check the path and its permissions")]
    Io {
        /// Which file, as named by the caller or by the avatar file.
        place: String,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// The content is not what the format asks for.
    #[error("{place}: {what}; {remedy}")]
    Broken {
        /// Chunk, JSON path or element.
        place: String,
        /// What is wrong, with the value.
        what: String,
        /// What the user can do.
        remedy: String,
    },
}

impl ReadError {
    /// A refusal with the usual remedy for a damaged file.
    pub(crate) fn damaged(place: impl Into<String>, what: impl Into<String>) -> Self {
        Self::broken(place, what, "export the file again")
    }

    /// A refusal with a remedy of its own.
    pub(crate) fn broken(
        place: impl Into<String>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Broken { place: place.into(), what: what.into(), remedy: remedy.into() }
    }
}
