//! The main file of an export, piece by piece: however many sessions a study has, and however large they are,
//! a few pieces are in memory.
//!
//! Sessions are read and written by some threads at once, and come out in their order. What is exported is
//! what was there when the export came to a session: its events up to those that the server had then.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::ops::Range;
use std::sync::Arc;

use mimique_session::rows::{Column, WideForm};
use mimique_storage::{SessionRecord, Storage};
use tokio::runtime::Handle;
use tokio::sync::Semaphore;
use tokio::task::JoinHandle;
use tokio_stream::StreamExt as _;

use super::error::ExportError;
use super::layout::{About, Form, Layout, Lines, Rows};
use super::lines::{self, EventLine};
use super::sources::{Sources, as_started};
use super::tracks::{self, TrackRows};
use super::{Format, Options};

/// Sessions that are read from the database at one time: their rows, not their events.
const ON_A_PAGE: u32 = 256;
/// Sessions that are looked at by one task for the columns of the wide form.
const LOOKED_AT: usize = 32;
/// Bytes of a session's events that are one piece.
const LARGE: u64 = 1024 * 1024;
/// Events of a larger session in a piece at most: all of them may be as large as events can be.
const EVENTS_IN_A_PIECE: u64 = 16;

/// Connections that all exports together read by: participants need the others.
static READERS: Semaphore = Semaphore::const_new(3);

/// The main file of an export in the making.
pub(super) struct Pieces {
    storage: Storage,
    options: Options,
    format: Format,
    /// None until it is known which columns there are.
    shared: Option<Arc<Shared>>,
    reading: Reading,
    at_work: VecDeque<AtWork>,
    /// Whose rows came last.
    last_participant: u64,
    /// How many participants have rows so far.
    pub participants: usize,
    /// Rows, or events, so far.
    pub rows: usize,
}

/// What every task needs.
struct Shared {
    storage: Storage,
    written: Written,
    with_identifiers: bool,
    /// Reason of each exclusion that counts, by session key.
    excluded: BTreeMap<i64, String>,
}

/// What is written of sessions.
enum Written {
    Table(Box<Layout>),
    Events,
    Tracks,
}

/// A piece that is being made.
struct AtWork {
    participant: u64,
    lines: JoinHandle<Result<Lines, ExportError>>,
}

/// The sessions of a study, page by page.
struct Reading {
    study_id: String,
    page: VecDeque<SessionRecord>,
    last: u64,
    /// Where the events of each session end that were looked at for the columns: what has come since is left
    /// out, since it has none. None where columns do not depend on what was answered.
    ends: Option<HashMap<i64, u64>>,
    /// A session that is too large for one piece, and which of its events come next.
    large: Option<(SessionRecord, u64)>,
}

impl Pieces {
    /// The file of a study in this format.
    pub fn new(storage: &Storage, study_id: &str, format: Format, options: Options) -> Self {
        Self {
            storage: storage.clone(),
            options,
            format,
            shared: None,
            reading: Reading::of(study_id),
            at_work: VecDeque::new(),
            last_participant: 0,
            participants: 0,
            rows: 0,
        }
    }

    /// The next piece; none after the last.
    pub async fn next(&mut self, sources: &Sources) -> Result<Option<Vec<u8>>, ExportError> {
        let shared = match &self.shared {
            Some(shared) => Arc::clone(shared),
            None => return self.begin(sources).await.map(Some),
        };
        while self.at_work.len() <= tasks() {
            let Some((session, sequences)) = self.reading.next(&self.storage, self.format).await?
            else {
                break;
            };
            let participant = session.participant;
            let shared = Arc::clone(&shared);
            let lines = in_thread(async move { lines_of(&shared, &session, sequences).await });
            self.at_work.push_back(AtWork { participant, lines });
        }
        let Some(AtWork { participant, lines }) = self.at_work.pop_front() else { return Ok(None) };
        let Lines { bytes, rows } = joined(lines.await)?;
        if rows > 0 && participant != self.last_participant {
            self.last_participant = participant;
            self.participants += 1;
        }
        self.rows += rows;
        Ok(Some(bytes))
    }

    /// The columns of the table, once they are known; none where events are exported.
    pub fn columns(&self) -> &[Column] {
        match self.shared.as_deref() {
            Some(Shared { written: Written::Table(layout), .. }) => layout.columns(),
            _ => &[],
        }
    }

