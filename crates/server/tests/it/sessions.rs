//! A participant's session: start, events, resume, completion, withdrawal.

use std::collections::BTreeSet;

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use mimique_session::Standing;
use mimique_session::wire::{Acknowledged, Event, SessionStarted};
use serde_json::json;

use crate::client::{TestServer, event, events};
use crate::study;

pub async fn a_repeated_start_finds_the_same_session(server: &TestServer) {
    let first = server.start(1).await;
    assert_eq!(first, server.start(1).await);
    assert_eq!(first.session.len(), 32);
    assert_eq!((first.participant, first.participant_id.as_str()), (1, "p0001"));
    assert_eq!(first.seed, 9_007_199_254_740_991);
    assert_eq!(first.stage, "live");
    assert_eq!(first.config_hash, study::hosted().config_hash());
    // A second person is another session.
    let second = server.start(2).await;
    assert_eq!(second.participant, 2);
    assert_ne!(first.session, second.session);
    assert_ne!(first.withdrawal_code, second.withdrawal_code);
    assert_eq!(server.storage.sessions("faces").await.unwrap().len(), 2);
}

pub async fn participant_numbers_are_given_once(server: &TestServer) {
    // Each nonce twice, all at once.
    let starts: Vec<SessionStarted> = {
        let started = (0..40).map(|index| server.start(index / 2));
        join_all(started).await
    };
    let numbers: BTreeSet<u64> = starts.iter().map(|started| started.participant).collect();
    assert_eq!(numbers, (1..=20).collect());
    for pair in starts.chunks(2) {
        assert_eq!(pair[0], pair[1]);
    }
    // A number is not given again after its participant has withdrawn.
    let last = starts.iter().max_by_key(|started| started.participant).unwrap();
    server.withdrawn(&last.session, &last.withdrawal_code).await;
    assert_eq!(server.start(100).await.participant, 21);
}

pub async fn an_append_repeated_changes_nothing(server: &TestServer) {
    let session = server.start(1).await.session;
    let all = events(0..5);
    for _ in 0..3 {
        let acknowledged = server.stored(&session, &all).await;
        assert_eq!(acknowledged, Acknowledged { stored: 5, gaps: vec![] });
    }
    // The same event twice in one request, and one that is new.
    let acknowledged = server.stored(&session, &[event(4), event(5), event(5)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 6, gaps: vec![] });
    assert_eq!(server.resume(&session).await.events, events(0..6));
    // Nothing to append is a question how much is stored.
    assert_eq!(server.stored(&session, &[]).await.stored, 6);
}

pub async fn gaps_are_reported_and_filled_in_any_order(server: &TestServer) {
    let session = server.start(1).await.session;
    let acknowledged = server.stored(&session, &[event(7), event(2), event(0)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 1, gaps: vec![1, 3, 4, 5, 6] });
    let acknowledged = server.stored(&session, &[event(5), event(1)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 3, gaps: vec![3, 4, 6] });
    let acknowledged = server.stored(&session, &[event(6), event(4), event(3)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 8, gaps: vec![] });
    assert_eq!(server.resume(&session).await.events, events(0..8));
    assert_eq!(server.storage.sessions("faces").await.unwrap()[0].first_gap, 8);
    // A far sequence does not make a list without end.
    let acknowledged = server.stored(&session, &[event(90_000)]).await;
    assert_eq!((acknowledged.stored, acknowledged.gaps.len()), (8, 1000));
}

/// However much is stored behind a gap, a request for the session looks at a bounded part of it.
pub async fn a_gap_far_back_is_not_searched_for_again(server: &TestServer) {
    let session = server.start(1).await.session;
    let first_gap = async || server.storage.sessions("faces").await.unwrap()[0].first_gap;
    let with_gaps: Vec<Event> =
        events(1..2250).into_iter().filter(|event| event.sequence != 2200).collect();
    let mut told = Vec::new();
    for part in with_gaps.chunks(400) {
        let acknowledged = server.stored(&session, part).await;
        assert_eq!(acknowledged.stored, 0);
        told = acknowledged.gaps;
    }
    // The second gap lies beyond what is looked at: it is told when the first is filled.
    assert_eq!((told, first_gap().await), (vec![0], 0));
    let refusal = server.complete(&session, 2250).await;
    let refusal = refusal.refused(StatusCode::CONFLICT, "missing-events");
    assert_eq!(refusal.sequences, [0]);
    let acknowledged = server.stored(&session, &[event(0)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 2200, gaps: vec![2200] });
    assert_eq!(first_gap().await, 2200);
    let acknowledged = server.stored(&session, &[event(2200)]).await;
    assert_eq!(acknowledged, Acknowledged { stored: 2250, gaps: vec![] });
    assert_eq!(server.receipt(&session, 2250).await.stored, 2250);
}

