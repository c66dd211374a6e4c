//! Load: so many people who answer at once, each on a connection of their own, and a server in a
//! process of its own on the same machine.
//!
//! ```text
//! cargo run --release -p mimique-server --example load -- [sqlite | sqlite:FILE | postgres | postgres://…]
//!     [people] [appends/s, 0: all that go] [seconds]
//! cargo run --release -p mimique-server --example load -- static [connections] 0 [seconds]
//! ```
//!
//! A session is a start, 60 events in a request each, and its completion; then the next one begins. The
//! first ones are shorter, each by another number of events, so that people stand at all places of the study.
//! `postgres` is a cluster of its own in the temporary folder, with its settings as they come: every
//! commit is on the disk before it is answered, as SQLite's are.
#![allow(clippy::print_stdout, reason = "it prints what it has measured")]

#[path = "../tests/it/postgres.rs"]
#[allow(dead_code)]
mod postgres;
#[path = "../tests/it/study.rs"]
#[allow(dead_code)]
mod study;

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use mimique_server::App;
use mimique_storage::Storage;
use serde_json::{Value, json};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

/// Set in the server's process: the database's address.
const DATABASE: &str = "MIMIQUE_LOAD_DATABASE";
const EVENTS: u64 = 60;

#[tokio::main]
async fn main() -> Result<(), Box<dyn std::error::Error>> {
    if let Ok(url) = std::env::var(DATABASE) {
        return serve(&url).await;
    }
    let folder = tempfile::tempdir()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: u64| -> Result<u64, std::num::ParseIntError> {
        arguments.get(at).map_or(Ok(default), |text| text.parse())
    };
    let kind = arguments.first().map_or("sqlite", String::as_str);
    let fresh = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    let cluster = (kind == "postgres")
        .then(|| postgres::Cluster::start_with("load", "").ok_or("PostgreSQL is not installed"))
        .transpose()?;
    let url = match (kind, &cluster) {
        (_, Some(cluster)) => cluster.fresh_database("load").await,
        ("sqlite" | "static", _) => fresh,
        (url, _) => url.to_owned(),
    };
    let (people, rate, seconds) = (number(1, 64)?, number(2, 0)?, number(3, 10)?);

    let server = Server::start(&url)?;
    let run = Arc::new(Run {
        port: server.port,
        end: AtomicBool::new(false),
        counted: AtomicBool::new(false),
        answered: AtomicU64::new(0),
        failed: AtomicU64::new(0),
        sessions: AtomicU64::new(0),
        people,
        // Everybody sends one event in this time.
        pause: (rate > 0).then(|| Duration::from_secs_f64(people as f64 / rate as f64)),
        bodies: (0..EVENTS)
            .map(|sequence| json!({"events": [event(sequence)]}).to_string())
            .collect(),
    });
    let tasks: Vec<_> = (0..people)
        .map(|number| {
            let run = Arc::clone(&run);
            let still = kind == "static";
            tokio::spawn(async move {
                if still {
                    fetch_again_and_again(&run).await
                } else {
                    take_part(&run, number).await
                }
            })
        })
        .collect();
    // Starts and first connections are not counted.
    let warming = Duration::from_secs(2).max(run.pause.unwrap_or_default());
    tokio::time::sleep(warming).await;
    run.counted.store(true, Ordering::Relaxed);
    let began = Instant::now();
    tokio::time::sleep(Duration::from_secs(seconds)).await;
    let took = began.elapsed().as_secs_f64();
    run.end.store(true, Ordering::Relaxed);
    let answered = run.answered.load(Ordering::Relaxed);
    let memory = server.peak_memory_mb();
    let mut times: Vec<f32> = Vec::new();
    for task in tasks {
        // Who is in a long pause is not waited for.
        if let Ok(Ok(part)) = tokio::time::timeout(Duration::from_secs(30), task).await {
            times.extend(part);
        }
    }
    times.sort_by(f32::total_cmp);
    let at = |share: f64| {
        times.get(((times.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f32::NAN)
    };
    println!(
        "{kind}: {people} connections, {:.0} a second over {took:.1} s; ms: median {:.2}, p99 {:.2}, \
         longest {:.1}; {} sessions completed; {} failed; server's peak memory {memory:.0} MB",
        answered as f64 / took,
        at(0.5),
        at(0.99),
        at(1.0),
        run.sessions.load(Ordering::Relaxed),
        run.failed.load(Ordering::Relaxed),
    );
    Ok(())
}

/// The server's process.
async fn serve(url: &str) -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let storage = Storage::open(url).await?;
    let (assets, packs) = (study::assets(folder.path()), study::packs(folder.path()));
    let app = App::new(vec![study::hosted()], packs, assets, storage).await?;
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await?;
    eprintln!("port {}", listener.local_addr()?.port());
    mimique_server::serve(app, listener, std::future::pending()).await?;
    Ok(())
}

struct Server {
    child: Child,
    port: u16,
}

impl Server {
    fn start(url: &str) -> Result<Self, Box<dyn std::error::Error>> {
        let child = Command::new(std::env::current_exe()?)
            .env(DATABASE, url)
            .stderr(Stdio::piped())
            .spawn()?;
        let mut server = Self { child, port: 0 };
        let mut said = BufReader::new(server.child.stderr.take().ok_or("no stderr")?);
        let mut line = String::new();
        said.read_line(&mut line)?;
        server.port = line.trim().strip_prefix("port ").ok_or_else(|| line.clone())?.parse()?;
        std::thread::spawn(move || std::io::copy(&mut said, &mut std::io::stderr()));
        Ok(server)
    }

    /// The largest resident size so far (`VmHWM`), MB; not a number where there is no /proc.
    fn peak_memory_mb(&self) -> f64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id()));
        let kb = status.ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
            line.split_whitespace().nth(1)?.parse::<f64>().ok()
        });
        kb.map_or(f64::NAN, |kb| kb / 1024.0)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Run {
    port: u16,
    end: AtomicBool,
    counted: AtomicBool,
    answered: AtomicU64,
    failed: AtomicU64,
    sessions: AtomicU64,
    people: u64,
    pause: Option<Duration>,
    /// The 60 requests of a session: only their making would be the generator's own work.
    bodies: Vec<String>,
}

