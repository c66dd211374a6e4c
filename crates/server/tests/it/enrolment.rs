//! Who can begin, in which place of the balance, and how often.

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use mimique_server::{HostedStudy, Stage};
use mimique_session::Standing;
use mimique_session::wire::{Event, Refusal, SessionStarted};
use serde_json::{Value, json};

use crate::client::{Answer, TestServer, event};
use crate::study;

const HOUR: i64 = 3_600_000;

/// The small study with other recruitment keys.
pub fn with(recruitment: Value) -> HostedStudy {
    staged(recruitment, Stage::Live)
}

fn staged(recruitment: Value, stage: Stage) -> HostedStudy {
    let mut file = study::file();
    for (key, value) in recruitment.as_object().unwrap() {
        file["recruitment"][key] = value.clone();
    }
    HostedStudy::new(file, Default::default(), stage).unwrap()
}

pub async fn begin(
    server: &TestServer,
    nonce: u64,
    language: &str,
    who: &str,
    cookie: &str,
) -> Answer {
    let body = json!({
        "nonce": format!("{nonce:032x}"), "language": language,
        "recruitment": {"PROLIFIC_PID": who},
    });
    let request = Request::post("/api/studies/faces/sessions")
        .header(header::CONTENT_TYPE, "application/json")
        .header(header::COOKIE, cookie)
        .body(Body::from(body.to_string()))
        .unwrap();
    server.send(request).await
}

/// Sends `finished` (or another last event) and completes.
async fn end(server: &TestServer, started: &SessionStarted, kind: &str) {
    let last = Event { body: json!({"type": kind}), ..event(1) };
    server.stored(&started.session, &[event(0), last]).await;
    server.receipt(&started.session, 2).await;
}

async fn slots(server: &TestServer, nonces: std::ops::Range<u64>) -> Vec<u64> {
    let mut slots = Vec::new();
    for nonce in nonces {
        slots.push(server.start(nonce).await.slot);
    }
    slots
}

/// Lets the reservation of a participant run out.
async fn let_expire(server: &TestServer, participant: u64) {
    assert!(participant < 10);
    let statement = [
        "",
        "UPDATE sessions SET slot_expires_ms = 1, started_ms = 1, last_event_ms = NULL WHERE participant = 1",
        "UPDATE sessions SET slot_expires_ms = 1, started_ms = 1, last_event_ms = NULL WHERE participant = 2",
        "UPDATE sessions SET slot_expires_ms = 1, started_ms = 1, last_event_ms = NULL WHERE participant = 3",
    ][participant as usize];
    server.run_sql(statement).await;
}

pub async fn the_slot_of_a_drop_out_goes_to_the_next(server: &TestServer) {
    assert_eq!(slots(server, 1..5).await, [1, 2, 3, 4]);
    let second = server.start(2).await;
    // The first finishes, the second's time runs out, the third withdraws, the fourth declines.
    end(server, &server.start(1).await, "finished").await;
    let_expire(server, 2).await;
    let third = server.start(3).await;
    server.withdrawn(&third.session, &third.withdrawal_code).await;
    end(server, &server.start(4).await, "declined").await;
    assert_eq!(slots(server, 5..10).await, [2, 3, 4, 5, 6]);
    // Numbers are never given again.
    assert_eq!(server.start(9).await.participant, 9);
    // Who comes back late finds the order as it was, and finishes without taking anybody's place.
    assert_eq!(server.start(2).await, second);
    end(server, &second, "finished").await;
    server.withdrawn(&second.session, &second.withdrawal_code).await;
    assert_eq!(server.start(10).await.slot, 7, "the slot was given already");
    // A participant who had finished takes the answers back: the slot is free again.
    let first = server.start(1).await;
    server.withdrawn(&first.session, &first.withdrawal_code).await;
    assert_eq!(server.start(11).await.slot, 1);
}

