//! The withdrawal code: redeemed by the participant's page, the researcher's form and the command line.

use axum::http::{HeaderName, StatusCode, header};
use mimique_server::{Settings, withdrawal_hash};
use mimique_session::Standing;
use mimique_storage::Role;

use crate::client::{TestServer, events};
use crate::people::{Browser, ORIGIN, encoded, invited, owner};
use crate::study;

const PAGE: &str = "/s/faces/withdraw";

async fn who_did_what(server: &TestServer) -> Vec<(String, String, String)> {
    let entries = server.storage.audit_entries(i64::MAX, 100).await.unwrap();
    let deletions = entries.into_iter().filter(|entry| entry.study_id == "faces");
    deletions.map(|entry| (entry.who, entry.action, entry.subject)).collect()
}

pub async fn a_participant_redeems_the_code_alone(server: &TestServer) {
    let started = server.start(1).await;
    let kept = server.start(2).await;
    for session in [&started.session, &kept.session] {
        server.stored(session, &events(0..4)).await;
    }
    // The page is in both languages, whichever the browser asks for.
    let mut browser = Browser::default();
    let page = browser.open(server, PAGE).await;
    assert_eq!(page.status, StatusCode::OK);
    assert!(page.text().contains("Withdrawal code") && page.text().contains("Faces &amp; "));
    let french = browser.open(server, &format!("{PAGE}?lang=fr")).await.text();
    assert!(french.contains("Code de retrait") && french.contains("lang=\"fr\""), "{french}");
    let unknown = browser.open(server, "/s/other/withdraw").await;
    unknown.refused(StatusCode::NOT_FOUND, "unknown-study");
    // A wrong code, a code of nobody, another study's page: nothing is deleted, and it is said.
    for wrong in ["", "0000-0000-0000-0000", "x' OR '1'='1"] {
        let answer = browser.send(server, PAGE, &[("code", wrong)]).await;
        assert_eq!(answer.status, StatusCode::NOT_FOUND, "{wrong}: {}", answer.text());
        assert!(answer.text().contains("has this withdrawal code"), "{}", answer.text());
    }
    let code = started.withdrawal_code.as_str();
    let elsewhere = browser.send(server, "/s/demo/withdraw", &[("code", code)]).await;
    assert_eq!(elsewhere.status, StatusCode::NOT_FOUND);
    // A form that is not from the page is none.
    let forged = browser.send_from(server, PAGE, &[("code", code)], Some(ORIGIN)).await;
    assert_eq!(forged.status, StatusCode::FORBIDDEN);
    let csrf = browser.csrf.clone();
    let fields = [("code", code), ("csrf", csrf.as_str())];
    let foreign = browser.send_from(server, PAGE, &fields, Some("https://evil.example")).await;
    assert_eq!(foreign.status, StatusCode::FORBIDDEN);
    assert_eq!(server.resume(&started.session).await.events.len(), 4);
    // The code as people copy it.
    let typed = code.to_lowercase().replace('-', " ");
    let done = browser.send(server, PAGE, &[("code", &typed)]).await;
    assert_eq!(done.status, StatusCode::OK);
    assert!(done.text().contains("p0001") && done.text().contains("have been deleted"));
    let sessions = server.storage.sessions("faces").await.unwrap();
    assert_eq!((sessions[0].standing, sessions[0].event_count), (Standing::Withdrawn, 0));
    assert_eq!(server.storage.recruitment("faces").await.unwrap().len(), 1);
    assert_eq!(server.resume(&kept.session).await.events.len(), 4, "nobody else is touched");
    // Once more says that nothing is left, and is no second line of the log.
    browser.open(server, PAGE).await;
    let again = browser.send(server, PAGE, &[("code", code)]).await;
    assert!(again.text().contains("nothing of them is left"), "{}", again.text());
    let line = ("(participant)".into(), "withdraw".into(), "p0001".into());
    assert_eq!(who_did_what(server).await, [line]);
    // The page outlives the study's place on the server.
    let server = server.restart_with(vec![study::demo()]).await;
    assert_eq!(Browser::default().open(&server, PAGE).await.status, StatusCode::OK);
    let mut browser = Browser::default();
    browser.open(&server, PAGE).await;
    let done = browser.send(&server, PAGE, &[("code", &kept.withdrawal_code)]).await;
    assert!(done.text().contains("p0002"), "{}", done.text());
    server.storage.close().await;
}

