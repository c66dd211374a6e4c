//! Disks that are full or refuse to be written, under SQLite.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use mimique_storage::Storage;
use mimique_test_support::skip;
use serde_json::{Value, json};

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::people::{Person, acknowledged, answer_while, compare, exchange, text_of};

/// A small disk of its own in memory; gone when dropped.
struct Disk(PathBuf);

impl Disk {
    /// `None` where this user may mount nothing, which is said.
    fn mount(test: &str, place: &Path, size: &str) -> Option<Self> {
        std::fs::create_dir(place).unwrap();
        let made = mount(&["-t", "tmpfs", "-o", &format!("size={size}"), "tmpfs"], place);
        if !made {
            eprintln!("SKIPPED {test}: no disk can be mounted; run the tests as root");
        }
        made.then(|| Self(place.to_owned()))
    }

    fn remount(&self, options: &str) {
        assert!(mount(&["-o", &format!("remount,{options}")], &self.0), "remount,{options}");
    }

    /// Fills the disk but for so many bytes.
    fn leave(&self, bytes: u64) {
        let mut file = std::fs::File::create(self.0.join("something else")).unwrap();
        while file.write_all(&[1; 65_536]).is_ok() {}
        let filled = file.metadata().unwrap().len();
        file.set_len(filled.saturating_sub(bytes)).unwrap();
    }

    fn database(&self) -> String {
        format!("sqlite:{}", self.0.join("answers.sqlite").display())
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("--lazy").arg(&self.0).status();
    }
}

fn mount(options: &[&str], place: &Path) -> bool {
    let command = Command::new("mount").args(options).arg(place).stderr(Stdio::null()).status();
    command.is_ok_and(|status| status.success())
}

fn start_session(port: u16) -> (u16, String) {
    let body = json!({"nonce": "c".repeat(32), "language": "en"});
    post(port, "/api/studies/faces/sessions", &body)
}

fn post(port: u16, path: &str, body: &Value) -> (u16, String) {
    exchange(port, text_of("POST", path, &body.to_string()).as_bytes()).expect("an answer")
}

#[test]
fn a_disk_without_room_stops_acknowledging_until_it_has_some() {
    let test = "a_disk_without_room_stops_acknowledging_until_it_has_some";
    let folder = tempfile::tempdir().unwrap();
    let Some(disk) = Disk::mount(test, &folder.path().join("disk"), "6m") else { return };
    let url = disk.database();
    let server = Server::start(&url);
    let (status, answer) = start_session(server.port);
    assert_eq!(status, 200, "{answer}");
    let mut people = Person::several(3);
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(200)));
    // Something else lies there: less is left than what is kept of one session.
    disk.leave(1_500_000);
    // Somebody sends much until there is no room.
    let session = serde_json::from_str::<Value>(&answer).unwrap();
    let path = format!("/api/sessions/{}/events", session["session"].as_str().unwrap());
    let text = "x".repeat(100_000);
    let large = |sequence: u64| json!({"events": [{"sequence": sequence, "at_ms": 1.0, "body": {"type": "t", "text": text}}]});
    let mut stored = 0;
    while let (200, _) = post(server.port, &path, &large(stored)) {
        stored += 1;
        assert!(stored < 400, "the disk is never full");
    }
    let (status, answer) = post(server.port, &path, &large(stored));
    assert_eq!(status, 503, "{answer}");
    assert!(answer.contains("nothing that was acknowledged is lost"), "{answer}");
    assert_eq!(exchange(server.port, text_of("GET", "/healthz", "").as_bytes()).unwrap().0, 200);
    // With room the same server goes on.
    disk.remount("size=64m");
    let (status, answer) = post(server.port, &path, &large(stored));
    assert_eq!(status, 200, "{answer}");
    let before = acknowledged(&people);
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(200)));
    assert!(acknowledged(&people) > before);
    server.kill();
    block_on(async {
        let storage = Storage::open(&url).await.unwrap();
        let sessions = storage.sessions("faces").await.unwrap();
        let number = session["participant"].as_u64().unwrap();
        let sender = sessions.iter().find(|each| each.participant == number).unwrap();
        assert_eq!(sender.event_count, stored + 1);
        assert_eq!(storage.events(sender.key).await.unwrap().len() as u64, stored + 1);
        storage.close().await;
    });
    // The sender of much is one session more than there are people.
    people.push(Person::new(99));
    block_on(compare(&url, &people));
}

#[test]
fn a_disk_that_refuses_to_be_written_stops_acknowledging_until_it_is() {
    let test = "a_disk_that_refuses_to_be_written_stops_acknowledging_until_it_is";
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    let server = Server::start_with(&url, 0, "trap '' XFSZ");
    let mut people = Person::several(3);
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(200)));
    let before = acknowledged(&people);
    assert!(before > 3, "{before}");
    // Every write of the running process fails from now on, as on a disk that the system has made
    // read-only after an error.
    let limit = |bytes: &str| {
        let pid = server.id().to_string();
        Command::new("prlimit").args(["--pid", &pid, &format!("--fsize={bytes}:")]).status()
    };
    if !limit("0").is_ok_and(|status| status.success()) {
        return skip(test, "prlimit not found; install util-linux");
    }
    for person in &mut people {
        assert!(person.answer(server.port).is_none(), "nothing is acknowledged");
    }
    let (status, answer) = start_session(server.port);
    assert_eq!(status, 503, "{answer}");
    assert!(answer.contains("nothing that was acknowledged is lost"), "{answer}");
    assert!(limit("unlimited").unwrap().success());
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(300)));
    assert!(acknowledged(&people) > before, "it goes on");
    drop(server);
    block_on(compare(&url, &people));
}

#[test]
fn a_server_on_a_read_only_disk_does_not_start_and_says_why() {
    let test = "a_server_on_a_read_only_disk_does_not_start_and_says_why";
    let folder = tempfile::tempdir().unwrap();
    // Room for all that two people send in the meantime: what stops the server is the read-only disk.
    let Some(disk) = Disk::mount(test, &folder.path().join("disk"), "64m") else { return };
    let url = disk.database();
    let server = Server::start(&url);
    let mut people = Person::several(2);
    answer_while(&mut people, &[server.port], || std::thread::sleep(Duration::from_millis(200)));
    server.stop();
    disk.remount("ro");
    let error = block_on(Storage::open(&url)).err().expect("it does not open").to_string();
    assert!(error.contains("cannot write"), "{error}");
    disk.remount("rw");
    block_on(compare(&url, &people));
}