pub async fn a_sign_of_life_keeps_the_slot(server: &TestServer) {
    let started = server.start(1).await;
    let hash = study::sha256(&started.session);
    let before = server.storage.session(&hash).await.unwrap();
    let began = before.started_ms;
    // Until something is heard of the page the slot is its own for a minute.
    assert_eq!(before.slot_expires_ms, Some(began + HOUR / 60));
    // Early in the reservation nothing is written; late in it, it begins anew.
    for (sequence, minutes, expected) in
        [(0, 0, 60), (1, 10, 60), (2, 40, 100), (3, 60, 100), (4, 99, 159)]
    {
        let now = began + minutes * HOUR / 60;
        server.storage.append(&hash, vec![event(sequence)], now).await.unwrap();
        let record = server.storage.session(&hash).await.unwrap();
        assert_eq!(record.slot_expires_ms, Some(began + expected * HOUR / 60), "{minutes} min");
    }
    // After its end it is not revived: somebody else may have it.
    server.storage.append(&hash, vec![event(5)], began + 3 * HOUR).await.unwrap();
    let record = server.storage.session(&hash).await.unwrap();
    assert_eq!(record.slot_expires_ms, Some(began + 159 * HOUR / 60));
    // A page that is heard of for the first time after its minute has the slot, if nobody else has.
    let late = server.start(2).await;
    let hash = study::sha256(&late.session);
    let began = server.storage.session(&hash).await.unwrap().started_ms;
    server.storage.append(&hash, vec![event(0)], began + HOUR).await.unwrap();
    let record = server.storage.session(&hash).await.unwrap();
    assert_eq!(record.slot_expires_ms, Some(began + 2 * HOUR));
}

pub async fn slots_are_given_one_after_the_other(server: &TestServer) {
    let starts: Vec<_> = (0..30)
        .map(|nonce| {
            let storage = server.storage.clone();
            let session = crate::storage::session("faces", format!("{nonce:064}"));
            tokio::spawn(async move { storage.start(session).await.unwrap().slot })
        })
        .collect();
    let mut given = Vec::new();
    for start in starts {
        given.push(start.await.unwrap());
    }
    given.sort_unstable();
    assert_eq!(given, (1..=30).collect::<Vec<_>>());
}

pub async fn the_study_closes_when_it_is_full(server: &TestServer) {
    let server = server.restart_with(vec![with(json!({"participants": 2}))]).await;
    let first = server.start(1).await;
    let second = server.start(2).await;
    let refused = |answer: Answer| answer.refused(StatusCode::FORBIDDEN, "study-full");
    let english = refused(begin(&server, 3, "en", "c", "").await);
    let french = refused(begin(&server, 3, "fr-CA", "c", "").await);
    assert!(english.message.contains("enough participants"), "{english:?}");
    assert!(french.message.contains("assez de participants"), "{french:?}");
    // Who is in goes on, and finishing keeps the place.
    assert_eq!(server.start(1).await, first);
    end(&server, &first, "finished").await;
    refused(begin(&server, 3, "en", "c", "").await);
    // A drop-out's place opens the study again, once.
    let_expire(&server, second.participant).await;
    assert_eq!(server.start(3).await.slot, 2);
    refused(begin(&server, 4, "en", "d", "").await);
    // A pilot counts by itself, and a changed file goes on counting.
    let pilot = staged(json!({"participants": 2}), Stage::Pilot);
    let server = server.restart_with(vec![pilot]).await;
    let tried = server.start(5).await;
    assert_eq!((tried.slot, tried.stage.as_str()), (1, "pilot"));
    let larger = with(json!({"participants": 3}));
    let server = server.restart_with(vec![larger]).await;
    assert_eq!(server.app.registered("faces").unwrap().version, 3);
    assert_eq!(server.app.registered("faces").unwrap().running_elsewhere, 2);
    assert_eq!(server.start(6).await.slot, 1, "the balance of a new version begins anew");
    refused(begin(&server, 7, "en", "e", "").await);
    server.storage.close().await;
}

