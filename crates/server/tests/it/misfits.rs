//! Events that cannot be a session's, and events that its receipt does not cover: kept, in no table.

use axum::http::StatusCode;
use mimique_server::export::{Format, Options, export};
use mimique_session::Standing;
use mimique_session::wire::Event;
use serde_json::{Value, json};

use crate::client::{TestServer, event};
use crate::participant::takes_part;
use crate::people::owner;
use crate::study;

async fn exported(server: &TestServer, format: Format) -> String {
    let exported = export(&server.storage, Some("demo"), format, Options::default()).await.unwrap();
    String::from_utf8(exported.files.into_iter().next().unwrap().1).unwrap()
}

fn at(sequence: u64, body: Value) -> Event {
    Event { body, ..event(sequence) }
}

/// Who has a token can send anything; the others keep their tables and their report.
pub async fn a_strangers_event_reaches_no_table(server: &TestServer) {
    let demo = study::demo();
    for nonce in 1..=2 {
        let started = server.start_in("demo", nonce).await;
        let (events, _) = takes_part(demo.study(), &started, usize::MAX);
        server.stored(&started.session, &events).await;
        server.receipt(&started.session, events.len() as u64).await;
    }
    let before = exported(server, Format::Csv).await;
    let stranger = server.start_in("demo", 3).await;
    let trial = json!({
        "type": "trial_finished", "step": "", "clip": "", "answers": {"": 1}, "rt_ms": 1.0,
        "replays": 0,
    });
    let mut elsewhere = trial.clone();
    elsewhere["step"] = json!("=HYPERLINK(1)");
    let page = json!({"type": "page_finished", "step": "", "answers": {"mood": 99}});
    let bodies = [trial.clone(), elsewhere, page, json!({"type": "trial_finished"}), json!({})];
    let sent: Vec<Event> = (0..).zip(bodies).map(|(n, body)| at(n, body)).collect();
    assert_eq!(server.stored(&stranger.session, &sent).await.stored, 5, "all of it is kept");
    assert_eq!(server.resume(&stranger.session).await.events, sent);
    assert_eq!(exported(server, Format::Csv).await, before);
    assert!(!exported(server, Format::Wide).await.contains("p0003,"));
    // The form that holds everything says what is wrong with them.
    let lines = exported(server, Format::Events).await;
    let misfits: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap())
        .filter(|line| line["participant_id"] == "p0003")
        .map(|line| line["misfit"].clone())
        .collect();
    let words = ["no-such-step", "no-such-step", "no-such-step", "unreadable", "unreadable"];
    assert_eq!(misfits, words.map(Value::from));
    assert_eq!(lines.matches("misfit").count(), 5, "and of nobody else's");
    // Nor does one in the middle of a good session take it away.
    let good = server.start_in("demo", 4).await;
    let (mut events, answers) = takes_part(demo.study(), &good, usize::MAX);
    let last = events.len() as u64;
    events.push(at(last, trial));
    server.stored(&good.session, &events).await;
    server.receipt(&good.session, last + 1).await;
    let rows = exported(server, Format::Csv).await;
    let own = rows.lines().filter(|line| line.starts_with("p0004,")).count();
    assert_eq!(own, answers.len());
    let mut owner = owner(server).await;
    let report = owner.open(server, "/researcher/studies/demo/report/en/report.html").await;
    assert_eq!(report.status, StatusCode::OK, "{}", report.text());
    let shown = owner.open(server, "/researcher/studies/demo/participants/3").await.text();
    assert!(shown.contains("counts for nothing: <code>no-such-step</code>"), "{shown}");
}

/// The receipt says how much it covers: what comes after it is kept and changes nothing.
pub async fn what_comes_after_the_receipt_changes_no_standing(server: &TestServer) {
    let demo = study::demo();
    let started = server.start_in("demo", 1).await;
    let (events, answers) = takes_part(demo.study(), &started, 6);
    let count = events.len() as u64;
    server.stored(&started.session, &events).await;
    server.receipt(&started.session, count).await;
    let before = exported(server, Format::Csv).await;
    assert!(before.contains(",active,") && !answers.is_empty(), "{before}");
    let late = [json!({"type": "finished"}), json!({"type": "checks_failed", "failed": 3})];
    let late: Vec<Event> = (count..).zip(late).map(|(n, body)| at(n, body)).collect();
    assert_eq!(server.stored(&started.session, &late).await.stored, count + 2);
    assert_eq!(exported(server, Format::Csv).await, before);
    let session = server.storage.sessions("demo").await.unwrap().remove(0);
    assert_eq!(session.standing, Standing::InProgress);
    let receipt = server.receipt(&started.session, count).await;
    assert_eq!((receipt.stored, receipt.completion_code), (count, None));
    // Nothing is lost: they are in the form that holds everything.
    assert!(exported(server, Format::Events).await.contains("checks_failed"));
    // Whoever does finish first and is told so after has finished.
    let other = server.start_in("demo", 2).await;
    let (events, _) = takes_part(demo.study(), &other, usize::MAX);
    server.stored(&other.session, &events).await;
    server.receipt(&other.session, events.len() as u64).await;
    let late = at(events.len() as u64, json!({"type": "withdrawn"}));
    server.stored(&other.session, &[late]).await;
    let sessions = server.storage.sessions("demo").await.unwrap();
    assert_eq!(sessions[1].standing, Standing::Completed);
}
