//! What keeps strangers out: headers, parts of files, rates, metrics; and what the logs hold.

use std::io::Write;
use std::sync::{Arc, Mutex};

use axum::body::Body;
use axum::http::{HeaderName, Request, StatusCode, header};
use mimique_server::Settings;
use mimique_storage::StorageError;
use serde_json::json;

use crate::client::{TestServer, event};
use crate::study;

fn name(text: &'static str) -> HeaderName {
    HeaderName::from_static(text)
}

pub async fn browsers_are_told_what_they_may_do(server: &TestServer) {
    for path in ["/", "/s/faces/", "/api/studies", "/nothing", "/healthz", "/researcher"] {
        let answer = server.get(path).await;
        let policy = answer.header(header::CONTENT_SECURITY_POLICY).to_owned();
        for part in ["default-src 'none'", "frame-ancestors 'none'", "base-uri 'none'"] {
            assert!(policy.contains(part), "{path}: {policy}");
        }
        assert!(policy.contains("connect-src 'self';"), "{policy}");
        assert!(!policy.contains("unsafe-inline") && !policy.contains("'unsafe-eval'"), "{policy}");
        assert_eq!(answer.header(header::X_CONTENT_TYPE_OPTIONS), "nosniff", "{path}");
        assert_eq!(answer.header(header::X_FRAME_OPTIONS), "DENY", "{path}");
        assert_eq!(answer.header(name("cross-origin-opener-policy")), "same-origin", "{path}");
        assert_eq!(answer.header(header::STRICT_TRANSPORT_SECURITY), "", "without TLS");
    }
    let behind = server.with_settings(Settings {
        behind_tls: true,
        packs_address: Some("https://cdn.example.org:8443/packs".into()),
        ..Settings::default()
    });
    let page = behind.get("/s/faces/").await;
    assert!(page.header(header::STRICT_TRANSPORT_SECURITY).starts_with("max-age=31536000"));
    let policy = page.header(header::CONTENT_SECURITY_POLICY);
    assert!(policy.contains("connect-src 'self' https://cdn.example.org:8443;"), "{policy}");
    assert!(policy.contains("media-src 'self' blob: https://cdn.example.org:8443;"), "{policy}");
    assert!(policy.contains("script-src 'self' 'wasm-unsafe-eval';"), "{policy}");
    assert!(page.text().contains("packs=https://cdn.example.org:8443/packs"), "{}", page.text());
    assert!(server.get("/s/faces/").await.text().contains("packs=/packs"));
}

pub async fn a_part_of_a_video_is_sent(server: &TestServer) {
    let whole = study::pack();
    let path = format!("/packs/{}", study::sha256(&whole));
    let all = server.get(&path).await;
    assert_eq!(all.header(header::ACCEPT_RANGES), "bytes");
    let part = |range: &'static str| {
        let headers = [(header::RANGE, range), (header::ACCEPT_ENCODING, "br, gzip")];
        let path = &path;
        async move { server.get_with(path, &headers).await }
    };
    let answer = part("bytes=2-5").await;
    assert_eq!(answer.status, StatusCode::PARTIAL_CONTENT);
    assert_eq!(answer.text(), whole[2..=5]);
    let of = format!("bytes 2-5/{}", whole.len());
    assert_eq!(answer.header(header::CONTENT_RANGE), of);
    assert_eq!(answer.header(header::CONTENT_ENCODING), "");
    assert_eq!(part("bytes=-7").await.text(), whole[whole.len() - 7..]);
    let beyond = part("bytes=999999-").await;
    beyond.refused(StatusCode::RANGE_NOT_SATISFIABLE, "no-such-range");
    // Several parts at once are more than a video needs: the whole is the answer.
    assert_eq!(part("bytes=0-1,4-5").await.status, StatusCode::OK);
}

pub async fn one_address_cannot_ask_without_end(server: &TestServer) {
    let settings = Settings { behind_proxy: true, requests_per_second: 3, ..Settings::default() };
    let server = server.with_settings(settings);
    let ask = |address: &'static str| {
        let server = &server;
        async move { server.get_with("/api/studies/faces", &[(name("x-real-ip"), address)]).await }
    };
    let mut served = 0;
    for _ in 0..60 {
        let answer = ask("192.0.2.1").await;
        if answer.status == StatusCode::OK {
            served += 1;
        } else {
            assert_eq!(answer.header(header::RETRY_AFTER), "2");
            answer.refused(StatusCode::TOO_MANY_REQUESTS, "too-often");
        }
    }
    assert!((30..50).contains(&served), "{served}");
    assert_eq!(ask("192.0.2.2").await.status, StatusCode::OK, "others are served");
    assert_eq!(ask("127.0.0.1").await.status, StatusCode::OK);
}