pub async fn the_study_has_hours(server: &TestServer) {
    let past = "2020-01-01T00:00:00Z";
    let future = "2999-01-01T00:00:00Z";
    let first = server.start(1).await;
    for (rules, code) in [
        (json!({"opens": future}), "study-not-open"),
        (json!({"opens": past, "closes": past}), "study-closed"),
    ] {
        let server = server.restart_with(vec![with(rules)]).await;
        let refusal = begin(&server, 2, "fr", "b", "").await.refused(StatusCode::FORBIDDEN, code);
        assert!(refusal.message.starts_with("L’étude"), "{refusal:?}");
        // A session that has begun goes on.
        assert_eq!(server.start(1).await.participant, first.participant);
        end(&server, &first, "finished").await;
        server.storage.close().await;
    }
    let open = with(json!({"opens": past, "closes": future}));
    let server = server.restart_with(vec![open]).await;
    server.start(3).await;
    server.storage.close().await;
}

pub async fn an_identifier_takes_part_once(server: &TestServer) {
    let rules = json!({"repeatPrevention": "recruitmentIdentifier"});
    let server = server.restart_with(vec![with(rules.clone())]).await;
    let started: SessionStarted = begin(&server, 1, "en", "anna", "").await.ok();
    assert_eq!(begin(&server, 1, "en", "anna", "").await.ok::<SessionStarted>(), started);
    let again = begin(&server, 2, "en", " anna ", "").await;
    let refusal = again.refused(StatusCode::FORBIDDEN, "already-took-part");
    assert!(refusal.message.contains("already"), "{refusal:?}");
    let _: SessionStarted = begin(&server, 3, "en", "bea", "").await.ok();
    begin(&server, 4, "en", " ", "").await.refused(StatusCode::FORBIDDEN, "no-identifier");
    assert_eq!(server.storage.sessions("faces").await.unwrap().len(), 2, "nothing was written");
    // Who withdraws leaves no trace by which to be recognised.
    server.withdrawn(&started.session, &started.withdrawal_code).await;
    let _: SessionStarted = begin(&server, 2, "en", "anna", "").await.ok();
    // Nor does one whose identifiers were erased; the answers stay.
    assert_eq!(server.storage.erase_identifiers("faces", Some(2), "somebody", 5).await.unwrap(), 2);
    let _: SessionStarted = begin(&server, 5, "en", "bea", "").await.ok();
    // A pilot may be repeated.
    let server = server.restart_with(vec![staged(rules, Stage::Pilot)]).await;
    for nonce in 6..8 {
        let _: SessionStarted = begin(&server, nonce, "en", "bea", "").await.ok();
    }
    server.storage.close().await;
}

pub async fn a_browser_takes_part_once(server: &TestServer) {
    let rules = json!({"repeatPrevention": "browser"});
    let server = server.restart_with(vec![with(rules)]).await;
    let answer = begin(&server, 1, "en", "", "").await;
    let cookie = answer.header(header::SET_COOKIE).to_owned();
    for part in ["mimique-faces=", "HttpOnly", "SameSite=Strict", "Path=/api/studies/faces/;"] {
        assert!(cookie.contains(part), "{cookie}");
    }
    let started: SessionStarted = answer.ok();
    let mark = format!("theme=dark; {}", cookie.split(';').next().unwrap());
    // The answer was lost on its way: the same request has the same answer and the same mark.
    for held in ["", &mark] {
        let repeated = begin(&server, 1, "en", "", held).await;
        assert_eq!(repeated.header(header::SET_COOKIE), cookie);
        assert_eq!(repeated.ok::<SessionStarted>(), started);
    }
    let again = begin(&server, 2, "fr", "", &mark).await;
    let refusal: Refusal = again.refused(StatusCode::FORBIDDEN, "already-took-part");
    assert!(refusal.message.starts_with("Vous avez déjà"), "{refusal:?}");
    let _: SessionStarted = begin(&server, 3, "en", "", "mimique-faces=nonsense").await.ok();
    let _: SessionStarted = begin(&server, 4, "en", "", "").await.ok();
    server.storage.close().await;
}

