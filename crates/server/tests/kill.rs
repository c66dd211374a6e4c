//! The server is killed at random moments while people answer: what was acknowledged is stored,
//! once, as it was sent.
//!
//! A few kills each run; `MIMIQUE_KILLS=1000` is the long run.

#[path = "http/postgres.rs"]
mod postgres;
#[path = "http/study.rs"]
#[allow(dead_code)]
mod study;

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use mimique_server::{App, Storage};
use mimique_study::wire::{Acknowledged, Event, SessionStarted};
use serde_json::{Value, json};

/// Set in the process that is the server: the database's address.
const CHILD: &str = "MIMIQUE_KILL_TEST_DATABASE";
const PEOPLE: u64 = 4;

#[test]
fn nothing_acknowledged_is_lost_on_sqlite() {
    if let Ok(url) = std::env::var(CHILD) {
        return serve(&url);
    }
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    kill_again_and_again("nothing_acknowledged_is_lost_on_sqlite", &url);
}

#[test]
fn nothing_acknowledged_is_lost_on_postgres() {
    if let Ok(url) = std::env::var(CHILD) {
        return serve(&url);
    }
    let name = "nothing_acknowledged_is_lost_on_postgres";
    let Some(cluster) = postgres::Cluster::start(name) else { return };
    let url = block_on(cluster.fresh_database("kills"));
    kill_again_and_again(name, &url);
}

/// The server's process: prints its port and serves until it is killed.
fn serve(url: &str) {
    block_on(async {
        let folder = tempfile::tempdir().unwrap();
        let storage = Storage::open(url).await.unwrap();
        let assets = study::assets(folder.path());
        let packs = study::packs(folder.path());
        let app = App::new(vec![study::hosted()], packs, assets, storage).await.unwrap();
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
        eprintln!("port {}", listener.local_addr().unwrap().port());
        mimique_server::serve(app, listener, std::future::pending()).await.unwrap();
    });
}

fn kill_again_and_again(test: &str, url: &str) {
    let kills: u64 = std::env::var("MIMIQUE_KILLS").map_or(12, |text| text.parse().unwrap());
    let mut people: Vec<Person> = (0..PEOPLE).map(Person::new).collect();
    for kill in 0..kills {
        let (mut server, port) = start(test, url);
        // 5 to 120 ms, spread by a linear congruential generator (Knuth's constants).
        let random = (kill + 1).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
        let lifetime = Duration::from_millis(5 + (random >> 33) % 116);
        std::thread::scope(|scope| {
            for person in &mut people {
                scope.spawn(move || while person.answer(port).is_some() {});
            }
            std::thread::sleep(lifetime);
            server.0.kill().unwrap();
        });
        drop(server);
    }
    let acknowledged: u64 = people.iter().map(|person| person.acknowledged).sum();
    eprintln!("{kills} kills, {acknowledged} events acknowledged");
    assert!(acknowledged > kills, "the server did something between the kills");
    block_on(compare(url, &people));
}

/// Acknowledged against stored.
async fn compare(url: &str, people: &[Person]) {
    let storage = Storage::open(url).await.unwrap();
    let sessions = storage.sessions("faces").await.unwrap();
    let numbers: BTreeSet<u64> = sessions.iter().map(|session| session.participant).collect();
    assert_eq!(numbers.len(), sessions.len(), "a number was given twice");
    // A repeated start finds its session: there are never more sessions than people.
    assert!(sessions.len() <= people.len(), "a session was doubled");
    for person in people {
        let Some(started) = &person.started else { continue };
        let session = sessions.iter().find(|s| s.participant == started.participant).unwrap();
        let events = storage.events(session.key).await.unwrap();
        assert!(events.len() as u64 >= person.acknowledged, "an acknowledged event is lost");
        // At most the one that was on its way is stored beyond what was acknowledged.
        assert!(events.len() as u64 <= person.acknowledged + 1);
        assert_eq!(session.event_count, events.len() as u64);
        for (sequence, event) in events.iter().enumerate() {
            assert_eq!(*event, person.event(sequence as u64));
        }
    }
    storage.close().await;
}

/// The server's process; gone when dropped, also where the test fails.
struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts this test's own program again as the server.
fn start(test: &str, url: &str) -> (Server, u16) {
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env(CHILD, url)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut server = Server(child);
    let stderr = BufReader::new(server.0.stderr.take().unwrap());
    let mut said = String::new();
    for line in stderr.lines() {
        let line = line.unwrap();
        if let Some(port) = line.strip_prefix("port ") {
            return (server, port.parse().unwrap());
        }
        said.push_str(&line);
    }
    panic!("the server did not start: {said}");
}

/// Somebody who answers, and sends again what was not acknowledged.
struct Person {
    number: u64,
    started: Option<SessionStarted>,
    acknowledged: u64,
}

impl Person {
    fn new(number: u64) -> Self {
        Self { number, started: None, acknowledged: 0 }
    }

    fn event(&self, sequence: u64) -> Event {
        Event {
            sequence,
            at_ms: 1_700_000_000_000.5 + sequence as f64,
            body: json!({"type": "answered", "person": self.number, "value": sequence}),
        }
    }

    /// Sends one request; `None` when the server has gone.
    fn answer(&mut self, port: u16) -> Option<()> {
        let Some(started) = &self.started else {
            let body = json!({"nonce": format!("{:032x}", self.number), "language": "en"});
            self.started = Some(request(port, "/api/studies/faces/sessions", &body)?);
            return Some(());
        };
        let body = json!({"events": [self.event(self.acknowledged)]});
        let path = format!("/api/sessions/{}/events", started.session);
        let answer: Acknowledged = request(port, &path, &body)?;
        assert!(answer.gaps.is_empty());
        assert_eq!(answer.stored, self.acknowledged + 1);
        self.acknowledged = answer.stored;
        Some(())
    }
}

/// One request on one connection; `None` when it was cut before the answer was whole.
fn request<T: serde::de::DeserializeOwned>(port: u16, path: &str, body: &Value) -> Option<T> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).ok()?;
    let body = body.to_string();
    write!(
        stream,
        "POST {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
         Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len(),
    )
    .ok()?;
    let mut answer = String::new();
    stream.read_to_string(&mut answer).ok()?;
    let (head, body) = answer.split_once("\r\n\r\n")?;
    // A cut answer is no acknowledgement, even if its beginning reads well.
    let length = head.lines().find_map(|line| line.strip_prefix("content-length: "))?;
    if length.parse::<usize>().ok()? != body.len() {
        return None;
    }
    assert!(head.starts_with("HTTP/1.1 200 "), "{answer}");
    Some(serde_json::from_str(body).unwrap())
}

fn block_on<T>(future: impl Future<Output = T>) -> T {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .unwrap()
        .block_on(future)
}