/// The answer to a code that is sent from an address.
async fn attempted(
    server: &TestServer,
    browser: &Browser,
    address: &str,
    code: &str,
) -> StatusCode {
    let request = axum::http::Request::post(PAGE)
        .header(header::HOST, crate::people::HOST)
        .header(header::ORIGIN, ORIGIN)
        .header(header::COOKIE, browser.cookie())
        .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
        .header(HeaderName::from_static("x-real-ip"), address)
        .body(axum::body::Body::from(encoded(&[("code", code), ("csrf", &browser.csrf)])));
    server.send(request.unwrap()).await.status
}

/// In a classroom one address is many people: the wrong codes of some do not refuse the right one of another.
pub async fn a_right_code_is_redeemed_after_wrong_ones(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..4)).await;
    let server = server.with_settings(Settings { behind_proxy: true, ..Settings::default() });
    let mut browser = Browser::default();
    browser.open(&server, PAGE).await;
    let mut last = StatusCode::OK;
    for _ in 0..80 {
        last = attempted(&server, &browser, "192.0.2.1", "X").await;
    }
    assert_eq!(last, StatusCode::TOO_MANY_REQUESTS);
    let right = attempted(&server, &browser, "192.0.2.1", &started.withdrawal_code).await;
    assert_eq!(right, StatusCode::OK);
    let session = &server.storage.sessions("faces").await.unwrap()[0];
    assert_eq!((session.standing, session.event_count), (Standing::Withdrawn, 0));
    // Wrong ones are refused as before.
    let wrong = attempted(&server, &browser, "192.0.2.1", "X").await;
    assert_eq!(wrong, StatusCode::TOO_MANY_REQUESTS);
}

pub async fn codes_cannot_be_tried_without_end(server: &TestServer) {
    let server = server.with_settings(Settings { behind_proxy: true, ..Settings::default() });
    let mut browser = Browser::default();
    browser.open(&server, PAGE).await;
    let attempt = async |address: &'static str| attempted(&server, &browser, address, "X").await;
    let mut tried = 0;
    for _ in 0..80 {
        match attempt("192.0.2.1").await {
            StatusCode::NOT_FOUND => tried += 1,
            other => assert_eq!(other, StatusCode::TOO_MANY_REQUESTS),
        }
    }
    assert!((50..70).contains(&tried), "{tried}");
    assert_eq!(attempt("192.0.2.2").await, StatusCode::NOT_FOUND, "others are served");
}

pub async fn a_researcher_redeems_a_code_that_was_sent(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..4)).await;
    let mut owner = owner(server).await;
    let form = "/researcher/studies/faces/withdraw";
    let code = [("code", started.withdrawal_code.as_str())];
    let page = owner.open(server, "/researcher/studies/faces").await.text();
    assert!(
        page.contains(&format!("action=\"{form}\"")) && page.contains("href=\"/s/faces/withdraw\"")
    );
    // Deleting is an owner's.
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    analyst.send(server, form, &code).await.refused(StatusCode::FORBIDDEN, "not-allowed");
    owner.open(server, "/researcher/studies/faces").await;
    let wrong = owner.send(server, form, &[("code", "0000-0000-0000-0000")]).await;
    wrong.refused(StatusCode::NOT_FOUND, "unknown-withdrawal-code");
    assert_eq!(server.resume(&started.session).await.events.len(), 4);
    let done = owner.send(server, form, &code).await;
    assert_eq!(done.status, StatusCode::SEE_OTHER, "{}", done.text());
    assert_eq!(done.header(header::LOCATION), "/researcher/studies/faces/participants/1");
    let sessions = server.storage.sessions("faces").await.unwrap();
    assert_eq!((sessions[0].standing, sessions[0].event_count), (Standing::Withdrawn, 0));
    let line = ("owner@example.org".into(), "withdraw".into(), "p0001".into());
    assert_eq!(who_did_what(server).await[0], line);
}

/// What the page does in the middle of a session is in the log too.
pub async fn a_withdrawal_of_the_page_is_in_the_log(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..2)).await;
    server.withdrawn(&started.session, &started.withdrawal_code).await;
    let line = ("(participant)".into(), "withdraw".into(), "p0001".into());
    assert_eq!(who_did_what(server).await, [line]);
    let hash = withdrawal_hash(&started.withdrawal_code);
    let again = server.storage.withdraw_by_code(None, &hash, "(server)", 5).await.unwrap();
    assert_eq!((again.participant, again.deleted), (1, 0));
}