/// PostgreSQL takes no NUL: that is no failure of the server's.
pub async fn a_nul_is_refused_wherever_it_comes(server: &TestServer) {
    for path in ["/s/%00/", "/s/fa%00ces/withdraw", "/api/studies/faces?config_hash=%00"] {
        server.get(path).await.refused(StatusCode::BAD_REQUEST, "bad-request");
    }
    let mut owner = crate::people::owner(server).await;
    for (path, field) in [
        ("/researcher/people/invite", "email"),
        ("/researcher/studies/faces/withdraw", "code"),
        ("/researcher/login", "email"),
    ] {
        owner.open(server, "/researcher/account").await;
        if path.ends_with("login") {
            owner.open(server, path).await;
        }
        let fields = [(field, "a\0b@c"), ("role", "viewer"), ("password", "x")];
        let answer = owner.send(server, path, &fields).await;
        assert_eq!(answer.status, StatusCode::BAD_REQUEST, "{path}: {}", answer.text());
    }
}

pub async fn metrics_are_the_operators(server: &TestServer) {
    server.start(1).await;
    server.get("/metrics").await.refused(StatusCode::NOT_FOUND, "not-found");
    let settings = Settings { metrics_token: Some("open sesame".into()), ..Settings::default() };
    let server = server.with_settings(settings);
    let ask = |token: &'static str| {
        let server = &server;
        async move { server.get_with("/metrics", &[(header::AUTHORIZATION, token)]).await }
    };
    ask("Bearer open").await.refused(StatusCode::NOT_FOUND, "not-found");
    let text = ask("Bearer open sesame").await.text();
    let line = "mimique_sessions{study=\"faces\",stage=\"live\",status=\"active\"} 1";
    assert!(text.contains(line), "{text}");
    assert!(!text.contains("person 1") && !text.contains("p0001"), "{text}");
}

/// What was logged, held in memory.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl Log {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.lock().unwrap()).into_owned()
    }
}

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Writes what is logged from now on, on this thread, into the log that is returned.
fn logged() -> (Log, tracing::subscriber::DefaultGuard) {
    let log = Log::default();
    let writer = log.clone();
    let subscriber = tracing_subscriber::fmt()
        .with_max_level(tracing::Level::TRACE)
        .with_ansi(false)
        .with_writer(move || writer.clone())
        .finish();
    (log, tracing::subscriber::set_default(subscriber))
}

/// A panic of a page's module reaches the log in one line; a report that is too long is refused.
pub async fn panics_of_pages_are_logged(server: &TestServer) {
    let (log, _guard) = logged();
    let report = |message: &str| {
        json!({
            "module": "solver", "backend": "", "study": "faces", "message": message,
            "place": "crates/solver/src/fit.rs:7:9",
        })
    };
    let () = server.post("/api/panics", report("no frame\nWARN forged")).await.ok();
    let too_long = server.post("/api/panics", report(&"x".repeat(5000))).await;
    too_long.refused(StatusCode::PAYLOAD_TOO_LARGE, "too-large");
    let incomplete = server.post("/api/panics", json!({"message": "no module"})).await;
    incomplete.refused(StatusCode::BAD_REQUEST, "bad-request");
    let text = log.text();
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("WARN")).collect();
    let [line] = lines[..] else { panic!("one warning: {text}") };
    for part in [
        "a module panicked in a browser",
        "module=\"solver\"",
        "study=\"faces\"",
        "panic=\"no frame\\nWARN forged\"",
        "place=\"crates/solver/src/fit.rs:7:9\"",
    ] {
        assert!(line.contains(part), "{part} in {line}");
    }
}

