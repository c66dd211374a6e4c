//! The forms of an export.

/// Form of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Tidy CSV.
    Csv,
    /// Wide CSV.
    Wide,
    /// Tidy rows as JSON lines.
    Json,
    /// Stored events as JSON lines.
    Events,
    /// Participants' faces, as CSV.
    Tracks,
    /// A Psych-DS data set.
    PsychDs,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 6] =
        [Self::Csv, Self::Wide, Self::Json, Self::Events, Self::Tracks, Self::PsychDs];

    /// Its name on the command line and in addresses.
    pub fn word(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Wide => "wide",
            Self::Json => "json",
            Self::Events => "events",
            Self::Tracks => "tracks",
            Self::PsychDs => "psych-ds",
        }
    }

    /// Whether it is a folder of several files.
    pub fn is_folder(self) -> bool {
        self == Self::PsychDs
    }

    /// The format of this name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.word() == word)
    }
}