pub async fn another_body_for_a_stored_event_is_refused_and_kept_apart(server: &TestServer) {
    let session = server.start(1).await.session;
    server.stored(&session, &events(0..2)).await;
    let other = Event { body: json!({"type": "answered", "value": 99}), ..event(1) };
    let request = [other, event(2)];
    for _ in 0..2 {
        let refusal =
            server.append(&session, &request).await.refused(StatusCode::CONFLICT, "event-conflict");
        assert_eq!(refusal.sequences, [1]);
    }
    // The first body stands, the new event of the same request is stored, the other is kept once.
    assert_eq!(server.resume(&session).await.events, events(0..3));
    let conflicts = server.storage.conflict_counts("faces").await.unwrap();
    assert_eq!(conflicts.iter().map(|(_, count)| *count).collect::<Vec<_>>(), [1]);
    // Another time is another event too.
    let later = Event { at_ms: event(1).at_ms + 1.0, ..event(1) };
    server.append(&session, &[later]).await.refused(StatusCode::CONFLICT, "event-conflict");
}

pub async fn many_appends_at_once_are_all_stored(server: &TestServer) {
    let sessions: Vec<String> = join_all((0..8).map(|nonce| server.start(nonce)))
        .await
        .into_iter()
        .map(|s| s.session)
        .collect();
    // Every event of every session in a request of its own, each request twice.
    let requests = sessions.iter().flat_map(|session| {
        (0..25).flat_map(move |sequence| {
            (0..2).map(move |_| async move { server.stored(session, &[event(sequence)]).await })
        })
    });
    join_all(requests).await;
    for session in &sessions {
        assert_eq!(server.resume(session).await.events, events(0..25));
        assert_eq!(server.stored(session, &[]).await.stored, 25);
    }
}

pub async fn a_session_goes_on_after_a_reload(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..3)).await;
    let resumed = server.resume(&started.session).await;
    assert_eq!(resumed.started, started);
    assert_eq!(resumed.events, events(0..3));
}

pub async fn a_restart_keeps_everything(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..3)).await;
    let receipt = server.receipt(&started.session, 3).await;
    let server = server.restart().await;
    assert_eq!(server.resume(&started.session).await.events, events(0..3));
    assert_eq!(server.start(1).await, started);
    assert_eq!(server.receipt(&started.session, 3).await, receipt);
    assert_eq!(server.start(2).await.participant, 2);
    server.storage.close().await;
}

pub async fn completing_needs_every_event(server: &TestServer) {
    let session = server.start(1).await.session;
    server.stored(&session, &[event(0), event(2), event(3)]).await;
    let refusal =
        server.complete(&session, 6).await.refused(StatusCode::CONFLICT, "missing-events");
    assert_eq!(refusal.sequences, [1, 4, 5]);
    server.complete(&session, 0).await.refused(StatusCode::BAD_REQUEST, "bad-request");
    assert_eq!(server.storage.sessions("faces").await.unwrap()[0].receipt, None);
    server.stored(&session, &[event(1), event(4), event(5)]).await;
    let receipt = server.receipt(&session, 6).await;
    assert_eq!((receipt.stored, receipt.receipt.len()), (6, 64));
    assert!(server.storage.sessions("faces").await.unwrap()[0].receipt.is_some());
}

pub async fn a_receipt_stays_the_same(server: &TestServer) {
    let first = server.start(1).await.session;
    let second = server.start(2).await.session;
    for session in [&first, &second] {
        server.stored(session, &events(0..3)).await;
    }
    let receipt = server.receipt(&first, 3).await;
    // An event that comes late is stored; the receipt covers what it covered.
    server.stored(&first, &[event(3)]).await;
    assert_eq!(server.receipt(&first, 3).await, receipt);
    assert_eq!(server.resume(&first).await.events.len(), 4);
    // The same answers of another participant have another receipt.
    assert_ne!(server.receipt(&second, 3).await.receipt, receipt.receipt);
}