/// A page that panics again and again fills no log: a few reports of an address are written in a minute, and what is
/// repeated is counted.
pub async fn reports_of_panics_are_few(server: &TestServer) {
    let server = server.with_settings(Settings { behind_proxy: true, ..Settings::default() });
    let (log, _guard) = logged();
    let send = async |address: &str, message: &str| {
        let report = json!({
            "module": "solver", "backend": "", "study": "faces", "message": message, "place": "a.rs:7:9",
        });
        let request = Request::post("/api/panics")
            .header("x-real-ip", address)
            .header(header::CONTENT_TYPE, "application/json")
            .body(Body::from(report.to_string()))
            .unwrap();
        server.send(request).await
    };
    let mut taken = 0;
    for number in 0..200 {
        let answer = send("192.0.2.1", &format!("panic {number}")).await;
        match answer.status {
            StatusCode::OK => taken += 1,
            _ => drop(answer.refused(StatusCode::TOO_MANY_REQUESTS, "too-often")),
        }
    }
    assert!((1..=10).contains(&taken), "{taken} of 200");
    // The same report from many browsers is one line, and the number of its repetitions.
    for address in 0..100 {
        let () = send(&format!("198.51.100.{address}"), "the same").await.ok();
    }
    let text = log.text();
    assert_eq!(text.matches("panic=\"the same\"").count(), 1, "{text}");
    let () = send("203.0.113.1", "another").await.ok();
    assert_eq!(log.text().matches("a module panicked in a browser").count(), taken + 2);
}

/// The name of a scheme of authentication is written in any case (RFC 9110).
pub async fn a_token_is_known_in_any_case(server: &TestServer) {
    let mut owner = crate::people::owner(server).await;
    let key = crate::people::token(server, &mut owner, mimique_storage::Role::Analyst).await;
    let settings = Settings { metrics_token: Some("open".into()), ..Settings::default() };
    let server = server.with_settings(settings);
    for scheme in ["Bearer", "bearer", "BEARER", "Bearer "] {
        for (path, key) in
            [("/researcher/studies/faces/export/csv", key.as_str()), ("/metrics", "open")]
        {
            let value = format!("{scheme} {key}");
            let answer = server.get_with(path, &[(header::AUTHORIZATION, &value)]).await;
            assert_eq!(answer.status, StatusCode::OK, "{scheme:?} {path}");
        }
    }
    for wrong in ["Basic", "Bearerx", ""] {
        let value = format!("{wrong} {key}");
        let path = "/researcher/studies/faces/export/csv";
        let answer = server.get_with(path, &[(header::AUTHORIZATION, &value)]).await;
        answer.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    }
}

/// What is printed at the start can be opened: links begin as people reach the server.
pub async fn links_begin_with_the_address_that_people_type(server: &TestServer) {
    let listening = "127.0.0.1:8080".parse().unwrap();
    assert_eq!(server.app.base_address(listening), "http://127.0.0.1:8080");
    let behind_tls = Settings { behind_tls: true, ..Settings::default() };
    let app = server.app.clone().with_settings(behind_tls);
    assert_eq!(app.base_address(listening), "https://127.0.0.1:8080");
    let public_url = Some("https://faces.example/".to_owned());
    let app = app.with_access(mimique_server::Access { public_url, ..Default::default() });
    assert_eq!(app.base_address(listening), "https://faces.example");
}

/// A request with two hosts is refused: which of them links and origins are compared with would be open (RFC 9112).
pub async fn two_hosts_are_refused(server: &TestServer) {
    let hosts = async |hosts: &[&str]| {
        let mut request = Request::get("/healthz");
        for host in hosts {
            request = request.header(header::HOST, *host);
        }
        server.send(request.body(Body::empty()).unwrap()).await
    };
    assert_eq!(hosts(&["faces.example"]).await.status, StatusCode::OK);
    for wrong in [&["faces.example", "evil.example"][..], &["faces.example", "faces.example"]] {
        hosts(wrong).await.refused(StatusCode::BAD_REQUEST, "bad-request");
    }
}

/// Even at the finest level, and when the database fails, no answer or identifier is logged.
pub async fn logs_hold_no_answers(server: &TestServer) {
    let (log, _guard) = logged();
    let started = server.start(1).await;
    let mut secret = event(0);
    secret.body = json!({"type": "answered", "value": "my-secret-answer"});
    server.stored(&started.session, std::slice::from_ref(&secret)).await;
    server.run_sql("ALTER TABLE events RENAME TO elsewhere").await;
    secret.sequence = 1;
    let failed = server.append(&started.session, &[secret]).await;
    assert_eq!(failed.status, StatusCode::INTERNAL_SERVER_ERROR);
    assert!(matches!(
        server.storage.events(1).await.unwrap_err(),
        StorageError::Database(_) | StorageError::Unavailable
    ));
    let text = log.text();
    assert!(text.contains("500 Internal Server Error"), "the failure itself is logged: {text}");
    for private in ["my-secret-answer", "person 1", &started.session, &started.withdrawal_code] {
        assert!(!text.contains(private), "{private} in {text}");
    }
}
