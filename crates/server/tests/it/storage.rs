//! Storage by itself: batches, the end, schemas.

use std::collections::BTreeMap;

use mimique_storage::{NewSession, Storage, StorageError};

use crate::client::{TestServer, event, events};

pub fn session(study: &str, token_hash: String) -> NewSession {
    NewSession {
        token_hash,
        withdrawal_hash: String::new(),
        study_id: study.into(),
        config_hash: String::new(),
        seed: 0,
        stage: "live".into(),
        language: "en".into(),
        client: "{}".into(),
        recruitment: BTreeMap::new(),
        marks: Vec::new(),
        conditions: Vec::new(),
        places: None,
        reservation_ms: 60_000,
        now_ms: 0,
    }
}

pub async fn one_impossible_change_does_not_take_others_with_it(server: &TestServer) {
    // All wait in the writer together; every third asks for a study that the database has not.
    let starts: Vec<_> = (0..60)
        .map(|index| {
            let study = if index % 3 == 0 { "none" } else { "faces" };
            let storage = server.storage.clone();
            tokio::spawn(async move { storage.start(session(study, format!("{index}"))).await })
        })
        .collect();
    let mut numbers = Vec::new();
    for (index, start) in starts.into_iter().enumerate() {
        match start.await.unwrap() {
            Ok(record) => numbers.push(record.participant),
            Err(error) => {
                assert_eq!(index % 3, 0, "{error}");
                assert!(matches!(error, StorageError::Database(_)), "{error}");
            }
        }
    }
    numbers.sort_unstable();
    assert_eq!(numbers, (1..=40).collect::<Vec<_>>());
}

pub async fn what_was_accepted_before_the_end_is_committed(server: &TestServer) {
    let token = server.start(1).await.session;
    let appends: Vec<_> = (0..200)
        .map(|sequence| {
            let (storage, hash) = (server.storage.clone(), crate::study::sha256(&token));
            tokio::spawn(async move { storage.append(&hash, vec![event(sequence)], 0).await })
        })
        .collect();
    // Somewhere among them the server is told to stop.
    tokio::time::sleep(std::time::Duration::from_millis(10)).await;
    server.storage.close().await;
    let mut acknowledged = Vec::new();
    for (sequence, append) in appends.into_iter().enumerate() {
        match append.await.unwrap() {
            Ok(_) => acknowledged.push(sequence as u64),
            Err(StorageError::Stopping | StorageError::Unavailable) => {}
            Err(error) => panic!("{error}"),
        }
    }
    let server = server.restart().await;
    let stored: Vec<u64> =
        server.resume(&token).await.events.iter().map(|event| event.sequence).collect();
    assert!(acknowledged.iter().all(|sequence| stored.contains(sequence)));
    // What was refused can be sent again, and then everything is there once.
    server.stored(&token, &events(0..200)).await;
    assert_eq!(server.resume(&token).await.events, events(0..200));
    server.storage.close().await;
}

pub async fn a_later_schema_is_refused(server: &TestServer) {
    server.run_sql("INSERT INTO schema_migrations (version) VALUES (1000)").await;
    let error = Storage::open(server.url()).await.err().unwrap();
    let text =
        "the database has schema version 1000, this binary knows up to 8; use the newer binary";
    assert_eq!(error.to_string(), text);
}
