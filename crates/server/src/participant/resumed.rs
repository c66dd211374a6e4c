//! A session as it is given back after a reload: `wire::Resume`, sent while it is read, piece by piece.
//! However much is stored, and however slowly it is taken, no more than a piece of it is in memory, and no
//! connection of the database is held while a piece is taken.

use axum::body::{Body, Bytes};
use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use mimique_session::wire::SessionStarted;
use mimique_storage::{Storage, StorageError, StoredEvent};
use tokio::sync::mpsc;
use tokio_stream::StreamExt as _;
use tokio_stream::wrappers::ReceiverStream;

use crate::error::Error;

/// Bytes that are sent at once, and the event that exceeds them.
const PIECE: usize = 256 * 1024;

/// The session and its events as JSON.
pub(super) fn resumed(
    storage: Storage,
    session_key: i64,
    started: &SessionStarted,
) -> Result<Response, Error> {
    let started = serde_json::to_string(started).map_err(Error::internal)?;
    let (sender, receiver) = mpsc::channel::<Result<Bytes, StorageError>>(1);
    tokio::spawn(async move {
        let mut piece = format!("{{\"started\":{started},\"events\":[");
        let (mut next, mut is_first) = (0, true);
        loop {
            let before = next;
            let mut events = storage.stored_events(session_key, next..u64::MAX);
            while let Some(event) = events.next().await {
                let event = match event {
                    Ok(event) => event,
                    // The answer breaks off, and the page asks again.
                    Err(error) => return drop(sender.send(Err(error)).await),
                };
                next = event.sequence + 1;
                add(&mut piece, &event, is_first);
                is_first = false;
                if piece.len() >= PIECE {
                    break;
                }
            }
            drop(events);
            if next == before {
                break;
            }
            if sender.send(Ok(std::mem::take(&mut piece).into())).await.is_err() {
                return;
            }
        }
        piece.push_str("]}");
        // Whoever has gone needs no end.
        let _ = sender.send(Ok(piece.into())).await;
    });
    let body = Body::from_stream(ReceiverStream::new(receiver));
    Ok(([(header::CONTENT_TYPE, "application/json")], body).into_response())
}

/// Adds an event; its body is JSON as it is stored.
fn add(text: &mut String, event: &StoredEvent, is_first: bool) {
    let StoredEvent { sequence, at_ms, body, .. } = event;
    let at_ms = serde_json::Value::from(*at_ms);
    let comma = if is_first { "" } else { "," };
    text.push_str(&format!("{comma}{{\"sequence\":{sequence},\"at_ms\":{at_ms},\"body\":{body}}}"));
}