    /// What stands before the rows, once it is known which columns they have.
    async fn begin(&mut self, sources: &Sources) -> Result<Vec<u8>, ExportError> {
        let identifiers = match self.options.with_identifiers {
            true => self.storage.recruitment_names(&sources.study_id).await?,
            false => Vec::new(),
        };
        let csv = Form::Csv(self.options.cells);
        let written = match self.format {
            Format::Events => Written::Events,
            Format::Tracks => Written::Tracks,
            Format::Csv | Format::PsychDs => {
                Written::Table(Box::new(Layout::tidy(csv, sources, &identifiers)))
            }
            Format::Json => {
                Written::Table(Box::new(Layout::tidy(Form::JsonLines, sources, &identifiers)))
            }
            Format::Wide => {
                let (forms, ends) = wide_forms(&self.storage, sources).await?;
                self.reading.ends = Some(ends);
                let forms = forms.into_iter().map(|(hash, form)| (hash, Rows::Wide(form)));
                Written::Table(Box::new(Layout::new(csv, &sources.study_id, forms, &identifiers)))
            }
        };
        let header = match &written {
            Written::Table(layout) => layout.header()?,
            Written::Events => Vec::new(),
            Written::Tracks => tracks::header()?,
        };
        let excluded = exclusions(&self.storage, &sources.study_id).await?;
        self.shared = Some(Arc::new(Shared {
            storage: self.storage.clone(),
            written,
            with_identifiers: self.options.with_identifiers,
            excluded,
        }));
        Ok(header)
    }
}

impl Reading {
    fn of(study_id: &str) -> Self {
        let (page, last, ends, large) = Default::default();
        Self { study_id: study_id.to_owned(), page, last, ends, large }
    }

    /// The next session, or the next part of one, and which of its events.
    async fn next(
        &mut self,
        storage: &Storage,
        format: Format,
    ) -> Result<Option<(SessionRecord, Range<u64>)>, ExportError> {
        if let Some((session, begin)) = self.large.take() {
            return Ok(Some(self.part(session, begin)));
        }
        loop {
            let Some(session) = self.session(storage).await? else { return Ok(None) };
            let end = match &self.ends {
                Some(ends) => ends.get(&session.key).copied(),
                None => Some(session.next_sequence),
            };
            // Who came after the columns were found has none of them.
            let Some(end) = end else { continue };
            if format == Format::Events && session.stored_bytes > LARGE {
                return Ok(Some(self.part(session, 0)));
            }
            return Ok(Some((session, 0..end)));
        }
    }

    /// The part of a large session that begins there; what is behind it comes next.
    fn part(&mut self, session: SessionRecord, begin: u64) -> (SessionRecord, Range<u64>) {
        let on_average = session.stored_bytes / session.event_count.max(1);
        let events = (LARGE / on_average.max(1)).clamp(1, EVENTS_IN_A_PIECE);
        let end = (begin + events).min(session.next_sequence);
        if end < session.next_sequence {
            self.large = Some((session.clone(), end));
        }
        (session, begin..end)
    }

    /// The next session.
    async fn session(&mut self, storage: &Storage) -> Result<Option<SessionRecord>, ExportError> {
        if self.page.is_empty() {
            self.page = storage.sessions_after(&self.study_id, self.last, ON_A_PAGE).await?.into();
            self.last = self.page.back().map_or(self.last, |session| session.participant);
        }
        Ok(self.page.pop_front())
    }
}

/// The rows of a session, or the lines of some of its events.
async fn lines_of(
    shared: &Shared,
    session: &SessionRecord,
    sequences: Range<u64>,
) -> Result<Lines, ExportError> {
    let (storage, started) = (&shared.storage, as_started(session));
    let layout = match &shared.written {
        Written::Table(layout) => layout,
        Written::Tracks => {
            let mut rows = TrackRows::default();
            let mut events = storage.stored_events(session.key, sequences);
            while let Some(event) = events.next().await {
                let event = event?;
                // What no page of the plan could have sent counts in no table.
                if event.misfit.is_none() {
                    rows.add(&started, &event.body)?;
                }
            }
            return Ok(rows.finish());
        }
        Written::Events => {
            let mut lines = Lines::default();
            let mut events = storage.stored_events(session.key, sequences);
            while let Some(event) = events.next().await {
                let event = event?;
                let line = EventLine {
                    started: &started,
                    sequence: event.sequence,
                    at_ms: event.at_ms,
                    body: &event.body,
                    misfit: event.misfit.as_deref(),
                };
                lines::add_event(&mut lines.bytes, &line)?;
                lines.rows += 1;
            }
            return Ok(lines);
        }
    };
    let record = storage.record(session.key, sequences.end).await?;
    let identifiers = match shared.with_identifiers {
        true => storage.session_recruitment(session.key).await?,
        false => BTreeMap::new(),
    };
    let excluded = shared.excluded.get(&session.key).cloned();
    layout.lines(&started, &record, &About { excluded, identifiers })
}

