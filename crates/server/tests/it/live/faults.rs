//! Disks, databases and callers that fail.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use mimique_session::wire::{Acknowledged, SessionStarted};
use serde_json::{Value, json};

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::people::{
    Person, acknowledged, answer_while, compare, exchange, text_of, whole_answer,
};
use crate::postgres::Cluster;

fn sqlite(folder: &tempfile::TempDir) -> String {
    format!("sqlite:{}", folder.path().join("answers.sqlite").display())
}

fn post(port: u16, path: &str, body: &Value) -> Option<(u16, String)> {
    exchange(port, text_of("POST", path, &body.to_string()).as_bytes())
}

fn begin(port: u16) -> SessionStarted {
    let body = json!({"nonce": "a".repeat(32), "language": "en"});
    let (status, answer) = post(port, "/api/studies/faces/sessions", &body).unwrap();
    assert_eq!(status, 200, "{answer}");
    serde_json::from_str(&answer).unwrap()
}

#[test]
fn a_full_disk_stops_acknowledging_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let url = sqlite(&folder);
    // No file may outgrow 1 MiB (the unit is 512 bytes); the write fails instead of killing us.
    let server = Server::start_with(&url, 0, "trap '' XFSZ; ulimit -f 2048");
    let session = begin(server.port).session;
    let path = format!("/api/sessions/{session}/events");
    let text = "x".repeat(30_000);
    let event = |sequence: u64| json!({"events": [{"sequence": sequence, "at_ms": 1.0, "body": {"type": "t", "text": text}}]});
    let (mut stored, mut refused) = (0, 0);
    for sequence in 0..200 {
        let (status, answer) = post(server.port, &path, &event(sequence)).unwrap();
        match status {
            200 => {
                assert_eq!(refused, 0, "nothing can be stored any more");
                stored = serde_json::from_str::<Acknowledged>(&answer).unwrap().stored;
            }
            _ => {
                assert_eq!(status, 503, "{answer}");
                refused += 1;
                if refused == 5 {
                    break;
                }
            }
        }
    }
    assert!(stored > 5 && refused == 5, "{stored} stored, {refused} refused");
    // It still answers what needs no room.
    assert_eq!(exchange(server.port, text_of("GET", "/healthz", "").as_bytes()).unwrap().0, 200);
    server.kill();
    // With room again it goes on where it stood.
    let server = Server::start(&url);
    let (status, answer) = post(server.port, &path, &json!({"events": []})).unwrap();
    assert_eq!(status, 200, "{answer}");
    assert_eq!(serde_json::from_str::<Acknowledged>(&answer).unwrap().stored, stored);
    let (status, answer) = post(server.port, &path, &event(stored)).unwrap();
    assert_eq!(status, 200, "{answer}");
}

#[test]
fn a_read_only_database_stops_acknowledging_until_it_is_writable() {
    let test = "a_read_only_database_stops_acknowledging_until_it_is_writable";
    let Some(cluster) = Cluster::start(test) else { return };
    let url = block_on(cluster.fresh_database("readonly"));
    let server = Server::start(&url);
    let mut people = Person::several(3);
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(300)));
    block_on(cluster.set("default_transaction_read_only", "on"));
    std::thread::sleep(Duration::from_millis(300));
    let before = acknowledged(&people);
    for person in &mut people {
        assert!(person.answer(server.port).is_none(), "nothing is acknowledged");
    }
    block_on(cluster.set("default_transaction_read_only", "off"));
    std::thread::sleep(Duration::from_millis(300));
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(300)));
    assert!(acknowledged(&people) > before);
    block_on(compare(&url, &people));
}

#[test]
fn a_database_that_restarts_loses_nothing() {
    let Some(cluster) = Cluster::start("a_database_that_restarts_loses_nothing") else { return };
    let url = block_on(cluster.fresh_database("restarts"));
    let server = Server::start(&url);
    let mut people = Person::several(4);
    let mut before = 0;
    for mode in ["immediate", "fast"] {
        answer_while(&mut people, &[server.port], || {
            std::thread::sleep(Duration::from_millis(200));
            cluster.restart(mode);
            std::thread::sleep(Duration::from_millis(800));
        });
        assert!(acknowledged(&people) > before, "it goes on after a restart ({mode})");
        before = acknowledged(&people);
    }
    for person in &mut people {
        assert!((0..200).any(|_| person.answer(server.port).is_some()));
    }
    block_on(compare(&url, &people));
}