pub async fn the_code_is_given_only_at_the_end(server: &TestServer) {
    let session = server.start(1).await.session;
    let declined = Event { body: json!({"type": "declined"}), ..event(0) };
    server.stored(&session, &[declined]).await;
    let receipt = server.receipt(&session, 1).await;
    assert_eq!((receipt.completion_code, receipt.redirect), (None, None));

    let session = server.start(2).await.session;
    let page = json!({"type": "page_finished", "step": "how", "answers": {"mood": 3}});
    let finished = |sequence| Event { body: json!({"type": "finished"}), ..event(sequence) };
    let page = Event { body: page, ..event(1) };
    server.stored(&session, &[event(0), page, finished(2)]).await;
    let receipt = server.receipt(&session, 3).await;
    assert_eq!(receipt.completion_code.as_deref(), Some("C1 X"));
    let address = "https://example.org/back?cc=C1%20X&who=person%202";
    assert_eq!(receipt.redirect.as_deref(), Some(address));

    // Whoever only says to have finished has a receipt, and no code.
    let session = server.start(3).await.session;
    let elsewhere = json!({"type": "page_finished", "step": "nowhere", "answers": {}});
    let elsewhere = Event { body: elsewhere, ..event(0) };
    server.stored(&session, &[elsewhere, finished(1)]).await;
    let receipt = server.receipt(&session, 2).await;
    assert_eq!((receipt.completion_code, receipt.redirect), (None, None));
}

pub async fn withdrawal_deletes_answers_and_identifiers(server: &TestServer) {
    let started = server.start(1).await;
    let kept = server.start(2).await;
    for session in [&started.session, &kept.session] {
        server.stored(session, &events(0..4)).await;
    }
    // Only what the study asks for is kept of the address.
    let identifiers = server.storage.recruitment("faces").await.unwrap();
    let names: Vec<_> = identifiers.iter().map(|entry| (entry.participant, &*entry.name)).collect();
    assert_eq!(names, [(1, "PROLIFIC_PID"), (2, "PROLIFIC_PID")]);

    let typed = started.withdrawal_code.to_lowercase().replace('-', " ");
    assert_eq!(server.withdrawn(&started.session, &typed).await.deleted, 4);
    assert_eq!(server.withdrawn(&started.session, &typed).await.deleted, 0);
    let sessions = server.storage.sessions("faces").await.unwrap();
    assert_eq!((sessions[0].standing, sessions[0].event_count), (Standing::Withdrawn, 0));
    assert_eq!(sessions[0].client, "{}");
    assert!(server.storage.events(sessions[0].key).await.unwrap().is_empty());
    assert_eq!(server.storage.recruitment("faces").await.unwrap().len(), 1);
    for answer in [
        server.append(&started.session, &events(4..5)).await,
        server.get(&format!("/api/sessions/{}", started.session)).await,
        server.complete(&started.session, 4).await,
    ] {
        answer.refused(StatusCode::GONE, "withdrawn");
    }
    // Nobody else is touched.
    assert_eq!(server.resume(&kept.session).await.events, events(0..4));
}

pub async fn withdrawal_needs_the_code(server: &TestServer) {
    let started = server.start(1).await;
    let other = server.start(2).await;
    server.stored(&started.session, &events(0..4)).await;
    for wrong in ["", "0000-0000-0000-0000", &other.withdrawal_code] {
        let answer = server.withdraw(&started.session, wrong).await;
        answer.refused(StatusCode::FORBIDDEN, "wrong-withdrawal-code");
    }
    assert_eq!(server.resume(&started.session).await.events.len(), 4);
}

pub async fn unknown_sessions_and_studies_are_not_found(server: &TestServer) {
    let unknown = "0123456789abcdef0123456789abcdef";
    for token in [unknown, "x", "%2e%2e%2fetc%2fpasswd", &"0".repeat(4000)] {
        for answer in [
            server.get(&format!("/api/sessions/{token}")).await,
            server.append(token, &events(0..1)).await,
            server.complete(token, 1).await,
            server.withdraw(token, "0000-0000-0000-0000").await,
        ] {
            answer.refused(StatusCode::NOT_FOUND, "unknown-session");
        }
    }
    let start = json!({"nonce": unknown, "language": "en"});
    for answer in [
        server.get("/api/studies/other").await,
        server.post("/api/studies/other/sessions", start).await,
        server.get("/s/other/").await,
    ] {
        answer.refused(StatusCode::NOT_FOUND, "unknown-study");
    }
    server.get("/api/nothing").await.refused(StatusCode::NOT_FOUND, "not-found");
    let wrong_method = server.get("/api/studies/faces/sessions").await;
    wrong_method.refused(StatusCode::METHOD_NOT_ALLOWED, "method-not-allowed");
}