/// The wide form of each version with the columns of all its sessions, and where the events of each session
/// end that were looked at.
async fn wide_forms(
    storage: &Storage,
    sources: &Sources,
) -> Result<(Vec<(String, WideForm)>, HashMap<i64, u64>), ExportError> {
    let mut forms: Vec<(String, WideForm)> = Vec::new();
    for version in &sources.versions {
        let form = WideForm::new(&version.study, &version.clips);
        forms.push((version.config_hash.clone(), form));
    }
    let empty: Arc<HashMap<String, WideForm>> = Arc::new(forms.iter().cloned().collect());
    let (mut reading, mut ends) = (Reading::of(&sources.study_id), HashMap::new());
    let mut at_work: VecDeque<JoinHandle<_>> = VecDeque::new();
    loop {
        let mut sessions = Vec::with_capacity(LOOKED_AT);
        while sessions.len() < LOOKED_AT
            && let Some(session) = reading.session(storage).await?
        {
            sources.version(&session.config_hash)?;
            ends.insert(session.key, session.next_sequence);
            sessions.push(session);
        }
        if !sessions.is_empty() {
            let (storage, empty) = (storage.clone(), Arc::clone(&empty));
            at_work
                .push_back(in_thread(async move { looked_at(&storage, &empty, sessions).await }));
            if at_work.len() <= tasks() {
                continue;
            }
        }
        let Some(task) = at_work.pop_front() else { return Ok((forms, ends)) };
        for (hash, more) in joined(task.await)? {
            if let Some((_, form)) = forms.iter_mut().find(|(known, _)| *known == hash) {
                form.join(more);
            }
        }
    }
}

/// The forms of the versions of some sessions, with the columns of these.
async fn looked_at(
    storage: &Storage,
    empty: &HashMap<String, WideForm>,
    sessions: Vec<SessionRecord>,
) -> Result<BTreeMap<String, WideForm>, ExportError> {
    let mut found: BTreeMap<String, WideForm> = BTreeMap::new();
    for session in sessions {
        let record = storage.record_without_plays(session.key, session.next_sequence).await?;
        if let Some(form) = empty.get(&session.config_hash) {
            found.entry(session.config_hash).or_insert_with(|| form.clone()).look_at(&record);
        }
    }
    Ok(found)
}

/// The reason of each exclusion that counts now, by session key.
pub(crate) async fn exclusions(
    storage: &Storage,
    study_id: &str,
) -> Result<BTreeMap<i64, String>, ExportError> {
    let mut excluded = BTreeMap::new();
    for change in storage.exclusions(study_id).await? {
        match change.reason {
            Some(reason) => excluded.insert(change.session_key, reason),
            None => excluded.remove(&change.session_key),
        };
    }
    Ok(excluded)
}

/// Tasks at once.
fn tasks() -> usize {
    std::thread::available_parallelism().map_or(1, |count| count.get().clamp(1, 3))
}

/// Runs a task on a thread of its own: participants' requests do not wait for it.
fn in_thread<T: Send + 'static>(
    task: impl Future<Output = Result<T, ExportError>> + Send + 'static,
) -> JoinHandle<Result<T, ExportError>> {
    let runtime = Handle::current();
    let in_turn = async move {
        let closed = |_| ExportError::Form("the queue of readers is closed".to_owned());
        let _turn = READERS.acquire().await.map_err(closed)?;
        task.await
    };
    tokio::task::spawn_blocking(move || runtime.block_on(in_turn))
}

fn joined<T>(
    outcome: Result<Result<T, ExportError>, tokio::task::JoinError>,
) -> Result<T, ExportError> {
    outcome.map_err(|error| ExportError::Form(error.to_string()))?
}
