//! What was deleted is in no table any more, and in no byte of SQLite's files.

use mimique_storage::Exclusion;
use serde_json::json;

use mimique_server::withdrawal_hash;
use mimique_session::wire::Event;

use crate::client::{TestServer, event};

/// How often a text stands in the database's files: the file itself, its log, whatever lies beside it.
fn found(server: &TestServer, text: &str) -> usize {
    let path = server.url().strip_prefix("sqlite:").expect("SQLite");
    let folder = std::path::Path::new(path).parent().unwrap();
    let mut found = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        found += bytes.windows(text.len()).filter(|window| *window == text.as_bytes()).count();
    }
    found
}

/// What each participant has said: short and long, so that some of it lies on pages of its own.
fn said(nonce: u64, sequences: std::ops::Range<u64>) -> Vec<Event> {
    let body = |sequence: u64| {
        let long = format!("said-by-{nonce}-").repeat(1 + (sequence as usize * 37) % 900);
        json!({"type": "answered", "step": "how", "question": "mood", "value": long})
    };
    sequences.map(|sequence| Event { body: body(sequence), ..event(sequence) }).collect()
}

pub async fn what_is_deleted_leaves_no_trace(server: &TestServer) {
    let mut people = Vec::new();
    for nonce in 1..=6 {
        people.push(server.start(nonce).await);
    }
    // Their events lie among each other's.
    for part in 0..10 {
        for (nonce, started) in (1..).zip(&people) {
            server.stored(&started.session, &said(nonce, part * 4..part * 4 + 4)).await;
            let other = said(nonce, part * 4 + 1..part * 4 + 2).remove(0);
            let other = Event { at_ms: 1.0, ..other };
            server.append(&started.session, &[other]).await;
        }
    }
    let sessions = server.storage.sessions("faces").await.unwrap();
    for session in &sessions {
        let reason = Some(format!("why-{} was told in private", session.participant));
        let exclusion = Exclusion { session_key: session.key, reason, who: "x@y".into(), at_ms: 1 };
        server.storage.add_exclusion(&exclusion).await.unwrap();
    }
    server.withdrawn(&people[0].session, &people[0].withdrawal_code).await;
    let hash = withdrawal_hash(&people[1].withdrawal_code);
    server.storage.withdraw_by_code(None, &hash, "somebody", 5).await.unwrap();
    server.storage.erase_participant("faces", 3, "somebody", 5).await.unwrap();
    let hash = sessions[0].config_hash.clone();
    server.run_sql("UPDATE sessions SET overdue_ms = 1 WHERE participant = 4").await;
    assert_eq!(server.storage.erase_marked("faces", &hash, 1, 5).await.unwrap(), 1);
    server.storage.erase_identifiers("faces", Some(5), "somebody", 5).await.unwrap();
    let left = server.storage.exclusions("faces").await.unwrap();
    let left: Vec<i64> = left.iter().map(|exclusion| exclusion.session_key).collect();
    assert_eq!(left, [sessions[4].key, sessions[5].key]);
    if !server.url().starts_with("sqlite:") {
        return;
    }
    for number in 1..=4 {
        for text in [
            format!("said-by-{number}-"),
            format!("person {number}"),
            format!("why-{number} was told"),
        ] {
            assert_eq!(found(server, &text), 0, "{text}");
        }
    }
    // Of the fifth the identifiers alone, of the sixth nothing.
    assert_eq!(found(server, "person 5"), 0);
    for text in ["said-by-5-", "why-5 was told", "said-by-6-", "person 6", "why-6 was told"] {
        assert!(found(server, text) > 0, "{text}");
    }
}

/// Somebody who reads the old state, as a backup does, only puts it off.
pub async fn a_reader_only_puts_it_off(server: &TestServer) {
    if !server.url().starts_with("sqlite:") {
        return;
    }
    use sqlx::{Connection, Executor};
    let started = server.start(1).await;
    server.stored(&started.session, &said(1, 0..20)).await;
    let mut reader = sqlx::SqliteConnection::connect(server.url()).await.unwrap();
    reader.execute("BEGIN").await.unwrap();
    reader.fetch_all("SELECT * FROM events").await.unwrap();
    server.withdrawn(&started.session, &started.withdrawal_code).await;
    assert!(found(server, "said-by-1-") > 0, "the reader needs it still");
    // Others go on meanwhile.
    server.start(2).await;
    reader.execute("COMMIT").await.unwrap();
    let gone = async {
        while found(server, "said-by-1-") > 0 {
            tokio::time::sleep(std::time::Duration::from_millis(50)).await;
        }
    };
    let soon = std::time::Duration::from_secs(30);
    assert!(tokio::time::timeout(soon, gone).await.is_ok(), "it is never taken out");
}
