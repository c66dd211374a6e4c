//! Answers over their time: marked, kept on request, deleted after a week; and no clock is believed that
//! the database contradicts.

use axum::http::StatusCode;
use mimique_server::{HostedStudy, Sweep, Swept, clock_doubt, confirm_clock, sweep_overdue};
use serde_json::json;

use crate::client::{TestServer, event, events};
use crate::people::{Browser, owner};
use crate::study;

const DAY: i64 = 24 * 3_600_000;

/// The small study, whose answers may be kept for ten days.
fn ten_days() -> HostedStudy {
    let mut file = study::file();
    file["consent"] = json!({"version": "1", "retentionDays": 10, "sections": []});
    study::host(file)
}

/// Two people: the session of the first has ended. The server's present, too.
async fn kept(server: &TestServer) -> (TestServer, i64) {
    let server = server.restart_with(vec![ten_days()]).await;
    for nonce in 1..=2 {
        let started = server.start(nonce).await;
        server.stored(&started.session, &events(0..4)).await;
    }
    let first = server.start(1).await.session;
    server.receipt(&first, 4).await;
    let sessions = server.storage.sessions("faces").await.unwrap();
    let now = sessions[0].ended_ms.unwrap().min(sessions[1].last_event_ms.unwrap());
    (server, now)
}

async fn stored(server: &TestServer) -> Vec<u64> {
    let sessions = server.storage.sessions("faces").await.unwrap();
    sessions.iter().map(|session| session.event_count).collect()
}

/// Goes on day by day, as a server does that runs; what was done on the last one.
async fn days(server: &TestServer, from: i64, range: std::ops::RangeInclusive<i64>) -> Swept {
    let mut last = None;
    for day in range {
        last = Some(sweep_overdue(&server.storage, from + day * DAY).await.unwrap());
    }
    match last {
        Some(Sweep::Done(mut swept)) => swept.remove(0),
        other => panic!("{other:?}"),
    }
}

fn swept(marked: u64, erased: u64) -> Swept {
    Swept { study: "faces".into(), marked, erased }
}

pub async fn answers_are_deleted_a_week_after_their_time_is_over(server: &TestServer) {
    let (server, now) = kept(server).await;
    assert_eq!(days(&server, now, 0..=10).await, swept(0, 0));
    assert_eq!(days(&server, now, 11..=11).await, swept(2, 0));
    assert_eq!(days(&server, now, 12..=17).await, swept(0, 0));
    assert_eq!(stored(&server).await, [4, 4]);
    // Whatever a backup does meanwhile, it has nothing to take out of the earlier ones.
    assert!(server.storage.deletions().await.unwrap().is_empty());
    assert_eq!(days(&server, now, 18..=18).await, swept(0, 2));
    assert_eq!(days(&server, now, 19..=19).await, swept(0, 0));
    for nonce in 1..=2 {
        let request = json!({"nonce": format!("{nonce:032x}"), "language": "en"});
        let answer = server.post("/api/studies/faces/sessions", request).await;
        answer.refused(StatusCode::GONE, "withdrawn");
    }
    assert_eq!(stored(&server).await, [0, 0]);
    assert!(server.storage.recruitment("faces").await.unwrap().is_empty());
    let what: Vec<_> = server.storage.deletions().await.unwrap();
    assert_eq!(
        what.iter().map(|deletion| deletion.what.as_str()).collect::<Vec<_>>(),
        ["erased"; 2]
    );
    let log = server.storage.audit_entries(i64::MAX, 10).await.unwrap();
    let lines: Vec<_> = log.iter().map(|entry| (&*entry.action, &*entry.subject)).collect();
    let action = "delete answers whose time is over";
    assert_eq!(lines, [(action, "p0002"), (action, "p0001")]);
    assert_eq!(server.start(3).await.participant, 3);
    server.storage.close().await;
}

