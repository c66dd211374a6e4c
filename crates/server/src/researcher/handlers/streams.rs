//! Streams of server-sent events: that something of a study has changed, for its dashboard; and each event that a
//! participant's page has stored, for a laboratory's own tools.

use std::collections::{BTreeMap, BTreeSet};
use std::convert::Infallible;
use std::time::Duration;

use axum::extract::{Path, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use mimique_session::wire::Event as Stored;
use mimique_storage::{Role, SessionState, StorageError};
use serde::Deserialize;
use serde_json::json;
use tokio::sync::mpsc;
use tokio::time::Instant;
use tokio_stream::wrappers::ReceiverStream;

use crate::accounts::identity::Researcher;
use crate::error::Error;
use crate::http::extract::Asked;
use crate::researcher::dashboard::session_sums::FORM;
use crate::state::App;

/// A stream goes on for so long after its reader has lost the right to it, however busy the study is.
const RECHECK: Duration = Duration::from_secs(2);

/// Longest name of an event in a stream, bytes.
const LONGEST_NAME: usize = 64;

/// No beat is this one.
const NEVER: &str = "never";

/// A line whenever something of the study has changed; the page then fetches what it shows.
pub(crate) async fn live(
    State(app): State<App>,
    Path(study): Path<String>,
    headers: HeaderMap,
    who: Researcher,
) -> Result<Response, Error> {
    may_read(&app, &who, &study, Role::Viewer)?;
    stream(app, headers, &who, study, Role::Viewer, Feed::Changes { last: NEVER.to_owned() })
}

/// Where a stream of events begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum From {
    /// With what is stored from now on.
    #[default]
    Now,
    /// With everything that is stored.
    Beginning,
}

#[derive(Deserialize)]
pub(crate) struct EventsQuery {
    #[serde(default)]
    from: From,
}

/// Each event of a study's sessions, as soon as it is stored (within a second): `event` is its type, or `event` where
/// the type is no plain word, `id` `PARTICIPANT.SEQUENCE`, `data` the participant's number, condition, stage and version of the study with the event.
pub(crate) async fn events(
    State(app): State<App>,
    Path(study): Path<String>,
    Asked(query): Asked<EventsQuery>,
    headers: HeaderMap,
    who: Researcher,
) -> Result<Response, Error> {
    may_read(&app, &who, &study, Role::Analyst)?;
    // Looked up before the answer: what is stored after it belongs to the stream, however late its first look is.
    let mut sent = BTreeMap::new();
    if query.from == From::Now {
        for state in app.storage.session_states(&study, FORM).await? {
            let before = state.counted.event_count;
            sent.insert(state.key, Sent { before, sequences: BTreeSet::new() });
        }
    }
    stream(app, headers, &who, study, Role::Analyst, Feed::Events { sent })
}

/// An error unless the study exists and the reader may see so much of it.
fn may_read(app: &App, who: &Researcher, study: &str, role: Role) -> Result<(), Error> {
    who.needs_in(study, role)?;
    app.study(study)?;
    Ok(())
}

/// What a stream sends.
enum Feed {
    /// That something has changed.
    Changes {
        /// The beat that was sent last.
        last: String,
    },
    /// The events themselves.
    Events {
        /// What need not be sent of each session, by its key.
        sent: BTreeMap<i64, Sent>,
    },
}

/// Which events of a session need not be sent.
#[derive(Default)]
struct Sent {
    /// Those before this one were there when the stream began.
    before: u64,
    sequences: BTreeSet<u64>,
}

impl Feed {
    /// What is to be sent at a beat, a session at a time: nothing once all is sent.
    async fn lines(
        &mut self,
        app: &App,
        study: &str,
        beat: &str,
    ) -> Result<Vec<Event>, StorageError> {
        let sent = match self {
            Self::Changes { last } if last == beat => return Ok(Vec::new()),
            Self::Changes { last } => {
                beat.clone_into(last);
                return Ok(vec![Event::default().event("changed").data(beat)]);
            }
            Self::Events { sent } => sent,
        };
        let states = app.storage.session_states(study, FORM).await?;
        for state in states.iter().filter(|state| !state.is_deleted) {
            let stored = state.counted.event_count;
            let known = sent.entry(state.key).or_default();
            if stored <= known.before + known.sequences.len() as u64 {
                continue;
            }
            let mut events = app.storage.events(state.key).await?;
            events.retain(|event| {
                event.sequence >= known.before && known.sequences.insert(event.sequence)
            });
            if !events.is_empty() {
                return Ok(events.iter().map(|event| line(state, event)).collect());
            }
        }
        Ok(Vec::new())
    }
}

