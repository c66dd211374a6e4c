//! However much a study has, little of it is in memory: exports, reads of a large session, the sums that are
//! kept in the background.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use mimique_storage::Storage;
use serde_json::{Value, json};

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::owner::add_owner;
use crate::live::people::exchange;
use crate::study;

const TOKEN: &str = "mimique_memory";
/// Megabytes of events in the study.
const STORED_MB: u64 = 96;
/// Megabytes that the server may need for one thing, for a few threads that work at pieces of it: half of what
/// it reads.
const ROOM_MB: u64 = 48;

/// The largest resident size of a process so far, MB.
fn peak_mb(server: &Server) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", server.id())).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() / 1024
}

/// A whole answer, counted and not kept.
fn read_of(port: u16, path: &str) -> u64 {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let request = format!(
        "GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
         Authorization: Bearer {TOKEN}\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut piece = vec![0; 64 * 1024];
    let first = stream.read(&mut piece).unwrap();
    assert!(piece.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&piece[..first]));
    let mut bytes = first as u64;
    loop {
        match stream.read(&mut piece).unwrap() {
            0 => return bytes,
            more => bytes += more as u64,
        }
    }
}

/// An event of the small study's page, with so many bytes that nobody asks for.
fn event(sequence: u64, bytes: usize) -> Value {
    let body = match sequence {
        0 => json!({"type": "page_finished", "step": "how", "answers": {"mood": 3}}),
        _ => json!({"type": "focus_lost", "padding": "x".repeat(bytes)}),
    };
    json!({"sequence": sequence, "at_ms": 1.7e12 + sequence as f64, "body": body})
}

/// A study of many sessions, and one that is large; gives the large one's token.
async fn fill(url: &str) -> String {
    let storage = Storage::open(url).await.unwrap();
    add_owner(&storage, TOKEN).await;
    let hosted = study::hosted();
    let version = mimique_storage::StudyVersion {
        study_id: hosted.id().to_owned(),
        config_hash: hosted.config_hash().to_owned(),
        file: hosted.file().to_string(),
        clips: "{}".to_owned(),
        measures: "[]".to_owned(),
    };
    storage.register_study(&version, 1).await.unwrap();
    let token = "ab".repeat(16);
    let sessions = STORED_MB / 2;
    for number in 0..=sessions {
        let token = if number == 0 { token.clone() } else { format!("{number:032x}") };
        let token_hash = study::sha256(&token);
        let new = mimique_storage::NewSession {
            token_hash: token_hash.clone(),
            withdrawal_hash: study::sha256(&format!("code {number}")),
            study_id: version.study_id.clone(),
            config_hash: version.config_hash.clone(),
            seed: 1,
            stage: "live".to_owned(),
            language: "en".to_owned(),
            client: "{}".to_owned(),
            recruitment: Default::default(),
            marks: Vec::new(),
            conditions: Vec::new(),
            places: None,
            reservation_ms: 3_600_000,
            now_ms: 1_700_000_000_000,
        };
        storage.start(new).await.unwrap();
        // The first has half of all that is stored, the others a megabyte each.
        let events = if number == 0 { STORED_MB * 2 } else { 4 };
        for sequence in 0..events {
            let event = serde_json::from_value(event(sequence, 256 * 1024)).unwrap();
            storage.append(&token_hash, vec![event], 1_700_000_000_000).await.unwrap();
        }
    }
    storage.close().await;
    token
}

#[test]
fn exports_and_reads_take_little_memory_however_much_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    let session = block_on(fill(&url));
    for format in ["csv", "wide", "json", "events", "psych-ds"] {
        let server = Server::start(&url);
        exchange(server.port, b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
        let before = peak_mb(&server);
        let bytes = read_of(server.port, &format!("/researcher/studies/faces/export/{format}"));
        let took = peak_mb(&server) - before;
        eprintln!("{format}: {bytes} bytes, {took} MB");
        if format == "events" {
            assert!(bytes > STORED_MB * 900_000, "{bytes}");
        }
        assert!(took < ROOM_MB, "{format}: {took} MB for {STORED_MB} MB of events");
    }
    // Eight who read one large session at once, and the end of it.
    let server = Server::start(&url);
    exchange(server.port, b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    let before = peak_mb(&server);
    let path = format!("/api/sessions/{session}");
    std::thread::scope(|scope| {
        let readers = [(); 8].map(|()| scope.spawn(|| read_of(server.port, &path)));
        for reader in readers {
            assert!(reader.join().unwrap() > STORED_MB * 450_000);
        }
    });
    let took = peak_mb(&server) - before;
    eprintln!("eight readers: {took} MB");
    assert!(took < ROOM_MB, "{took} MB for eight readers of {} MB", STORED_MB / 2);
    let body = json!({"events": STORED_MB * 2}).to_string();
    let request = format!(
        "POST {path}/complete HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
         Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    );
    assert_eq!(exchange(server.port, request.as_bytes()).unwrap().0, 200);
    // The page of the participant shows what is in its events, and not all that is in them.
    assert!(read_of(server.port, "/researcher/studies/faces/participants/1") < 1_000_000);
    let took = peak_mb(&server) - before;
    eprintln!("and its end: {took} MB");
    assert!(took < ROOM_MB, "{took} MB");
}

/// Sessions that have come to rest are counted before anybody looks.
#[test]
fn sums_are_kept_as_sessions_come_to_rest() {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    block_on(fill(&url));
    let server = Server::start(&url);
    let sessions = STORED_MB / 2 + 1;
    let began = Instant::now();
    let kept = block_on(async {
        let storage = Storage::open(&url).await.unwrap();
        let keys: Vec<i64> =
            storage.sessions("faces").await.unwrap().iter().map(|session| session.key).collect();
        let mut kept = 0;
        while kept < sessions && began.elapsed() < Duration::from_secs(60) {
            tokio::time::sleep(Duration::from_millis(200)).await;
            kept =
                storage.kept_sums_of(&keys, mimique_server::SUMS_FORM).await.unwrap().len() as u64;
        }
        storage.close().await;
        kept
    });
    assert_eq!(kept, sessions);
    server.stop();
}
