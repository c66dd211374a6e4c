//! What can be wrong with an arena.

/// Something that is wrong with an arena.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ArenaProblem {
    /// An identifier that cannot stand in file names and tables.
    #[error("{pointer}: {id:?}; write lower-case letters, digits and single hyphens, as in joy-2")]
    Identifier {
        /// Where.
        pointer: String,
        /// The identifier.
        id: String,
    },
    /// Two segments have one identifier, or a segment that of a capture.
    #[error("{pointer}: {id:?} is there twice; give segments and captures names of their own")]
    Repeated {
        /// Where.
        pointer: String,
        /// The identifier.
        id: String,
    },
    /// No capture is called so.
    #[error("{pointer}: there is no capture {capture:?}; there are {}", known.join(", "))]
    NoCapture {
        /// Where.
        pointer: String,
        /// The name.
        capture: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// Frames outside the capture, or none.
    #[error(
        "{pointer}: frames {first} to {end} of a capture of {frames}; give the first frame and the frame after the last, \
         two frames at least"
    )]
    Frames {
        /// Where.
        pointer: String,
        /// First frame.
        first: usize,
        /// Frame after the last.
        end: usize,
        /// Frames of the capture.
        frames: usize,
    },
    /// No segment.
    #[error("/segments: none; name at least one cut of a capture")]
    NoSegments,
    /// A number out of its range.
    #[error("{pointer}: {value}; give {wanted}")]
    Number {
        /// Where.
        pointer: &'static str,
        /// The value.
        value: String,
        /// What is asked for.
        wanted: &'static str,
    },
    /// A file that is not there.
    #[error(
        "{pointer}: {file}: there is no such file in the arena's folder; put it there, or name the right one"
    )]
    NoFile {
        /// Where.
        pointer: String,
        /// The file.
        file: String,
    },
}

/// Why an arena file cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ArenaFileError {
    /// It is no JSON, or not of this form.
    #[error(
        "{pointer}: {problem}; see schema/arena.schema.json beside it for what may stand there"
    )]
    Form {
        /// Where in the file.
        pointer: String,
        /// What is wrong.
        problem: String,
    },
    /// It says what cannot be.
    #[error("{}", lines(.0))]
    Problems(Vec<ArenaProblem>),
}

/// Each problem on a line of its own.
pub(crate) fn lines<P: std::fmt::Display>(problems: &[P]) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
