//! The researcher's pages.

use axum::http::{StatusCode, header};

use crate::client::{TestServer, events};
use crate::participant::takes_part;
use crate::study;

/// The cookie of a browser that opened the printed address.
async fn cookie(server: &TestServer) -> String {
    let link = server.app.researcher_link().await.unwrap();
    let admitted = server.get(&link).await;
    admitted.header(header::SET_COOKIE).split(';').next().unwrap().to_owned()
}

pub async fn the_page_needs_the_printed_address(server: &TestServer) {
    let denied = server.get("/researcher").await;
    assert_eq!(denied.status, StatusCode::FORBIDDEN);
    let wrong = server.get("/researcher?key=00112233445566778899aabbccddeeff").await;
    assert_eq!(wrong.status, StatusCode::FORBIDDEN);

    let link = server.app.researcher_link().await.unwrap();
    let admitted = server.get(&link).await;
    assert_eq!(admitted.status, StatusCode::SEE_OTHER);
    assert_eq!(admitted.header(header::LOCATION), "/researcher");
    let cookie = admitted.header(header::SET_COOKIE);
    assert!(cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"), "{cookie}");
    let cookie = cookie.split(';').next().unwrap();
    let page = server.get_with("/researcher", &[(header::COOKIE, cookie)]).await;
    assert_eq!(page.status, StatusCode::OK);
    // The key of the address is no cookie.
    let key = link.split('=').nth(1).unwrap();
    let forged = format!("mimique_researcher={key}");
    let answer = server.get_with("/researcher", &[(header::COOKIE, &forged)]).await;
    assert_eq!(answer.status, StatusCode::FORBIDDEN);
}

pub async fn the_page_shows_what_was_stored(server: &TestServer) {
    let demo = study::demo();
    for (nonce, steps) in [(1, usize::MAX), (2, 6)] {
        let started = server.start_in("demo", nonce).await;
        let (events, _) = takes_part(demo.study(), &started, steps);
        server.stored(&started.session, &events).await;
        if nonce == 1 {
            server.receipt(&started.session, events.len() as u64).await;
        }
    }
    let started = server.start(3).await;
    server.stored(&started.session, &events(0..2)).await;
    server.withdrawn(&started.session, &started.withdrawal_code).await;

    let cookie = cookie(server).await;
    let page = server.get_with("/researcher", &[(header::COOKIE, &cookie)]).await.text();
    for (standing, count) in [("completed", 1), ("under way", 1), ("withdrawn", 1)] {
        let wanted = format!("<dt>{standing}</dt><dd>{count}</dd>");
        assert!(page.contains(&wanted), "{wanted} in {page}");
    }
    // Twelve trials of the one who completed: six by each method.
    let boxed = "<th scope=\"row\">box</th>";
    let row = &page[page.find(boxed).unwrap()..];
    let row = &row[..row.find("</tr>").unwrap()];
    assert!(row.ends_with("<td class=\"number\">6</td>"), "{row}");
    assert!(page.contains("Which emotion do you recognise?"));
    assert!(page.contains("trial "), "where the second participant is");
    for hidden in ["person 1", &started.session, &started.withdrawal_code] {
        assert!(!page.contains(hidden), "{hidden}");
    }
    for inline in ["<style", " style=", " onclick="] {
        assert!(!page.contains(inline), "{inline}");
    }

    // A change is seen at the next look.
    let started = server.start_in("demo", 2).await;
    server.withdrawn(&started.session, &started.withdrawal_code).await;
    let page = server.get_with("/researcher", &[(header::COOKIE, &cookie)]).await.text();
    assert!(page.contains("<dt>under way</dt><dd>0</dd>"), "{page}");
}

pub async fn exports_need_the_cookie(server: &TestServer) {
    for format in ["csv", "wide", "json", "events", "psych-ds"] {
        let path = format!("/researcher/faces/export/{format}");
        server.get(&path).await.refused(StatusCode::FORBIDDEN, "access-denied");
    }
    let cookie = cookie(server).await;
    let with_cookie = [(header::COOKIE, cookie.as_str())];
    for (format, kind, name) in [
        ("csv", "text/csv; charset=utf-8", "faces_responses.csv"),
        ("wide", "text/csv; charset=utf-8", "faces_wide.csv"),
        ("json", "application/x-ndjson", "faces_responses.jsonl"),
        ("events", "application/x-ndjson", "faces_events.jsonl"),
        ("psych-ds", "application/zip", "faces_psych-ds.zip"),
    ] {
        let answer =
            server.get_with(&format!("/researcher/faces/export/{format}"), &with_cookie).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
        assert_eq!(answer.header(header::CONTENT_TYPE), kind);
        let disposition = format!("attachment; filename=\"{name}\"");
        assert_eq!(answer.header(header::CONTENT_DISPOSITION), disposition);
        assert_eq!(answer.header(header::CACHE_CONTROL), "no-store");
    }
    let unknown = server.get_with("/researcher/faces/export/xls", &with_cookie).await;
    unknown.refused(StatusCode::NOT_FOUND, "not-found");
    let unknown = server.get_with("/researcher/other/export/csv", &with_cookie).await;
    unknown.refused(StatusCode::NOT_FOUND, "unknown-study");
}
