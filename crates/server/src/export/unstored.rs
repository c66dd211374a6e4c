//! Exports of sessions that lie in no database, such as simulated ones: the same bytes as if they had
//! been stored and exported.

use std::collections::BTreeMap;

use mimique_session::Record;
use mimique_session::rows::WideForm;
use mimique_session::wire::{Event, SessionStarted};
use mimique_study::ClipSource;
use mimique_study::{StudyFileError, config_hash};
use serde_json::Value;

use super::csv::Cells;
use super::error::ExportError;
use super::exported::Exported;
use super::format::Format;
use super::layout::{About, Form, Layout, Lines, Rows};
use super::lines::{EventLine, add_event};
use super::parts::main_file;
use super::psych_ds;
use super::sources::{Sources, Version};
use super::tracks::{self, TrackRows};

/// Writes sessions one by one, in any number of threads, and joins them to an export.
pub struct Unstored {
    sources: Sources,
    format: Format,
    tidy: Layout,
}

/// One session, written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Written {
    lines: Lines,
    /// The wide form needs all sessions at once.
    session: Option<(SessionStarted, Record)>,
}

const CSV: Form = Form::Csv(Cells::AsTheyAre);

impl Unstored {
    /// `file` is the study file, `clips` are its clips as prepared: what is not prepared has no
    /// provenance in the export.
    ///
    /// # Errors
    /// The file is no study.
    pub fn new(
        file: Value,
        clips: BTreeMap<String, ClipSource>,
        format: Format,
    ) -> Result<Self, StudyFileError> {
        let study = mimique_study::Study::from_value(&file)?;
        let study_id = study.id.clone();
        let version =
            Version { config_hash: config_hash(&file), file, study, clips, measures: Vec::new() };
        let sources = Sources { study_id, versions: vec![version] };
        let form = if format == Format::Json { Form::JsonLines } else { CSV };
        let tidy = Layout::tidy(form, &sources, &[]);
        Ok(Self { sources, format, tidy })
    }

    /// The configuration hash that sessions must have.
    pub fn config_hash(&self) -> &str {
        self.sources.versions.first().map_or("", |version| version.config_hash.as_str())
    }

    /// Writes a session. One without events (it was taken back) leaves nothing.
    ///
    /// # Errors
    /// It is of another version.
    pub fn write(
        &self,
        started: &SessionStarted,
        events: &[Event],
    ) -> Result<Written, ExportError> {
        let mut written = Written::default();
        match self.format {
            _ if events.is_empty() => {}
            Format::Events => {
                for event in events {
                    let (sequence, at_ms) = (event.sequence, event.at_ms);
                    let body = &event.body.to_string();
                    let line = EventLine { started, sequence, at_ms, body, misfit: None };
                    add_event(&mut written.lines.bytes, &line)?;
                }
                written.lines.rows = events.len();
            }
            Format::Tracks => {
                let mut rows = TrackRows::default();
                for event in events {
                    rows.add(started, &event.body.to_string())?;
                }
                written.lines = rows.finish();
            }
            Format::Wide => {
                written.session = Some((started.clone(), Record::of(None, events)));
            }
            Format::Csv | Format::Json | Format::PsychDs => {
                let record = Record::of(None, events);
                written.lines = self.tidy.lines(started, &record, &About::default())?;
            }
        }
        Ok(written)
    }

    /// Joins sessions in the order of their participants.
    ///
    /// # Errors
    /// A file of the export cannot be put together.
    pub fn join(
        self,
        sessions: impl IntoIterator<Item = Written>,
    ) -> Result<Exported, ExportError> {
        let study_id = self.sources.study_id.clone();
        let (mut participants, mut rows) = (0, 0);
        let mut bytes = match self.format {
            Format::Events | Format::Wide => Vec::new(),
            Format::Tracks => tracks::header()?,
            Format::Csv | Format::Json | Format::PsychDs => self.tidy.header()?,
        };
        let mut whole = Vec::new();
        for Written { lines, session } in sessions {
            participants += usize::from(lines.rows > 0);
            rows += lines.rows;
            bytes.extend(lines.bytes);
            whole.extend(session);
        }
        if self.format == Format::Wide {
            Lines { bytes, rows } = self.wide(&whole)?;
            participants = rows;
        }
        let mut files = vec![(main_file(self.format, &study_id), bytes)];
        if self.format == Format::PsychDs {
            let counts = (participants, rows);
            files.extend(psych_ds::explaining(&self.sources, self.tidy.columns(), counts)?);
            files.sort();
        }
        Ok(Exported { study_id, files, participants, rows })
    }

    /// The wide form of all sessions.
    fn wide(&self, sessions: &[(SessionStarted, Record)]) -> Result<Lines, ExportError> {
        let version = self.sources.latest()?;
        let mut form = WideForm::new(&version.study, &version.clips);
        sessions.iter().for_each(|(_, record)| form.look_at(record));
        let forms = [(version.config_hash.clone(), Rows::Wide(form))];
        let layout = Layout::new(CSV, &self.sources.study_id, forms, &[]);
        let mut all = Lines { bytes: layout.header()?, rows: 0 };
        for (started, record) in sessions {
            let Lines { bytes, rows } = layout.lines(started, record, &About::default())?;
            all.bytes.extend(bytes);
            all.rows += rows;
        }
        Ok(all)
    }
}
