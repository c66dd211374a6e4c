//! How much of a session is kept.

use axum::http::StatusCode;
use mimique_server::export::{Format, Options, export};
use mimique_session::wire::{Acknowledged, Event};
use serde_json::{Value, json};

use crate::client::{TestServer, event, events};

/// What is kept of a session is bounded by what its study can give.
pub async fn a_session_has_so_much_and_no_more(server: &TestServer) {
    let session = server.start(1).await.session;
    let stored = async || server.storage.sessions("faces").await.unwrap().remove(0).stored_bytes;
    let large = |sequence| Event {
        body: json!({"type": "x", "log": "y".repeat(900_000)}),
        ..event(sequence)
    };
    // A study of one page: four megabytes and a half.
    for sequence in 0..5 {
        server.stored(&session, &[large(sequence)]).await;
    }
    let before = stored().await;
    let full = server.append(&session, &[large(5)]).await;
    full.refused(StatusCode::PAYLOAD_TOO_LARGE, "session-full");
    assert_eq!(stored().await, before);
    // What is small still has room; the whole session comes back in one piece.
    server.stored(&session, &[event(5)]).await;
    let resumed = server.resume(&session).await;
    assert_eq!(resumed.events.len(), 6);
    assert_eq!((&resumed.events[0], &resumed.events[5]), (&large(0), &event(5)));
    // So does its export.
    let options = Options::default();
    let exported = export(&server.storage, Some("faces"), Format::Events, options).await.unwrap();
    assert_eq!((exported.participants, exported.rows), (1, 6));
    let lines = String::from_utf8(exported.files[0].1.clone()).unwrap();
    for (line, event) in lines.lines().zip(&resumed.events) {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!((&line["sequence"], &line["body"]), (&event.sequence.into(), &event.body));
    }
    assert_eq!(lines.lines().count(), 6);
    // Others are not touched by it, in the same moment.
    let other = server.start(2).await.session;
    let (too_large, small) = ([large(6)], [event(0)]);
    let (full, kept) =
        tokio::join!(server.append(&session, &too_large), server.append(&other, &small));
    full.refused(StatusCode::PAYLOAD_TOO_LARGE, "session-full");
    assert_eq!(kept.ok::<Acknowledged>().stored, 1);
    // So are the bodies that differ from what is stored.
    for number in 0..130 {
        let body = json!({"type": "answered", "number": number});
        let answer = server.append(&other, &[Event { body, ..event(0) }]).await;
        answer.refused(StatusCode::CONFLICT, "event-conflict");
    }
    let conflicts = server.storage.conflict_counts("faces").await.unwrap();
    assert_eq!(conflicts.iter().map(|(_, count)| *count).collect::<Vec<_>>(), [100]);
    // And the number of events.
    let many: Vec<Event> = events(1..2300);
    server.stored(&other, &many[..2000]).await;
    let full = server.append(&other, &many[2000..]).await;
    assert!(full.status == StatusCode::OK, "{}", full.text());
    let full = server.append(&other, &events(2300..2400)).await;
    full.refused(StatusCode::PAYLOAD_TOO_LARGE, "session-full");
}