#[test]
fn a_connection_cut_in_the_middle_stores_nothing_or_all() {
    let folder = tempfile::tempdir().unwrap();
    let url = sqlite(&folder);
    let server = Server::start(&url);
    let session = begin(server.port).session;
    let path = format!("/api/sessions/{session}/events");
    for sequence in 0..30_u64 {
        let body = json!({"events": [
            {"sequence": 2 * sequence, "at_ms": 1.0, "body": {"type": "a"}},
            {"sequence": 2 * sequence + 1, "at_ms": 2.0, "body": {"type": "b"}},
        ]});
        let bytes = text_of("POST", &path, &body.to_string());
        // Cut somewhere, also right before the last byte; at the end without reading the answer.
        let cut = bytes.len() * (sequence as usize + 1) / 30;
        let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        stream.write_all(&bytes.as_bytes()[..cut]).unwrap();
        drop(stream);
        let (_, stored) = post(server.port, &path, &json!({"events": []})).unwrap();
        let stored = serde_json::from_str::<Acknowledged>(&stored).unwrap();
        assert!(stored.gaps.is_empty() && stored.stored.is_multiple_of(2), "{stored:?}");
        let (status, answer) = exchange(server.port, bytes.as_bytes()).unwrap();
        assert_eq!(status, 200, "{answer}");
        let answer = serde_json::from_str::<Acknowledged>(&answer).unwrap();
        assert_eq!(answer.stored, 2 * sequence + 2);
    }
}

#[test]
fn slow_and_malformed_callers_are_shown_out() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&sqlite(&folder));
    // Forty callers who never end their request's head, a letter at a time.
    let began = Instant::now();
    let mut slow: Vec<TcpStream> =
        (0..40).map(|_| TcpStream::connect(("127.0.0.1", server.port)).unwrap()).collect();
    for stream in &mut slow {
        stream.write_all(b"GET / HTTP/1.1\r\nX-Slow: ").unwrap();
    }
    let session = begin(server.port);
    assert_eq!(session.participant, 1, "others are served meanwhile");
    for stream in &mut slow {
        let _ = stream.write_all(b"a");
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let mut rest = Vec::new();
        // Closed, with or without a word.
        let _ = stream.read_to_end(&mut rest);
    }
    assert!(began.elapsed() < Duration::from_secs(15), "{:?}", began.elapsed());

    let long = "y".repeat(100_000);
    let many: String = (0..200).map(|n| format!("X-{n}: 1\r\n")).collect();
    for (name, bytes, expected) in [
        ("a long line", format!("GET /{long} HTTP/1.1\r\nHost: x\r\n\r\n"), 400..500),
        ("a long header", format!("GET / HTTP/1.1\r\nHost: x\r\nX: {long}\r\n\r\n"), 400..500),
        ("many headers", format!("GET / HTTP/1.1\r\nHost: x\r\n{many}\r\n"), 400..500),
        ("no HTTP", "\u{1}\u{2}\u{3}\r\n\r\n".to_owned(), 400..500),
        (
            "a wrong length",
            "POST /api/studies/faces/sessions HTTP/1.1\r\nHost: x\r\nContent-Length: -5\r\n\r\n"
                .to_owned(),
            400..500,
        ),
        (
            "two lengths",
            "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\nabcdef"
                .to_owned(),
            400..500,
        ),
    ] {
        if let Some((status, _)) = exchange(server.port, bytes.as_bytes()) {
            assert!(expected.contains(&status), "{name}: {status}");
        }
    }
    let large = json!({"events": [], "x": "z".repeat(3_000_000)});
    let path = format!("/api/sessions/{}/events", session.session);
    let answer = post(server.port, &path, &large);
    assert!(answer.is_none_or(|(status, _)| status == 413));
    assert_eq!(begin(server.port).participant, 1, "it still serves");
}

#[test]
fn a_server_told_to_stop_ends_what_it_has_begun() {
    let folder = tempfile::tempdir().unwrap();
    let url = sqlite(&folder);
    let server = Server::start(&url);
    let port = server.port;
    let session = begin(port).session;
    let body = json!({"events": [{"sequence": 0, "at_ms": 1.0, "body": {"type": "a"}}]});
    let path = format!("/api/sessions/{session}/events");
    let bytes = text_of("POST", &path, &body.to_string());
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    stream.write_all(&bytes.as_bytes()[..bytes.len() - 4]).unwrap();
    std::thread::sleep(Duration::from_millis(200));
    server.ask_to_stop();
    std::thread::sleep(Duration::from_millis(200));
    stream.write_all(&bytes.as_bytes()[bytes.len() - 4..]).unwrap();
    let (status, answer) = whole_answer(&mut stream).expect("the request in progress is answered");
    assert_eq!(status, 200, "{answer}");
    assert!(server.wait(), "it ends by itself, all well");
    // People notice nothing but a pause.
    let mut server = Server::start_with(&url, port, "");
    let mut people: Vec<Person> = (100..104).map(Person::new).collect();
    answer_while(&mut people, &[port], || {
        for _ in 0..3 {
            std::thread::sleep(Duration::from_millis(150));
            server.ask_to_stop();
            let next = || Server::start_with(&url, port, "");
            let stopped = std::mem::replace(&mut server, {
                // The port is free when the old one has stopped listening.
                std::thread::sleep(Duration::from_millis(400));
                next()
            });
            assert!(stopped.wait());
        }
        std::thread::sleep(Duration::from_millis(200));
    });
    assert!(people.iter().all(|person| person.acknowledged > 0));
    drop(server);
    people.push(Person::new(104));
    block_on(compare(&url, &people));
}

