//! Every text that a participant's page sends, against everything that reads it: streams, exports, pages, logs.

use axum::http::{StatusCode, header};
use mimique_session::wire::{Event, SessionStarted};
use serde_json::{Value, json};
use tokio_stream::StreamExt;

use crate::client::{TestServer, event};
use crate::people::{HOST, owner};

/// Texts that end lines, fields, tags, quotes, formulas and encodings of one consumer or another.
const TEXTS: [&str; 20] = [
    "a\nb",
    "a\r\nid: 9.9\r\n\r\ndata: forged",
    "\u{2028}\u{2029}\u{85}\u{b}\u{c}",
    "\u{feff}\u{202e}reversed",
    "</script><script>alert(1)</script>",
    "\"'><img src=x onerror=alert(1)>",
    "&lt;&amp;&#0;",
    "=HYPERLINK(\"https://evil.example\")",
    "\u{ff1d}1+1",
    "@sum(1)",
    "a,b;c\td\"e",
    "{}} {{value}} %s %n ${HOME} $(id)",
    "'; DROP TABLE events; --",
    "../../../../etc/passwd",
    "\u{1b}[31mred\u{1b}[0m",
    "e\u{301}\u{200d}\u{1f469}\u{200d}\u{1f52c}",
    "constructor",
    "__proto__",
    "\\u0000\\ud800",
    "",
];

/// Events with a text in each of their fields.
fn with_text(text: &str, first: u64) -> Vec<Event> {
    let bodies = [
        json!({"type": text}),
        json!({"type": "answered", "step": text, "question": "mood", "value": 3}),
        json!({"type": "answered", "step": "how", "question": text, "value": 3}),
        json!({"type": "answered", "step": "how", "question": "mood", "value": text}),
        json!({"type": "page_finished", "step": "how", "answers": {text: text}}),
        json!({"type": "language_chosen", "language": text}),
        json!({"type": "clip_failed", "clip": text, "message": text, "code": text}),
        json!({"type": "screened_out", "step": text, "reason": text, "details": [text]}),
        json!({text: text, "type": "unexpected", "input": text, "step": text}),
    ];
    let numbered = bodies.into_iter().zip(first..);
    numbered.map(|(body, sequence)| Event { body, ..event(sequence) }).collect()
}

pub async fn no_text_of_a_participant_breaks_a_consumer(server: &TestServer) {
    let mut owner = owner(server).await;
    let mut events = 0;
    for (text, nonce) in TEXTS.iter().zip(1_u64..) {
        let body = json!({
            "nonce": format!("{nonce:032x}"), "language": text,
            "recruitment": {"PROLIFIC_PID": text, *text: text},
            "client": {"browser": text, "version": text, "platform": text},
        });
        let started: SessionStarted = server.post("/api/studies/faces/sessions", body).await.ok();
        let client =
            json!({"about": {"browser": text}, "viewport": [1, 1], "device_pixel_ratio": 1.0});
        let opened = json!({"type": "opened", "client": client, "language": text});
        let mut sent = vec![Event { body: opened, ..event(0) }];
        sent.extend(with_text(text, 1));
        server.stored(&started.session, &sent).await;
        // What the page gets back is what it has sent.
        assert_eq!(server.resume(&started.session).await.events, sent, "{text:?}");
        events += sent.len();
        let report = json!({
            "module": text, "backend": text, "message": text, "place": text, "study": text,
        });
        let reported = server.post("/api/panics", report).await.status;
        assert!([StatusCode::OK, StatusCode::TOO_MANY_REQUESTS].contains(&reported), "{text:?}");
    }
    // The stream goes to the last event, each under its own number.
    let request = axum::http::Request::get("/researcher/studies/faces/events?from=beginning")
        .header(header::HOST, HOST)
        .header(header::COOKIE, owner.cookie());
    let response = server.stream(request.body(axum::body::Body::empty()).unwrap()).await;
    let mut lines = response.into_body().into_data_stream();
    let mut told = String::new();
    while told.matches("\n\n").count() < events {
        let chunk = tokio::time::timeout(std::time::Duration::from_secs(10), lines.next()).await;
        let chunk = chunk.unwrap_or_else(|_| panic!("the stream stops after {told}"));
        told.push_str(&String::from_utf8_lossy(&chunk.expect("the stream ends").unwrap()));
    }
    let data = told.lines().filter_map(|line| line.strip_prefix("data: "));
    let data: Vec<Value> = data.map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(data.len(), events);
    // Exports are read, and their lines are as many as without such texts.
    for format in
        ["csv", "wide", "json", "events", "psych-ds", "csv?neutralised=true&with_identifiers=true"]
    {
        let answer =
            owner.open(server, &format!("/researcher/studies/faces/export/{format}")).await;
        assert_eq!(answer.status, StatusCode::OK, "{format}: {}", answer.text());
        if format == "events" {
            let text = answer.text();
            let lines: Vec<_> = text.split('\n').filter(|line| !line.is_empty()).collect();
            assert_eq!(lines.len(), events);
            assert!(lines.iter().all(|line| serde_json::from_str::<Value>(line).is_ok()));
        }
    }
    // Pages show texts as texts.
    let mut pages = vec!["/researcher/studies/faces".to_owned()];
    pages.extend((1..=TEXTS.len()).map(|n| format!("/researcher/studies/faces/participants/{n}")));
    for page in &pages {
        let answer = owner.open(server, page).await;
        assert_eq!(answer.status, StatusCode::OK, "{page}: {}", answer.text());
        for live in ["<script>alert", "<img src=x"] {
            assert!(!answer.text().contains(live), "{page}: {live}");
        }
    }
}
