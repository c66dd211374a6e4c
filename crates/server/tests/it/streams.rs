//! Streams of server-sent events: whatever a participant sends, they go on; whoever may no longer read, reads no more.

use std::time::{Duration, Instant};

use axum::body::{Body, BodyDataStream};
use axum::http::{Request, StatusCode, header};
use mimique_session::wire::Event;
use mimique_storage::Role;
use serde_json::json;
use tokio_stream::StreamExt;

use crate::client::{TestServer, event, events};
use crate::people::{Browser, HOST, invited, owner, token};

const EVENTS: &str = "/researcher/studies/faces/events";

/// Opens a stream as a browser or a script does.
async fn listen(
    server: &TestServer,
    path: &str,
    name: header::HeaderName,
    value: &str,
) -> BodyDataStream {
    let request = Request::get(path).header(header::HOST, HOST).header(name, value);
    let response = server.stream(request.body(Body::empty()).unwrap()).await;
    assert_eq!(response.status(), StatusCode::OK, "{path}");
    response.into_body().into_data_stream()
}

/// What a stream sends until this text has come; it must come within five seconds.
async fn until(lines: &mut BodyDataStream, text: &str) -> String {
    let mut told = String::new();
    while !told.contains(text) {
        let chunk = tokio::time::timeout(Duration::from_secs(5), lines.next()).await;
        let chunk = chunk.unwrap_or_else(|_| panic!("no {text:?} after {told:?}"));
        let chunk = chunk.unwrap_or_else(|| panic!("the stream ended after {told:?}")).unwrap();
        told.push_str(&String::from_utf8_lossy(&chunk));
    }
    told
}

/// The type of an event is the page's text: no type ends a stream, or is a line of its own.
pub async fn an_event_of_any_type_is_streamed(server: &TestServer) {
    let owner = owner(server).await;
    let session = server.start(1).await.session;
    let mut open = listen(server, EVENTS, header::COOKIE, &owner.cookie()).await;
    let kinds = [
        json!("a\nb"),
        json!("a\r\ndata: forged"),
        json!("\n\n"),
        json!("\u{2028}"),
        json!(""),
        json!("x".repeat(5000)),
        json!("a b"),
        json!("é"),
        json!(7),
        json!(null),
        json!("answered"),
    ];
    let sent = kinds.iter().zip(0..).map(|(kind, sequence)| Event {
        body: json!({"type": kind, "step": "how\nid: 9.9", "note": "\r\n\ndata: forged"}),
        ..event(sequence)
    });
    server.stored(&session, &sent.collect::<Vec<_>>()).await;
    let last = format!("id: 1.{}\n", kinds.len() - 1);
    let mut all =
        listen(server, &format!("{EVENTS}?from=beginning"), header::COOKIE, &owner.cookie()).await;
    for lines in [&mut open, &mut all] {
        let mut told = until(lines, &last).await;
        if !told.ends_with("\n\n") {
            told += &until(lines, "\n\n").await;
        }
        for line in told.lines().filter(|line| !line.is_empty()) {
            let plain =
                ["event: ", "id: 1.", "data: {", ":"].iter().any(|start| line.starts_with(start));
            assert!(plain && line.len() < 12_000, "{line}");
        }
        let names: Vec<_> = told.lines().filter_map(|line| line.strip_prefix("event: ")).collect();
        assert_eq!(names.len(), kinds.len(), "{names:?}");
        let (known, others) = names.split_last().unwrap();
        assert_eq!(*known, "answered");
        assert!(others.iter().all(|name| *name == "event"), "{others:?}");
    }
}

/// A study that is busy keeps no stream open that its reader has no right to any more.
pub async fn a_lost_right_ends_a_stream_of_a_busy_study(server: &TestServer) {
    let session = server.start(1).await.session;
    let mut owner = owner(server).await;
    let analyst = invited(server, &mut owner, Role::Analyst).await;
    let viewer = invited(server, &mut owner, Role::Viewer).await;
    let key = token(server, &mut owner, Role::Analyst).await;
    let live = "/researcher/studies/faces/live";
    let bearer = format!("Bearer {key}");
    let mut streams = vec![
        ("revoked token", listen(server, EVENTS, header::AUTHORIZATION, &bearer).await),
        ("lowered role", listen(server, EVENTS, header::COOKIE, &analyst.cookie()).await),
        ("disabled account", listen(server, live, header::COOKIE, &viewer.cookie()).await),
    ];
    // Another session of the owner, which logs out.
    let mut other = Browser::default();
    other.open(server, "/researcher/login").await;
    let fields = [("email", "owner@example.org"), ("password", crate::people::PASSWORD)];
    let entered = other.send(server, "/researcher/login", &fields).await;
    assert_eq!(entered.status, StatusCode::SEE_OTHER, "{}", entered.text());
    other.open(server, "/researcher/account").await;
    for (name, path) in [("log-out of events", EVENTS), ("log-out of live", live)] {
        streams.push((name, listen(server, path, header::COOKIE, &other.cookie()).await));
    }
    let mut stays = listen(server, EVENTS, header::COOKIE, &owner.cookie()).await;
    // Each has looked at what there was, so that the next event is new to it.
    tokio::time::sleep(Duration::from_millis(1500)).await;
    server.stored(&session, &events(0..1)).await;
    for (_, lines) in &mut streams {
        until(lines, "\n\n").await;
    }
    until(&mut stays, "id: 1.0\n").await;
    // Each loses the right, by another way.
    let first = server.storage.tokens().await.unwrap()[0].key;
    owner.send(server, &format!("/researcher/tokens/{first}/revoke"), &[]).await;
    let accounts = server.storage.accounts().await.unwrap();
    for (role, fields) in [
        (Role::Analyst, vec![("action", "role"), ("role", "viewer")]),
        (Role::Viewer, vec![("action", "disable")]),
    ] {
        let person = accounts.iter().find(|account| account.role == role).unwrap();
        let done = owner.send(server, &format!("/researcher/people/{}", person.key), &fields).await;
        assert!(done.status.is_redirection() || done.status.is_success(), "{}", done.text());
    }
    let out = other.send(server, "/researcher/logout", &[]).await;
    assert_eq!(out.status, StatusCode::SEE_OTHER, "{}", out.text());
    // Events come all the while, more often than any pause of the stream.
    let lost = Instant::now();
    let writer = server.storage.clone();
    let busy = async {
        for sequence in 1.. {
            server.stored(&session, &events(sequence..sequence + 1)).await;
            tokio::time::sleep(Duration::from_millis(200)).await;
        }
    };
    let ends = async {
        for (name, lines) in &mut streams {
            let end = async { while lines.next().await.is_some() {} };
            let ended = tokio::time::timeout(Duration::from_secs(6), end).await;
            assert!(ended.is_ok(), "{name}: open {:?} after the right was lost", lost.elapsed());
        }
    };
    tokio::select! {
        () = busy => {}
        () = ends => {}
    }
    // Whoever still has the right reads on.
    let stored = writer.sessions("faces").await.unwrap()[0].event_count;
    until(&mut stays, &format!("id: 1.{}\n", stored - 1)).await;
}