pub async fn a_wrong_clock_deletes_nothing(server: &TestServer) {
    let (server, now) = kept(server).await;
    // At the first start, years ahead: the newest event contradicts it, however often it is asked.
    for hour in 0..30 * 24 {
        let wrong = now + 3000 * DAY + hour * DAY / 24;
        let swept = sweep_overdue(&server.storage, wrong).await.unwrap();
        assert!(matches!(swept, Sweep::Doubted(_)), "{swept:?}");
    }
    assert_eq!(server.storage.overdue("faces").await.unwrap(), None);
    // Put right, everything goes on. Later it jumps: now the time that was believed contradicts it,
    // also when events have come in by the wrong clock.
    assert_eq!(days(&server, now, 0..=1).await, swept(0, 0));
    let wrong = now + 40 * DAY;
    let hash = study::sha256(&server.start(2).await.session);
    server.storage.append(&hash, vec![event(4)], wrong).await.unwrap();
    let doubt = clock_doubt(&server.storage, wrong).await.unwrap().unwrap();
    assert_eq!((doubt.seen_ms, doubt.now_ms), (now + DAY, wrong));
    assert!(matches!(sweep_overdue(&server.storage, wrong).await.unwrap(), Sweep::Doubted(_)));
    // Behind what it has seen is doubtful too, until an owner says that the clock is right.
    let right = now + 2 * DAY;
    assert!(matches!(sweep_overdue(&server.storage, right).await.unwrap(), Sweep::Doubted(_)));
    confirm_clock(&server.storage, right).await.unwrap();
    assert_eq!(days(&server, now, 2..=9).await, swept(0, 0));
    assert_eq!(stored(&server).await, [4, 5]);
    // Had somebody said of the wrong clock that it is right, there is a week to see it: the marks go
    // when the clock is put right.
    confirm_clock(&server.storage, wrong).await.unwrap();
    assert_eq!(days(&server, wrong, 0..=0).await, swept(1, 0));
    assert_eq!(server.storage.overdue("faces").await.unwrap().unwrap().sessions, 1);
    let right = now + 9 * DAY;
    confirm_clock(&server.storage, right).await.unwrap();
    assert_eq!(days(&server, right, 0..=0).await, swept(0, 0));
    assert_eq!(server.storage.overdue("faces").await.unwrap(), None);
    assert_eq!(stored(&server).await, [4, 5]);
    server.storage.close().await;
}

pub async fn an_owner_keeps_answers_and_confirms_the_clock(server: &TestServer) {
    let (server, now) = kept(server).await;
    let mut owner = owner(&server).await;
    assert_eq!(days(&server, now, 0..=11).await, swept(2, 0));
    let page = owner.open(&server, "/researcher/studies/faces").await.text();
    assert!(page.contains("are over the study’s retentionDays"), "{page}");
    let done = owner.send(&server, "/researcher/studies/faces/keep", &[]).await;
    assert_eq!(done.status, StatusCode::SEE_OTHER, "{}", done.text());
    assert_eq!(server.storage.overdue("faces").await.unwrap(), None);
    let page = owner.open(&server, "/researcher/studies/faces").await.text();
    assert!(!page.contains("retentionDays"), "{page}");
    // What is still over its time is marked anew: another week.
    assert_eq!(days(&server, now, 12..=18).await, swept(0, 0));
    assert_eq!(stored(&server).await, [4, 4]);
    assert_eq!(days(&server, now, 19..=19).await, swept(0, 2));
    // The machine's own clock lies far behind that of this test.
    let page = owner.open(&server, "/researcher").await.text();
    assert!(page.contains("action=\"/researcher/clock\""), "{page}");
    let mut stranger = Browser::default();
    stranger.open(&server, "/researcher/login").await;
    let refused = stranger.send(&server, "/researcher/clock", &[]).await;
    assert_eq!(refused.status, StatusCode::UNAUTHORIZED);
    owner.send(&server, "/researcher/clock", &[]).await;
    let page = owner.open(&server, "/researcher").await.text();
    assert!(!page.contains("/researcher/clock"), "{page}");
    let log = server.storage.audit_entries(i64::MAX, 3).await.unwrap();
    let actions: Vec<&str> = log.iter().map(|entry| entry.action.as_str()).collect();
    assert_eq!(actions[0], "confirm the clock");
    server.storage.close().await;
}