/// Browsers send the mark back from a frame of another site only where it is `SameSite=None`, which they take over
/// encrypted connections alone.
pub async fn a_browser_takes_part_once_in_a_frame_too(server: &TestServer) {
    let server = server.restart_with(vec![with(json!({"repeatPrevention": "browser"}))]).await;
    let embedding = vec!["https://survey.example".to_owned()];
    for (behind_tls, embedding, expected) in [
        (true, embedding.clone(), "SameSite=None; Secure; Partitioned"),
        (true, Vec::new(), "SameSite=Strict; Secure"),
        (false, embedding, "SameSite=Strict"),
    ] {
        let settings = mimique_server::Settings { behind_tls, embedding, ..Default::default() };
        let answer = begin(&server.with_settings(settings), 1, "en", "", "").await;
        let cookie = answer.header(header::SET_COOKIE);
        assert!(cookie.ends_with(expected), "{cookie}");
    }
    server.storage.close().await;
}

pub async fn nothing_finer_than_a_browsers_name_is_kept(server: &TestServer) {
    let agent = "Mozilla/5.0 (X11; Linux x86_64; rv:140.0) Gecko/20100101 Firefox/140.0";
    let body = json!({
        "nonce": "0".repeat(32), "language": "en",
        "client": {"browser": agent, "version": "140.0.2 (64 bit)", "platform": "Linux",
            "userAgent": agent, "ip": "192.0.2.7"},
    });
    let _: SessionStarted = server.post("/api/studies/faces/sessions", body).await.ok();
    let stored = &server.storage.sessions("faces").await.unwrap()[0];
    let expected = json!({"browser": "Mozilla", "version": "140", "platform": "Linux"});
    assert_eq!(serde_json::from_str::<Value>(&stored.client).unwrap(), expected);
}

pub async fn a_clock_that_jumps_back_loses_nothing(server: &TestServer) {
    let started = server.start(1).await;
    let hash = study::sha256(&started.session);
    let began = server.storage.session(&hash).await.unwrap().started_ms;
    for (sequence, now) in [(0, began + 5), (1, began - 40_000_000_000), (2, -7), (3, 0)] {
        let appended = server.storage.append(&hash, vec![event(sequence)], now).await.unwrap();
        assert_eq!(appended.acknowledged.stored, sequence + 1);
    }
    let completed = server.storage.complete(&hash, 4, b"key", began - HOUR).await.unwrap();
    assert_eq!(completed.stored, 4);
    let mut earlier = crate::storage::session("faces", "2".repeat(64));
    earlier.now_ms = -1_000;
    let record = server.storage.start(earlier).await.unwrap();
    assert_eq!(record.participant, 2);
    assert_eq!(server.resume(&started.session).await.events, crate::client::events(0..4));
}

/// A study of two conditions between participants.
fn two_conditions() -> HostedStudy {
    let mut file = study::file();
    file["components"]["hint"] = json!({"type": "page", "heading": {"en": "Hint", "fr": "Indice"},
        "text": {"en": "Look.", "fr": "Regardez."}});
    file["sequence"] = json!({"order": "fixed", "components": [
        {"id": "hinted", "conditional": true, "order": "fixed", "components": ["hint", "how"]},
        {"id": "plain", "conditional": true, "order": "fixed", "components": ["how"]},
    ]});
    study::host(file)
}

async fn arrive(
    server: &TestServer,
    nonce: u64,
    condition: Option<&str>,
    language: &str,
) -> Answer {
    let mut body = json!({"nonce": format!("{nonce:032x}"), "language": language});
    if let Some(name) = condition {
        body["condition"] = name.into();
    }
    server.post("/api/studies/faces/sessions", body).await
}

async fn arrived(server: &TestServer, nonce: u64, condition: Option<&str>) -> SessionStarted {
    arrive(server, nonce, condition, "en").await.ok()
}