impl Run {
    fn count(&self, began: Instant, times: &mut Vec<f32>) {
        if self.counted.load(Ordering::Relaxed) && !self.end.load(Ordering::Relaxed) {
            self.answered.fetch_add(1, Ordering::Relaxed);
            times.push(began.elapsed().as_secs_f32() * 1000.0);
        }
    }
}

/// Session after session; the times of the appends that were counted, ms.
async fn take_part(run: &Run, number: u64) -> Vec<f32> {
    let mut times = Vec::new();
    let mut connection = Connection { port: run.port, stream: None, read: Vec::new() };
    for round in 0_u64.. {
        if run.end.load(Ordering::Relaxed) {
            break;
        }
        // People do not arrive all in one moment.
        if let Some(pause) = run.pause.filter(|_| round == 0) {
            tokio::time::sleep(pause.mul_f64((number % 1000) as f64 / 1000.0)).await;
        }
        let body = json!({"nonce": format!("{number:016x}{round:016x}"), "language": "en",
            "client": {"browser": "Firefox", "version": "140", "platform": "Linux"}});
        let body = body.to_string();
        let Some(started) = connection.post("/api/studies/faces/sessions", &body).await else {
            run.failed.fetch_add(1, Ordering::Relaxed);
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        let session = started["session"].as_str().unwrap_or_default().to_owned();
        let path = format!("/api/sessions/{session}/events");
        // Nor do they all end in one moment: the first sessions are of all lengths.
        let events = if round == 0 { EVENTS - number * EVENTS / run.people } else { EVENTS };
        for (sequence, body) in (0..events).zip(&run.bodies) {
            if run.end.load(Ordering::Relaxed) {
                return times;
            }
            let began = Instant::now();
            match connection.post(&path, body).await {
                Some(answer) if answer["stored"] == sequence + 1 => run.count(began, &mut times),
                _ => drop(run.failed.fetch_add(1, Ordering::Relaxed)),
            }
            if let Some(pause) = run.pause {
                tokio::time::sleep(pause.saturating_sub(began.elapsed())).await;
            }
        }
        let path = format!("/api/sessions/{session}/complete");
        if connection.post(&path, &json!({"events": events}).to_string()).await.is_some() {
            run.sessions.fetch_add(1, Ordering::Relaxed);
        }
    }
    times
}

/// An event as a trial makes it: the answers, and the log of a clip's 120 frames.
fn event(sequence: u64) -> Value {
    if sequence == EVENTS - 1 {
        return json!({"sequence": sequence, "at_ms": 1.7e12, "body": {"type": "finished"}});
    }
    let frames: Vec<[f64; 2]> = (0..120).map(|n| [f64::from(n) * 16.67, 0.0]).collect();
    json!({"sequence": sequence, "at_ms": 1.7e12 + sequence as f64, "body": {
        "type": "trial_finished", "step": format!("faces/joy{sequence}"),
        "answers": {"emotion": "joy", "rating": sequence % 7 + 1}, "log": {"frames": frames}}})
}

async fn fetch_again_and_again(run: &Run) -> Vec<f32> {
    let mut times = Vec::new();
    let mut connection = Connection { port: run.port, stream: None, read: Vec::new() };
    let page = connection.exchange("GET", "/s/faces/", "").await.unwrap_or_default();
    let page = String::from_utf8_lossy(&page).into_owned();
    let at = page.find("/assets/").unwrap_or_default();
    let style = format!("{}/style/style.css", &page[at..at + "/assets/".len() + 16]);
    let pack = format!("/packs/{}", study::sha256(&study::pack()));
    for path in [style, pack].iter().cycle() {
        if run.end.load(Ordering::Relaxed) {
            break;
        }
        let began = Instant::now();
        match connection.exchange("GET", path, "").await {
            Some(_) => run.count(began, &mut times),
            None => drop(run.failed.fetch_add(1, Ordering::Relaxed)),
        }
    }
    times
}

/// A connection that is kept, and made anew when it was closed.
struct Connection {
    port: u16,
    stream: Option<TcpStream>,
    read: Vec<u8>,
}

impl Connection {
    async fn post(&mut self, path: &str, body: &str) -> Option<Value> {
        serde_json::from_slice(&self.exchange("POST", path, body).await?).ok()
    }

    /// The body of a 200; a kept connection that turns out to be closed is tried once more.
    async fn exchange(&mut self, method: &str, path: &str, body: &str) -> Option<Vec<u8>> {
        let request = format!(
            "{method} {path} HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: br\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        );
        for _ in 0..2 {
            if self.stream.is_none() {
                let stream = TcpStream::connect(("127.0.0.1", self.port)).await.ok()?;
                stream.set_nodelay(true).ok()?;
                self.stream = Some(stream);
            }
            if let Some(answer) = self.once(request.as_bytes()).await {
                return answer.0.then_some(answer.1);
            }
            self.stream = None;
        }
        None
    }

    async fn once(&mut self, request: &[u8]) -> Option<(bool, Vec<u8>)> {
        let stream = self.stream.as_mut()?;
        stream.write_all(request).await.ok()?;
        self.read.clear();
        loop {
            if let Some(end) = self.read.windows(4).position(|four| four == b"\r\n\r\n") {
                let head = std::str::from_utf8(&self.read[..end]).ok()?;
                let length: usize = head
                    .lines()
                    .filter_map(|line| line.split_once(':'))
                    .find(|(name, _)| name.eq_ignore_ascii_case("content-length"))
                    .and_then(|(_, length)| length.trim().parse().ok())?;
                if self.read.len() >= end + 4 + length {
                    let ok = head.starts_with("HTTP/1.1 200");
                    return Some((ok, self.read[end + 4..end + 4 + length].to_vec()));
                }
            }
            if stream.read_buf(&mut self.read).await.ok()? == 0 {
                return None;
            }
        }
    }
}
