//! A session as it is given back after a reload: `wire::Resume`, sent while it is read, piece by piece.
//! However much is stored, and however slowly it is taken, no more than a piece of it is in memory, and no
//! connection of the database is held.

use axum::body::{Body, Bytes};
use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use mimique_session::wire::SessionStarted;
use mimique_storage::{Storage, StorageError, WrittenEvent};
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;

use crate::error::Error;

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
            let events = match storage.events_from(session_key, next).await {
                Ok(events) => events,
                // The answer breaks off, and the page asks again.
                Err(error) => return drop(sender.send(Err(error)).await),
            };
            let Some(last) = events.last() else { break };
            next = last.sequence + 1;
            for event in &events {
                add(&mut piece, event, is_first);
                is_first = false;
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
fn add(text: &mut String, event: &WrittenEvent, is_first: bool) {
    let WrittenEvent { sequence, at_ms, body, .. } = event;
    let at_ms = serde_json::Value::from(*at_ms);
    let comma = if is_first { "" } else { "," };
    text.push_str(&format!("{comma}{{\"sequence\":{sequence},\"at_ms\":{at_ms},\"body\":{body}}}"));
}