pub async fn the_address_puts_a_participant_into_a_condition(server: &TestServer) {
    // Nor is a condition passed over in a study that has none.
    let refusal = arrive(server, 1, Some("plain"), "en").await;
    refusal.refused(StatusCode::FORBIDDEN, "unknown-condition");
    assert_eq!(server.start(1).await.condition, None);
    let server = server.restart_with(vec![two_conditions()]).await;
    let mut slots = Vec::new();
    for nonce in 2..5 {
        let started = arrived(&server, nonce, Some("plain")).await;
        assert_eq!(started.condition.as_deref(), Some("plain"));
        slots.push(started.slot);
        // Neither a repeated request, nor another address, nor one that names nothing known changes it.
        for address in [Some("plain"), Some("hinted"), Some("nonsense"), None] {
            assert_eq!(arrived(&server, nonce, address).await, started);
        }
        assert_eq!(server.resume(&started.session).await.started, started);
    }
    assert_eq!(slots, [1, 2, 3]);
    // Each condition has slots of its own.
    assert_eq!(arrived(&server, 5, Some("hinted")).await.slot, 1);
    for (name, language, message) in [
        ("Plain", "en", "The address asks for the condition “Plain”"),
        ("plain,hinted", "fr", "L’adresse demande la condition «\u{a0}plain,hinted\u{a0}»"),
        ("", "en", "The address asks for the condition “”"),
    ] {
        let refusal = arrive(&server, 6, Some(name), language).await;
        let refusal = refusal.refused(StatusCode::FORBIDDEN, "unknown-condition");
        assert!(refusal.message.starts_with(message), "{refusal:?}");
        assert!(refusal.message.ends_with("hinted, plain."), "{refusal:?}");
    }
    assert_eq!(server.storage.sessions("faces").await.unwrap().len(), 5, "nothing was written");
    // A withdrawal keeps the row's condition, and gives its slot back to that condition alone.
    let second = arrived(&server, 3, None).await;
    server.withdrawn(&second.session, &second.withdrawal_code).await;
    assert_eq!(arrived(&server, 7, Some("hinted")).await.slot, 2);
    assert_eq!(arrived(&server, 8, Some("plain")).await.slot, 2);
    server.storage.close().await;
}

pub async fn conditions_are_balanced_over_those_who_finish(server: &TestServer) {
    let server = server.restart_with(vec![two_conditions()]).await;
    let conditions = async |nonces: std::ops::Range<u64>| {
        let mut counts = std::collections::BTreeMap::new();
        for nonce in nonces {
            let condition = arrived(&server, nonce, None).await.condition.unwrap();
            *counts.entry(condition).or_insert(0) += 1;
        }
        counts.into_values().collect::<Vec<i32>>()
    };
    // Reservations count; after each two there are as many in both.
    for nonce in [1, 3, 5] {
        assert_eq!(conditions(nonce..nonce + 2).await, [1, 1]);
    }
    // All who are in one condition drop out, those in the other finish: the next three replace them.
    let mut left = Vec::new();
    for nonce in 1..7 {
        let started = arrived(&server, nonce, None).await;
        match started.condition.as_deref() {
            Some("plain") => end(&server, &started, "finished").await,
            _ => {
                left.push(started.slot);
                end(&server, &started, "declined").await;
            }
        }
    }
    let mut slots = Vec::new();
    for nonce in 7..10 {
        let started = arrived(&server, nonce, None).await;
        assert_eq!(started.condition.as_deref(), Some("hinted"));
        slots.push(started.slot);
    }
    assert_eq!(slots, left);
    // Who was sent by an address counts as others do.
    arrived(&server, 10, Some("plain")).await;
    arrived(&server, 11, Some("plain")).await;
    assert_eq!(arrived(&server, 12, None).await.condition.as_deref(), Some("hinted"));
    // A session keeps its condition when it ends.
    let sessions = server.storage.sessions("faces").await.unwrap();
    let finished = sessions.iter().filter(|session| session.standing == Standing::Completed);
    let finished: Vec<_> = finished.map(|session| session.condition.clone()).collect();
    assert_eq!(finished, vec![Some("plain".to_owned()); 3]);
    // The researchers' page counts them, and follows each on its own way.
    let mut owner = crate::people::owner(&server).await;
    let page = owner.open(&server, "/researcher/studies/faces").await.text();
    for part in [
        "<th scope=\"row\">hinted</th><td class=\"number\">0</td><td class=\"number\">4</td>",
        "<th scope=\"row\">plain</th><td class=\"number\">3</td><td class=\"number\">2</td>",
        "<h2>Where people are and where they leave (hinted)</h2>",
        "<h2>Where people are and where they leave (plain)</h2>",
    ] {
        assert!(page.contains(part), "{part} in {page}");
    }
    assert_eq!(page.matches("<th scope=\"row\">hint</th>").count(), 1, "{page}");
    let last = sessions.last().unwrap();
    let page = format!("/researcher/studies/faces/participants/{}", last.participant);
    let page = owner.open(&server, &page).await.text();
    assert!(page.contains("<dt>Condition</dt><dd>hinted</dd>"), "{page}");
    server.storage.close().await;
}

