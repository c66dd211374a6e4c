//! People who answer, and send again what was not acknowledged, here or at another server.

use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use mimique_session::wire::{Acknowledged, Event, SessionStarted};
use mimique_storage::Storage;
use serde_json::{Value, json};

/// Somebody who answers.
pub struct Person {
    number: u64,
    pub started: Option<SessionStarted>,
    pub acknowledged: u64,
    /// Requests that had no answer, or were told to come later.
    pub unanswered: u64,
}

impl Person {
    pub fn new(number: u64) -> Self {
        Self { number, started: None, acknowledged: 0, unanswered: 0 }
    }

    /// So many people.
    pub fn several(count: u64) -> Vec<Self> {
        (0..count).map(Self::new).collect()
    }

    fn event(&self, sequence: u64) -> Event {
        Event {
            sequence,
            at_ms: 1_700_000_000_000.5 + sequence as f64,
            body: json!({"type": "answered", "person": self.number, "value": sequence}),
        }
    }

    /// Sends one request; `None` when there was no answer or the server cannot do it now.
    pub fn answer(&mut self, port: u16) -> Option<()> {
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

    /// Goes on until told to end, at the next server when one fails.
    pub fn keep_answering(&mut self, ports: &[u16], end: &AtomicBool) {
        let mut at = self.number as usize;
        while !end.load(Ordering::Relaxed) {
            // A session has so much and no more: nobody answers a thousand times a second.
            let pause = if self.answer(ports[at % ports.len()]).is_none() {
                self.unanswered += 1;
                at += 1;
                5
            } else {
                2
            };
            std::thread::sleep(Duration::from_millis(pause));
        }
    }
}

/// All of them answer at these servers while `meanwhile` happens.
pub fn answer_while(people: &mut [Person], ports: &[u16], meanwhile: impl FnOnce()) {
    let end = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for person in people {
            let end = &end;
            scope.spawn(move || person.keep_answering(ports, end));
        }
        meanwhile();
        end.store(true, Ordering::Relaxed);
    });
}

/// Acknowledged against stored; how many events are stored.
pub async fn compare(url: &str, people: &[Person]) -> u64 {
    let storage = Storage::open(url).await.unwrap();
    let sessions = storage.sessions("faces").await.unwrap();
    let numbers: BTreeSet<u64> = sessions.iter().map(|session| session.participant).collect();
    assert_eq!(numbers.len(), sessions.len(), "a number was given twice");
    let slots: BTreeSet<u64> = sessions.iter().map(|session| session.slot).collect();
    assert_eq!(slots.len(), sessions.len(), "a slot was given twice");
    // A repeated start finds its session: there are never more sessions than people.
    assert!(sessions.len() <= people.len(), "a session was doubled");
    let mut stored = 0;
    for person in people {
        let Some(started) = &person.started else { continue };
        let session = sessions.iter().find(|s| s.participant == started.participant).unwrap();
        let events = storage.events(session.key).await.unwrap();
        assert!(events.len() as u64 >= person.acknowledged, "an acknowledged event is lost");
        // At most the one that was on its way is stored beyond what was acknowledged.
        assert!(events.len() as u64 <= person.acknowledged + 1);
        assert_eq!(session.event_count, events.len() as u64);
        stored += events.len() as u64;
        for (sequence, event) in events.iter().enumerate() {
            assert_eq!(*event, person.event(sequence as u64));
        }
    }
    storage.close().await;
    stored
}

/// How many events were acknowledged to all of them.
pub fn acknowledged(people: &[Person]) -> u64 {
    people.iter().map(|person| person.acknowledged).sum()
}

/// A request as it goes over the wire.
pub fn text_of(method: &str, path: &str, body: &str) -> String {
    format!(
        "{method} {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
         Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len(),
    )
}

/// Sends bytes on a connection of their own; status and body, or `None` when the answer was cut.
pub fn exchange(port: u16, bytes: &[u8]) -> Option<(u16, String)> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    // A server that has refused may read no more.
    let _ = stream.write_all(bytes);
    whole_answer(&mut stream)
}

/// Reads an answer to the end of its connection.
pub fn whole_answer(stream: &mut TcpStream) -> Option<(u16, String)> {
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8(answer).ok()?;
    let (head, body) = answer.split_once("\r\n\r\n")?;
    // A cut answer is no acknowledgement, even if its beginning reads well.
    let length = head
        .lines()
        .filter_map(|line| line.split_once(':'))
        .find(|(name, _)| name.eq_ignore_ascii_case("content-length"));
    if let Some((_, length)) = length
        && length.trim().parse::<usize>().ok()? != body.len()
    {
        return None;
    }
    Some((head.get(9..12)?.parse().ok()?, body.to_owned()))
}

fn request<T: serde::de::DeserializeOwned>(port: u16, path: &str, body: &Value) -> Option<T> {
    let (status, answer) = exchange(port, text_of("POST", path, &body.to_string()).as_bytes())?;
    if status >= 500 {
        return None;
    }
    assert_eq!(status, 200, "{answer}");
    Some(serde_json::from_str(&answer).unwrap())
}