pub async fn bad_requests_are_refusals(server: &TestServer) {
    let session = server.start(1).await.session;
    let path = format!("/api/sessions/{session}/events");
    for body in [
        json!({}),
        json!({"events": 1}),
        json!({"events": [{"sequence": -1, "at_ms": 0, "body": {}}]}),
        json!({"events": [{"sequence": 1.5, "at_ms": 0, "body": {}}]}),
        json!({"events": [{"sequence": 18_446_744_073_709_551_615_u64, "at_ms": 0, "body": {}}]}),
        json!({"events": [{"sequence": 100_000, "at_ms": 0, "body": {}}]}),
        json!({"events": [{"sequence": 0, "at_ms": "now", "body": {}}]}),
        json!({"events": [{"sequence": 0, "at_ms": null, "body": {}}]}),
        json!({"events": [{"sequence": 0, "at_ms": 0, "body": "text"}]}),
    ] {
        server.post(&path, body).await.refused(StatusCode::BAD_REQUEST, "bad-request");
    }
    for text in
        ["", "{", "\u{0}", "[1]", "{\"events\":[{\"sequence\":0,\"at_ms\":1e999,\"body\":{}}]}"]
    {
        let request = Request::post(&path)
            .header(header::CONTENT_TYPE, "application/json")
            .body(Body::from(text.to_owned()))
            .unwrap();
        server.send(request).await.refused(StatusCode::BAD_REQUEST, "bad-request");
    }
    let plain = Request::post(&path).body(Body::from("{\"events\":[]}")).unwrap();
    server.send(plain).await.refused(StatusCode::UNSUPPORTED_MEDIA_TYPE, "bad-request");
    for nonce in ["", "short", &"F".repeat(32), &"0".repeat(33)] {
        let body = json!({"nonce": nonce, "language": "en"});
        let answer = server.post("/api/studies/faces/sessions", body).await;
        answer.refused(StatusCode::BAD_REQUEST, "bad-request");
    }
    // Strange but harmless values do not keep a participant out.
    let strange = json!({
        "nonce": "0".repeat(32), "language": "\u{0}xx-klingon",
        "recruitment": {"PROLIFIC_PID": "a\u{0}b".repeat(1000)},
        "client": {"browser\u{0}": "\u{0}"},
    });
    let _: SessionStarted = server.post("/api/studies/faces/sessions", strange).await.ok();
    assert!(server.resume(&session).await.events.is_empty());
}

pub async fn oversized_bodies_are_refused(server: &TestServer) {
    let session = server.start(1).await.session;
    let large =
        |bytes: usize| Event { body: json!({"type": "x", "log": "y".repeat(bytes)}), ..event(0) };
    let too_large = server.append(&session, &[large(3_000_000)]).await;
    too_large.refused(StatusCode::PAYLOAD_TOO_LARGE, "too-large");
    let one_event = server.append(&session, &[large(1_100_000)]).await;
    one_event.refused(StatusCode::BAD_REQUEST, "bad-request");
    assert_eq!(server.stored(&session, &[large(1_000_000)]).await.stored, 1);
}

/// Awaits all of them at once.
async fn join_all<T>(futures: impl IntoIterator<Item = impl Future<Output = T>>) -> Vec<T> {
    let mut pending: Vec<_> = futures.into_iter().map(|f| (Box::pin(f), None)).collect();
    std::future::poll_fn(|context| {
        let mut all_done = true;
        for (future, value) in &mut pending {
            if value.is_none() {
                match future.as_mut().poll(context) {
                    std::task::Poll::Ready(done) => *value = Some(done),
                    std::task::Poll::Pending => all_done = false,
                }
            }
        }
        if all_done { std::task::Poll::Ready(()) } else { std::task::Poll::Pending }
    })
    .await;
    pending.into_iter().filter_map(|(_, value)| value).collect()
}