/// Asks whether somebody could begin.
async fn ask(server: &TestServer, nonce: u64, who: &str) -> Answer {
    let body = json!({
        "nonce": format!("{nonce:032x}"), "language": "en", "recruitment": {"PROLIFIC_PID": who},
    });
    server.post("/api/studies/faces/arrivals", body).await
}

/// Somebody who has declined, or whose device cannot take part.
async fn turn_away(server: &TestServer, nonce: u64, who: &str, kind: Value) -> SessionStarted {
    let body = json!({
        "nonce": format!("{nonce:032x}"), "language": "en", "turned_away": true,
        "recruitment": {"PROLIFIC_PID": who},
    });
    let started: SessionStarted = server.post("/api/studies/faces/sessions", body).await.ok();
    let last = Event { body: kind, ..event(1) };
    server.stored(&started.session, &[event(0), last]).await;
    started
}

pub async fn who_only_looks_or_is_turned_away_holds_no_place_and_uses_no_identifier(
    server: &TestServer,
) {
    let study = with(json!({
        "participants": 1, "repeatPrevention": "recruitmentIdentifier",
        "screenedOutCode": "NO-DEVICE",
    }));
    let server = server.restart_with(vec![study]).await;
    // Many look at the last place: it stays free, whoever asks and as often as they ask.
    for nonce in 1..4 {
        ask(&server, nonce, "ann").await.ok::<()>();
    }
    turn_away(&server, 5, "ben", json!({"type": "declined"})).await;
    let device =
        json!({"type": "screened_out", "step": "device", "reason": "device", "details": []});
    let phone = turn_away(&server, 6, "ann", device).await;
    let receipt = server.receipt(&phone.session, 2).await;
    assert_eq!(receipt.completion_code.as_deref(), Some("NO-DEVICE"));
    // On a computer the same person begins, in the place that nobody has taken.
    ask(&server, 7, "ann").await.ok::<()>();
    let answer = begin(&server, 7, "en", "ann", "").await;
    let ann: SessionStarted = answer.ok();
    assert_eq!(ann.slot, 1);
    // Now there is none left, and the identifier is used.
    ask(&server, 8, "ben").await.refused(StatusCode::FORBIDDEN, "study-full");
    ask(&server, 9, "ann").await.refused(StatusCode::FORBIDDEN, "already-took-part");
    ask(&server, 7, "ann").await.ok::<()>();
    // Whoever was turned away and goes on all the same gets no code.
    let sly = turn_away(&server, 10, "eve", json!({"type": "finished"})).await;
    let receipt = server.receipt(&sly.session, 2).await;
    assert_eq!((receipt.completion_code, receipt.redirect), (None, None));
}
