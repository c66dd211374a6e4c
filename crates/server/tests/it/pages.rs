//! Pages, assets and packs: their headers and forms.

use axum::http::{StatusCode, header};
use mimique_server::Settings;
use mimique_session::wire::{Bundle, StudySummary};

use crate::client::TestServer;
use crate::study;

pub async fn pages_carry_a_strict_policy(server: &TestServer) {
    let mut owner = crate::people::owner(server).await;
    for path in ["/", "/s/faces/", "/preview/faces", "/researcher", "/researcher/studies/faces"] {
        let answer = owner.open(server, path).await;
        assert_eq!(answer.status, StatusCode::OK, "{path}");
        let policy = answer.header(header::CONTENT_SECURITY_POLICY);
        assert!(policy.contains("default-src 'none'"), "{policy}");
        assert!(!policy.contains("unsafe-inline") && !policy.contains("'unsafe-eval'"), "{policy}");
        assert_eq!(answer.header(header::X_CONTENT_TYPE_OPTIONS), "nosniff");
        // Without its own pages' origin no form could be told from a forged one.
        let own = if path.starts_with("/researcher") { "same-origin" } else { "no-referrer" };
        assert_eq!(answer.header(header::REFERRER_POLICY), own);
        assert_eq!(answer.header(header::X_FRAME_OPTIONS), "DENY");
        assert!(!answer.text().contains("<feelings>"), "the title is escaped");
    }
    let french = [(header::ACCEPT_LANGUAGE, "fr-CA,fr;q=0.9,en;q=0.8")];
    let page = server.get_with("/s/faces/", &french).await.text();
    assert!(page.contains("<html lang=\"fr\"><title>Visages</title>"), "{page}");
    // What the recruitment platform appended survives the missing slash.
    let answer = server.get("/s/faces?PROLIFIC_PID=7&x=%20").await;
    assert_eq!(answer.status, StatusCode::PERMANENT_REDIRECT);
    assert_eq!(answer.header(header::LOCATION), "/s/faces/?PROLIFIC_PID=7&x=%20");
}

pub async fn only_pages_that_are_named_may_embed_a_study(server: &TestServer) {
    let origin = "https://survey.example";
    let settings = Settings { embedding: vec![origin.to_owned()], ..Settings::default() };
    let server = server.with_settings(settings);
    let answer = server.get("/s/faces/").await;
    let policy = answer.header(header::CONTENT_SECURITY_POLICY);
    assert!(policy.contains(&format!("frame-ancestors {origin};")), "{policy}");
    assert!(!answer.headers.contains_key(header::X_FRAME_OPTIONS));
    let told = format!("data-study=\"faces\" data-origins=\"{origin}\"");
    assert!(answer.text().contains(&told), "{}", answer.text());
    // Nothing else of the server may be embedded.
    for path in ["/", "/s/faces/withdraw", "/researcher/login"] {
        let answer = server.get(path).await;
        assert!(answer.header(header::CONTENT_SECURITY_POLICY).contains("frame-ancestors 'none'"));
        assert_eq!(answer.header(header::X_FRAME_OPTIONS), "DENY", "{path}");
    }
}

pub async fn assets_and_packs_are_kept_for_ever(server: &TestServer) {
    let page = server.get("/s/faces/").await.text();
    let start = page.find("/assets/").unwrap();
    let prefix = &page[start..start + "/assets/".len() + 16];
    let style = format!("{prefix}/style/style.css");
    let pack = format!("/packs/{}", study::sha256(&study::pack()));
    for path in [&style, &pack] {
        let plain = server.get(path).await;
        assert_eq!(plain.status, StatusCode::OK, "{path}");
        assert_eq!(plain.header(header::CONTENT_ENCODING), "");
        for (accepted, coding) in [("gzip, br", "br"), ("gzip", "gzip")] {
            let packed = server.get_with(path, &[(header::ACCEPT_ENCODING, accepted)]).await;
            assert_eq!(packed.header(header::CONTENT_ENCODING), coding);
            assert_eq!(packed.header(header::VARY), "Accept-Encoding");
            assert_eq!(packed.header(header::CACHE_CONTROL), "public, max-age=31536000, immutable");
            assert!(packed.body.len() < plain.body.len() / 4);
        }
    }
    assert_eq!(server.get(&style).await.header(header::CONTENT_TYPE), "text/css; charset=utf-8");
    assert_eq!(server.get(&pack).await.text(), study::pack());
    for path in [
        format!("{prefix}/participant/index.html"),
        format!("{prefix}/../style/style.css"),
        format!("{prefix}/%2e%2e/style/style.css"),
        "/assets/0000000000000000/style/style.css".to_owned(),
    ] {
        server.get(&path).await.refused(StatusCode::NOT_FOUND, "not-found");
    }
    let unknown = format!("/packs/{}", "0".repeat(64));
    server.get(&unknown).await.refused(StatusCode::NOT_FOUND, "unknown-pack");
    server.get("/packs/..%2fanswers.sqlite").await.refused(StatusCode::NOT_FOUND, "unknown-pack");
}

pub async fn the_study_tells_participants_no_secrets(server: &TestServer) {
    let mut owner = crate::people::owner(server).await;
    let studies: Vec<StudySummary> = owner.open(server, "/api/studies").await.ok();
    let ids: Vec<_> = studies.iter().map(|study| &*study.id).collect();
    assert_eq!(ids, ["demo", "faces"]);
    assert_eq!(studies[1].title, study::file()["studyMetadata"]["title"]);
    let answer = server.get("/api/studies/faces").await;
    let bundle: Bundle = answer.ok();
    assert_eq!(bundle.config_hash, studies[1].config_hash);
    let study = mimique_study::Study::from_value(&study::file()).unwrap();
    assert_eq!(bundle.study, study.projection());
    for secret in ["C1 X", "example.org", "hypotheses"] {
        assert!(!answer.text().contains(secret), "{secret}");
    }
}

pub async fn the_server_says_that_it_is_ready(server: &TestServer) {
    assert_eq!(server.get("/healthz").await.text(), "ok\n");
    assert_eq!(server.get("/readyz").await.text(), "ready\n");
    server.storage.close().await;
    assert_eq!(server.get("/healthz").await.status, StatusCode::OK);
    let answer = server.get("/readyz").await;
    answer.refused(StatusCode::SERVICE_UNAVAILABLE, "unavailable");
}

/// A database that answers and takes nothing stores no answer: a balancer has to know.
pub async fn a_database_that_cannot_be_written_is_not_ready(server: &TestServer) {
    server.run_sql("ALTER TABLE clock_marks RENAME TO elsewhere").await;
    assert_eq!(server.get("/readyz").await.status, StatusCode::INTERNAL_SERVER_ERROR);
    server.run_sql("ALTER TABLE elsewhere RENAME TO clock_marks").await;
    assert_eq!(server.get("/readyz").await.status, StatusCode::OK);
}