#[test]
fn two_servers_share_one_database() {
    let Some(cluster) = Cluster::start("two_servers_share_one_database") else { return };
    let url = block_on(cluster.fresh_database("shared"));
    // Both find an empty database: one of them makes its tables.
    let (first, second) = std::thread::scope(|scope| {
        let other = scope.spawn(|| Server::start(&url));
        (Server::start(&url), other.join().unwrap())
    });
    let ports = [first.port, second.port];
    // One page whose request goes to both at once has one session.
    let body = json!({"nonce": "b".repeat(32), "language": "en"});
    let body = &body;
    let twice: Vec<SessionStarted> = std::thread::scope(|scope| {
        let both =
            ports.map(|port| scope.spawn(move || post(port, "/api/studies/faces/sessions", body)));
        both.map(|one| serde_json::from_str(&one.join().unwrap().unwrap().1).unwrap()).into()
    });
    assert_eq!(twice[0], twice[1]);
    let mut people: Vec<Person> = (10..16).map(Person::new).collect();
    answer_while(&mut people, &ports, || {
        std::thread::sleep(Duration::from_millis(500));
        first.kill();
        std::thread::sleep(Duration::from_millis(500));
    });
    assert!(people.iter().any(|person| person.unanswered > 0), "somebody was at the first");
    assert!(people.iter().all(|person| person.acknowledged > 0));
    people.push(Person::new(16));
    block_on(compare(&url, &people));
}

#[test]
fn postgres_is_reached_over_tls_and_its_certificate_checked() {
    let test = "postgres_is_reached_over_tls_and_its_certificate_checked";
    let Some(cluster) = Cluster::start(test) else { return };
    let certificate = cluster.use_tls();
    let url = block_on(cluster.fresh_database("encrypted"));
    let trusting = format!("{url}?sslmode=verify-full&sslrootcert={}", certificate.display());
    let server = Server::start(&trusting);
    assert_eq!(begin(server.port).participant, 1);
    // Another authority's word does not count.
    block_on(async {
        let error = mimique_storage::Storage::open(&format!("{url}?sslmode=verify-full")).await;
        assert!(error.is_err(), "a certificate that nobody vouches for");
        let storage = mimique_storage::Storage::open(&trusting).await.unwrap();
        assert_eq!(storage.sessions("faces").await.unwrap().len(), 1);
        storage.close().await;
    });
}

/// Who asks for much and takes nothing of it does not hold a connection for ever.
#[test]
fn a_caller_who_does_not_read_is_shown_out() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&sqlite(&folder));
    let session = begin(server.port).session;
    let large = "x".repeat(900_000);
    for sequence in 0..5 {
        let event =
            json!({"sequence": sequence, "at_ms": 1.0, "body": {"type": "x", "log": large}});
        let body = json!({"events": [event]}).to_string();
        let request = text_of("POST", &format!("/api/sessions/{session}/events"), &body);
        assert_eq!(exchange(server.port, request.as_bytes()).unwrap().0, 200);
    }
    let ask = text_of("GET", &format!("/api/sessions/{session}"), "");
    let whole = exchange(server.port, ask.as_bytes()).unwrap().1.len();
    assert!(whole > 4_500_000, "{whole}: who reads gets it all");
    // Twenty times one after the other: more than the system holds for a reader.
    let mut idle = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
    idle.write_all(ask.replace("Connection: close\r\n", "").repeat(20).as_bytes()).unwrap();
    std::thread::sleep(Duration::from_secs(5));
    // What the system held back for the reader is there; the rest was never sent.
    idle.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let mut rest = Vec::new();
    let _ = idle.read_to_end(&mut rest);
    assert!(rest.len() < 15 * whole, "{} of {}", rest.len(), 20 * whole);
}

/// A server whose connections are all taken still says that it lives.
#[test]
fn health_is_told_when_all_connections_are_taken() {
    let folder = tempfile::tempdir().unwrap();
    let before = format!("export {}=8", crate::live::child::CONNECTIONS);
    let server = Server::start_with(&sqlite(&folder), 0, &before);
    let taken: Vec<TcpStream> = (0..8)
        .map(|_| {
            let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
            stream.write_all(b"GET / HTTP/1.1\r\nX-Slow: ").unwrap();
            stream
        })
        .collect();
    // They are shown out after a while; before that nobody else is served.
    let status = |path: &str| exchange(server.port, text_of("GET", path, "").as_bytes()).unwrap().0;
    assert_eq!(status("/healthz"), 200);
    assert_eq!(status("/s/faces/"), 503);
    assert_eq!(status("/readyz"), 200);
    drop(taken);
}
