//! The forms that are written session by session: `csv`, `json` and `events`. However many sessions a study
//! has, one of them is in memory.

use axum::body::{Body, Bytes};
use mimique_storage::Storage;
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;

use super::csv::{self, Cells};
use super::error::ExportError;
use super::merged::Merged;
use super::sources::Sources;
use super::{Format, Options, choose, lines};

/// A file of an export, piece by piece.
pub(crate) struct Pieces {
    storage: Storage,
    sources: Sources,
    form: Form,
    /// The columns, and the rows of the session that is being written.
    table: Merged,
    has_begun: bool,
    next_session: usize,
    /// How many participants have rows so far.
    pub participants: usize,
    /// Rows, or events, so far.
    pub rows: usize,
}

/// A form that needs no more than one session at a time.
#[derive(Clone, Copy)]
enum Form {
    Csv(Cells),
    Json,
    Events,
}

impl Pieces {
    /// The file of a study in this format; none where the format needs all sessions at once.
    pub async fn open(
        storage: &Storage,
        study_id: Option<&str>,
        format: Format,
        options: Options,
    ) -> Result<Option<Self>, ExportError> {
        let form = match format {
            Format::Csv => Form::Csv(options.cells),
            Format::Json => Form::Json,
            Format::Events => Form::Events,
            Format::Wide | Format::PsychDs => return Ok(None),
        };
        let study_id = choose(storage, study_id).await?;
        let sources = Sources::load(storage, &study_id, options.with_identifiers).await?;
        let table = sources.tidy_columns();
        let (storage, has_begun) = (storage.clone(), false);
        let (next_session, participants, rows) = (0, 0, 0);
        let own =
            Self { storage, sources, form, table, has_begun, next_session, participants, rows };
        Ok(Some(own))
    }

    /// Identifier of the study.
    pub fn study_id(&self) -> &str {
        &self.sources.study_id
    }

    /// The file's name.
    pub fn name(&self) -> String {
        let study = self.study_id();
        match self.form {
            Form::Csv(_) => format!("{study}_responses.csv"),
            Form::Json => format!("{study}_responses.jsonl"),
            Form::Events => format!("{study}_events.jsonl"),
        }
    }

    /// The next piece; none after the last.
    pub async fn next(&mut self) -> Result<Option<Vec<u8>>, ExportError> {
        if !std::mem::replace(&mut self.has_begun, true)
            && let Form::Csv(_) = self.form
        {
            return csv::header(&self.table.columns).map(Some);
        }
        let Some(session) = self.sources.sessions.get(self.next_session) else { return Ok(None) };
        self.next_session += 1;
        if let Form::Events = self.form {
            let (bytes, events) = lines::events(&self.storage, session).await?;
            self.participants += usize::from(events > 0);
            self.rows += events;
            return Ok(Some(bytes));
        }
        self.table.rows.clear();
        self.sources.add_tidy(&self.storage, session, &mut self.table).await?;
        self.participants = self.table.participants;
        self.rows += self.table.rows.len();
        match self.form {
            Form::Csv(cells) => csv::lines(&self.table.rows, cells),
            _ => lines::rows(&self.table),
        }
        .map(Some)
    }

    /// All of it.
    pub async fn whole(&mut self) -> Result<Vec<u8>, ExportError> {
        let mut bytes = Vec::new();
        while let Some(piece) = self.next().await? {
            bytes.extend(piece);
        }
        Ok(bytes)
    }

    /// The body of an answer, which is sent while it is made.
    pub fn into_body(mut self) -> Body {
        let (sender, receiver) = mpsc::channel::<Result<Bytes, ExportError>>(1);
        tokio::spawn(async move {
            loop {
                let piece = match self.next().await {
                    Ok(Some(piece)) => Ok(piece.into()),
                    Ok(None) => break,
                    Err(error) => {
                        tracing::error!("an export broke off: {error}");
                        Err(error)
                    }
                };
                let is_over = piece.is_err();
                // Whoever has gone wants no more of it.
                if sender.send(piece).await.is_err() || is_over {
                    break;
                }
            }
        });
        Body::from_stream(ReceiverStream::new(receiver))
    }
}
