//! An export as its files come: the main one piece by piece, then what explains it.

use std::collections::VecDeque;

use mimique_storage::Storage;

use super::error::ExportError;
use super::exported::Exported;
use super::pieces::Pieces;
use super::sources::Sources;
use super::{Format, Options, choose, psych_ds};

/// An export in the making: nothing is read of the study's sessions before it is asked for.
pub struct Export {
    format: Format,
    sources: Sources,
    pieces: Pieces,
    stage: Stage,
}

enum Stage {
    /// Nothing has come yet.
    Begin,
    /// The main file comes.
    Main,
    /// The files behind it.
    Rest(VecDeque<Part>),
}

/// What comes next of an export.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// A file of this path begins.
    File(String),
    /// More of the file.
    Bytes(Vec<u8>),
}

impl Export {
    /// An export of a study; of the only one in the database if none is named.
    ///
    /// # Errors
    /// There is no such study, or there are several and none is named; storage failed.
    pub async fn open(
        storage: &Storage,
        study_id: Option<&str>,
        format: Format,
        options: Options,
    ) -> Result<Self, ExportError> {
        let study_id = choose(storage, study_id).await?;
        let sources = Sources::load(storage, &study_id).await?;
        let pieces = Pieces::new(storage, &study_id, format, options);
        Ok(Self { format, sources, pieces, stage: Stage::Begin })
    }

    /// Identifier of the study.
    pub fn study_id(&self) -> &str {
        &self.sources.study_id
    }

    /// The format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The path of the main file: its name, or where it stands in its folder.
    pub fn main_file(&self) -> String {
        main_file(self.format, self.study_id())
    }

    /// How many participants have rows, of what has come so far.
    pub fn participants(&self) -> usize {
        self.pieces.participants
    }

    /// How many rows (or events) have come so far.
    pub fn rows(&self) -> usize {
        self.pieces.rows
    }

    /// What comes next; none at the end.
    ///
    /// # Errors
    /// Storage failed, or what is stored is damaged.
    pub async fn next(&mut self) -> Result<Option<Part>, ExportError> {
        match &mut self.stage {
            Stage::Begin => {
                self.stage = Stage::Main;
                Ok(Some(Part::File(self.main_file())))
            }
            Stage::Main => {
                if let Some(bytes) = self.pieces.next(&self.sources).await? {
                    return Ok(Some(Part::Bytes(bytes)));
                }
                let mut rest = self.rest()?;
                let next = rest.pop_front();
                self.stage = Stage::Rest(rest);
                Ok(next)
            }
            Stage::Rest(rest) => Ok(rest.pop_front()),
        }
    }

    /// The files that explain the main one: they say how many rows it has.
    fn rest(&self) -> Result<VecDeque<Part>, ExportError> {
        if self.format != Format::PsychDs {
            return Ok(VecDeque::new());
        }
        let counts = (self.pieces.participants, self.pieces.rows);
        let files = psych_ds::explaining(&self.sources, self.pieces.columns(), counts)?;
        let parts = |(path, bytes)| [Part::File(path), Part::Bytes(bytes)];
        Ok(files.into_iter().flat_map(parts).collect())
    }

    /// All of it, in memory.
    ///
    /// # Errors
    /// Those of [`Self::next`].
    pub async fn collect(mut self) -> Result<Exported, ExportError> {
        let mut files: Vec<(String, Vec<u8>)> = Vec::new();
        while let Some(part) = self.next().await? {
            match part {
                Part::File(path) => files.push((path, Vec::new())),
                Part::Bytes(bytes) => {
                    if let Some((_, file)) = files.last_mut() {
                        file.extend(bytes);
                    }
                }
            }
        }
        files.sort();
        let (participants, rows) = (self.participants(), self.rows());
        Ok(Exported { study_id: self.study_id().to_owned(), files, participants, rows })
    }
}

/// The path of the main file of an export.
pub(super) fn main_file(format: Format, study_id: &str) -> String {
    match format {
        Format::Csv => format!("{study_id}_responses.csv"),
        Format::Wide => format!("{study_id}_wide.csv"),
        Format::Json => format!("{study_id}_responses.jsonl"),
        Format::Events => format!("{study_id}_events.jsonl"),
        Format::Tracks => format!("{study_id}_tracks.csv"),
        Format::PsychDs => mimique_session::rows::psych_ds_data_file(study_id),
    }
}
