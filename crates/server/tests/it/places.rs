//! Places of a study: held by pages that are heard of, not by whoever asks for them.

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use mimique_session::wire::{Event, SessionStarted};
use serde_json::json;

use crate::client::{Answer, TestServer, event};
use crate::enrolment::{begin, with};

/// Asks from an address to begin.
async fn begin_from(server: &TestServer, address: &str, nonce: u64) -> Answer {
    let body = json!({"nonce": format!("{nonce:032x}"), "language": "en"});
    let request = Request::post("/api/studies/faces/sessions")
        .header(header::CONTENT_TYPE, "application/json")
        .header("x-real-ip", address)
        .body(Body::from(body.to_string()))
        .unwrap();
    server.send(request).await
}

/// A study of twenty places, and somebody who begins nineteen sessions without a page.
pub async fn one_address_cannot_fill_a_study(server: &TestServer) {
    let server = server.restart_with(vec![with(json!({"participants": 20}))]).await;
    let settings = mimique_server::Settings {
        behind_proxy: true,
        starts_per_minute: 12,
        ..mimique_server::Settings::default()
    };
    let server = server.with_settings(settings);
    let stranger = "192.0.2.1";
    let mut begun: Vec<SessionStarted> = Vec::new();
    for nonce in 1..=19 {
        let answer = begin_from(&server, stranger, nonce).await;
        match answer.status {
            StatusCode::OK => begun.push(answer.json()),
            _ => drop(answer.refused(StatusCode::TOO_MANY_REQUESTS, "too-often")),
        }
    }
    assert_eq!(begun.len(), 8);
    // A start that is sent again is the same one.
    let again: SessionStarted = begin_from(&server, stranger, 1).await.ok();
    assert_eq!(again, begun[0]);
    // Everybody else finds a place: twelve are left, and who is heard of makes room for the next.
    for nonce in 101..=112 {
        let answer = begin_from(&server, &format!("198.51.100.{}", nonce - 100), nonce).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
    }
    begin_from(&server, "203.0.113.1", 200).await.refused(StatusCode::FORBIDDEN, "study-full");
    // A minute later the places that nobody was heard of are free again.
    server.run_sql("UPDATE sessions SET started_ms = started_ms - 61000").await;
    assert_eq!(begin_from(&server, "203.0.113.1", 200).await.status, StatusCode::OK);
    // Whoever sends events as a page does begins so many in a minute.
    let busy = "203.0.113.9";
    let mut begun = 0;
    for nonce in 300..320 {
        let answer = begin_from(&server, busy, nonce).await;
        if answer.status == StatusCode::OK {
            begun += 1;
            let started: SessionStarted = answer.json();
            server.stored(&started.session, &[event(0)]).await;
        }
    }
    assert_eq!(begun, 12);
}

/// What no page could send shows no page.
pub async fn a_place_is_held_by_a_page_that_is_heard_of(server: &TestServer) {
    let server = server.restart_with(vec![with(json!({"participants": 1}))]).await;
    let silent = server.start(1).await;
    let refused = |answer: Answer| answer.refused(StatusCode::FORBIDDEN, "study-full");
    refused(begin(&server, 2, "en", "b", "").await);
    let made_up = Event { body: json!({"type": "made_up"}), ..event(0) };
    server.stored(&silent.session, &[made_up]).await;
    server.run_sql("UPDATE sessions SET started_ms = started_ms - 61000").await;
    let mut owner = crate::people::owner(&server).await;
    let page = owner.open(&server, "/researcher/studies/faces").await.text();
    assert!(page.contains("<dt>abandoned</dt><dd>1</dd>"), "{page}");
    let heard = server.start(2).await;
    server.stored(&heard.session, &[event(0)]).await;
    server.run_sql("UPDATE sessions SET started_ms = started_ms - 61000").await;
    refused(begin(&server, 3, "en", "c", "").await);
}