fn line(state: &SessionState, event: &Stored) -> Event {
    let kind = event.body["type"].as_str().filter(|kind| is_word(kind)).unwrap_or("event");
    let data = json!({
        "participant": state.participant,
        "condition": state.condition,
        "stage": state.stage,
        "config_hash": state.config_hash,
        "event": event,
    });
    let id = format!("{}.{}", state.participant, event.sequence);
    Event::default().event(kind).id(id).data(data.to_string())
}

/// Whether a type can name an event of a stream. Pages of participants send any text as the type: a line break in it
/// would end the field, and the writer of the stream panics on one.
fn is_word(kind: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.".contains(&byte);
    !kind.is_empty() && kind.len() <= LONGEST_NAME && kind.bytes().all(is_plain)
}

/// The right of a stream's reader, which can end while the stream is open: by a log-out, a revoked token, a disabled
/// account or a lower role.
struct Right {
    app: App,
    headers: HeaderMap,
    study: String,
    role: Role,
    /// When it has to be checked again.
    expires: Instant,
}

impl Right {
    /// Whether the reader may go on; the database is asked once in [`RECHECK`].
    async fn holds(&mut self) -> bool {
        if Instant::now() < self.expires {
            return true;
        }
        self.expires = Instant::now() + RECHECK;
        let reader = Researcher::of(&self.app, &self.headers).await;
        reader.and_then(|reader| reader.needs_in(&self.study, self.role)).is_ok()
    }
}

/// Sends lines for as long as the reader has the right to them; whether all were taken.
async fn send_all(
    sender: &mpsc::Sender<Result<Event, Infallible>>,
    lines: Vec<Event>,
    right: &mut Right,
) -> bool {
    for line in lines {
        // A reader that takes nothing is not waited for beyond its right.
        let place = loop {
            if !right.holds().await {
                return false;
            }
            match tokio::time::timeout_at(right.expires, sender.reserve()).await {
                Ok(Ok(place)) => break place,
                Ok(Err(_)) => return false,
                Err(_) => {}
            }
        };
        place.send(Ok(line));
    }
    true
}

/// A stream for as long as its reader has the role.
fn stream(
    app: App,
    headers: HeaderMap,
    who: &Researcher,
    study: String,
    role: Role,
    mut feed: Feed,
) -> Result<Response, Error> {
    let place = app.pulse.place(who.account.key).ok_or(Error::TooManyStreams)?;
    let mut beats = app.pulse.listen();
    let (sender, receiver) = mpsc::channel::<Result<Event, Infallible>>(4);
    let mut right =
        Right { app: app.clone(), headers, study, role, expires: Instant::now() + RECHECK };
    tokio::spawn(async move {
        let _place = place;
        let mut last = None;
        loop {
            let now = beats.borrow_and_update().get(&right.study).cloned().unwrap_or_default();
            while last.as_ref() != Some(&now) {
                if !right.holds().await {
                    return;
                }
                // A database that does not answer is asked again at the next change.
                let Ok(lines) = feed.lines(&app, &right.study, &now).await else { break };
                if lines.is_empty() {
                    last = Some(now);
                    break;
                }
                if !send_all(&sender, lines, &mut right).await {
                    return;
                }
            }
            tokio::select! {
                changed = beats.changed() => if changed.is_err() { break },
                () = tokio::time::sleep_until(right.expires) => {}
                () = app.pulse.stopped() => break,
                () = sender.closed() => break,
            }
            // Asked after every turn: a busy study does not put the question off.
            if !right.holds().await {
                break;
            }
        }
    });
    let stream = Sse::new(ReceiverStream::new(receiver));
    let mut response = stream.keep_alive(KeepAlive::default()).into_response();
    // Proxies must not gather what is to be seen at once.
    let name = HeaderName::from_static("x-accel-buffering");
    response.headers_mut().insert(name, HeaderValue::from_static("no"));
    Ok(response)
}
