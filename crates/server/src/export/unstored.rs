//! Exports of sessions that lie in no database, such as simulated ones: the same bytes as if they had
//! been stored and exported.

use std::collections::BTreeMap;

use mimique_session::rows::{self, Column, SessionRecord};
use mimique_session::wire::{Event, SessionStarted};
use mimique_study::ClipSource;
use mimique_study::{StudyFileError, config_hash};
use serde_json::Value;

use super::csv::{self, Cells};
use super::error::ExportError;
use super::exported::Exported;
use super::format::Format;
use super::lines::{add_event, add_row};
use super::merged::Merged;
use super::psych_ds;
use super::sources::{Sources, Version};

/// Writes sessions one by one, in any number of threads, and joins them to an export.
pub struct Unstored {
    sources: Sources,
    format: Format,
    columns: Vec<Column>,
}

/// One session, written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Written {
    bytes: Vec<u8>,
    rows: usize,
    /// The wide form needs all sessions at once.
    session: Option<(SessionStarted, Vec<Event>)>,
}

impl Unstored {
    /// `file` is the study file, `clips` are its clips as prepared: what is not prepared has no
    /// provenance in the export.
    pub fn new(
        file: Value,
        clips: BTreeMap<String, ClipSource>,
        format: Format,
    ) -> Result<Self, StudyFileError> {
        let study = mimique_study::Study::from_value(&file)?;
        let columns = Merged::of_everybody(rows::tidy(&study, &clips, []), 0).columns;
        let study_id = study.id.clone();
        let version = Version { config_hash: config_hash(&file), file, study, clips };
        Ok(Self { sources: Sources::without_storage(study_id, version), format, columns })
    }

    /// The configuration hash that sessions must have.
    pub fn config_hash(&self) -> &str {
        self.sources.versions.first().map_or("", |version| version.config_hash.as_str())
    }

    /// Writes a session. One without events (it was taken back) leaves nothing.
    pub fn write(
        &self,
        started: &SessionStarted,
        events: &[Event],
    ) -> Result<Written, ExportError> {
        if events.is_empty() {
            return Ok(Written::default());
        }
        let version = self.sources.latest()?;
        let mut written = Written::default();
        match self.format {
            Format::Events => {
                for event in events {
                    add_event(&mut written.bytes, started, event, None)?;
                }
                written.rows = events.len();
            }
            Format::Wide => {
                written.session = Some((started.clone(), without_frames(events)));
            }
            Format::Csv | Format::Json | Format::PsychDs => {
                let record = SessionRecord { started, events };
                let table = rows::tidy(&version.study, &version.clips, [record]);
                let rows = Merged::of_everybody(table, 1).rows;
                written.rows = rows.len();
                match self.format {
                    Format::Json => {
                        for row in &rows {
                            add_row(&mut written.bytes, &self.columns, row)?;
                        }
                    }
                    _ => written.bytes = csv::rows(&rows)?,
                }
            }
        }
        Ok(written)
    }

    /// Joins sessions in the order of their participants.
    pub fn join(
        self,
        sessions: impl IntoIterator<Item = Written>,
    ) -> Result<Exported, ExportError> {
        let study_id = self.sources.study_id.clone();
        let (mut bytes, mut rows, mut participants) = (Vec::new(), 0, 0);
        if matches!(self.format, Format::Csv | Format::PsychDs) {
            bytes = csv::header(&self.columns)?;
        }
        let mut whole = Vec::new();
        for session in sessions {
            participants += usize::from(session.rows > 0);
            rows += session.rows;
            bytes.extend(session.bytes);
            whole.extend(session.session);
        }
        let stem = format!("{study_id}_responses");
        let files = match self.format {
            Format::Csv => vec![(format!("{stem}.csv"), bytes)],
            Format::Json => vec![(format!("{stem}.jsonl"), bytes)],
            Format::Events => vec![(format!("{study_id}_events.jsonl"), bytes)],
            Format::PsychDs => {
                psych_ds::files(&self.sources, &self.columns, bytes, (participants, rows))?
            }
            Format::Wide => {
                let version = self.sources.latest()?;
                let records =
                    whole.iter().map(|(started, events)| SessionRecord { started, events });
                let table = rows::wide(&version.study, &version.clips, records);
                (participants, rows) = (table.rows.len(), table.rows.len());
                let merged = Merged::of_everybody(table, participants);
                vec![(format!("{study_id}_wide.csv"), csv::table(&merged, Cells::AsTheyAre)?)]
            }
        };
        Ok(Exported { study_id, files, participants, rows })
    }
}

/// The wide form has no frames; without them a session is a hundredth of its size.
fn without_frames(events: &[Event]) -> Vec<Event> {
    let mut events = events.to_vec();
    for event in &mut events {
        if let Some(frames) = event.body.pointer_mut("/log/frames") {
            *frames = Value::Array(Vec::new());
        }
    }
    events
}
