//! `backup`, `restore`, `erase` as an operator types them: results, exit codes, errors that name the
//! file, and nothing half written.

use std::path::{Path, PathBuf};

use mimique_server::withdrawal_hash;
use mimique_session::wire::Event;
use mimique_storage::{NewSession, Storage, StudyVersion};
use serde_json::{Value, json};

use crate::support::{ok, refused, text};

/// A database with two participants of three events each.
struct Kept {
    folder: tempfile::TempDir,
    database: String,
}

fn block_on<T>(future: impl Future<Output = T>) -> T {
    tokio::runtime::Runtime::new().expect("threads").block_on(future)
}

impl Kept {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let database = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
        block_on(async {
            let storage = Storage::open(&database).await.expect("a database");
            let version = StudyVersion {
                study_id: "faces".into(),
                config_hash: "c".repeat(64),
                file: "{}".into(),
                clips: "{}".into(),
                measures: "[]".into(),
            };
            storage.register_study(&version, 1).await.expect("the study");
            for person in ["a", "b"] {
                let session = NewSession {
                    token_hash: person.repeat(64),
                    withdrawal_hash: withdrawal_hash(&person.repeat(16)),
                    study_id: "faces".into(),
                    config_hash: "c".repeat(64),
                    seed: 1,
                    stage: "live".into(),
                    language: "en".into(),
                    client: "{}".into(),
                    recruitment: [("PROLIFIC_PID".to_owned(), format!("prolific-{person}"))].into(),
                    marks: Vec::new(),
                    conditions: Vec::new(),
                    places: None,
                    reservation_ms: 3_600_000,
                    now_ms: 1_700_000_000_000,
                };
                let started = storage.start(session).await.expect("a session");
                let events = (0..3)
                    .map(|sequence| Event {
                        sequence,
                        at_ms: 1.0,
                        body: json!({"type": "said", "text": format!("the answer of {person}")}),
                    })
                    .collect();
                let token = person.repeat(64);
                let appended = storage.append(&token, events, started.started_ms).await;
                assert_eq!(appended.expect("stored").acknowledged.stored, 3);
            }
            storage.close().await;
        });
        Self { folder, database }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn backup(&self) -> PathBuf {
        let folder = text(&self.path("backups"));
        let said = ok(&["--json", "backup", "--database", &self.database, "--folder", &folder]);
        let said: Value = serde_json::from_str(&said).expect("a line of JSON");
        PathBuf::from(said["file"].as_str().expect("the file"))
    }
}

/// Participant and events of each session.
fn stored(database: &str) -> Vec<(u64, usize)> {
    block_on(async {
        let storage = Storage::open_existing(database).await.expect("a database");
        let mut found = Vec::new();
        for session in storage.sessions("faces").await.expect("sessions") {
            let events = storage.events(session.key).await.expect("events");
            found.push((session.participant, events.len()));
        }
        storage.close().await;
        found
    })
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// What a backup holds, unpacked by the program that everybody has.
fn unpacked(backup: &Path) -> String {
    let output = std::process::Command::new("gzip").arg("-dc").arg(backup).output().expect("gzip");
    assert!(output.status.success());
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_backup_restores_what_was_stored() {
    let kept = Kept::new();
    let backup = kept.backup();
    let fresh = format!("sqlite:{}", kept.path("fresh.sqlite").display());
    let said = ok(&["restore", &text(&backup), "--database", &fresh, "--nothing-since"]);
    assert!(said.contains(" rows"), "{said}");
    assert_eq!(stored(&fresh), [(1, 3), (2, 3)]);
    assert_eq!(stored(&kept.database), [(1, 3), (2, 3)], "the first is as it was");
}

#[test]
fn what_is_erased_leaves_the_backups_and_does_not_come_back() {
    let kept = Kept::new();
    let first = kept.backup();
    assert!(unpacked(&first).contains("the answer of b"));
    // A copy from before, restored with the list of deletions.
    let copy = kept.path("copy.backup.gz");
    std::fs::copy(&first, &copy).expect("a copy");
    let erase = ["erase", "--database", &kept.database, "--study", "faces", "-k", "2"];
    let said = ok(&erase);
    assert!(said.starts_with("3 events deleted"), "{said}");
    assert_eq!(stored(&kept.database), [(1, 3), (2, 0)]);
    // Names of backups are times: the second is another one.
    std::thread::sleep(std::time::Duration::from_millis(5));
    kept.backup();
    let rewritten = unpacked(&first);
    assert!(rewritten.contains("the answer of a"));
    assert!(!rewritten.contains("the answer of b") && !rewritten.contains("prolific-b"));
    let fresh = format!("sqlite:{}", kept.path("fresh.sqlite").display());
    let list = text(&kept.path("backups").join("deletions.jsonl"));
    let said = ok(&["restore", &text(&copy), "--database", &fresh, "--deletions", &list]);
    assert!(said.contains("1 deletions were carried out again"), "{said}");
    assert_eq!(stored(&fresh), [(1, 3), (2, 0)]);
    let again = ["erase", "--database", &kept.database, "--study", "faces", "--identifiers"];
    let said = ok(&again);
    assert!(said.starts_with("1 identifiers and marks deleted"), "{said}");
}

#[test]
fn backup_refuses_and_writes_nothing() {
    let kept = Kept::new();
    let absent = kept.path("absent.sqlite");
    let database = format!("sqlite:{}", absent.display());
    let folder = kept.path("backups");
    let error = refused(&["backup", "--database", &database, "--folder", &text(&folder)]);
    assert!(error.contains(&text(&absent)), "{error}");
    assert!(!absent.exists(), "a database that was not there is not made");
    assert!(!folder.exists() || names(&folder).is_empty(), "{:?}", names(&folder));
    // A folder that cannot be one.
    let file = kept.path("file");
    std::fs::write(&file, "x").expect("a file");
    let error =
        refused(&["backup", "--database", &kept.database, "--folder", &text(&file.join("in"))]);
    assert!(error.contains(&text(&file)), "{error}");
    let error = refused(&[
        "backup",
        "--database",
        &kept.database,
        "--folder",
        &text(&folder),
        "--keep",
        "0",
    ]);
    assert!(error.contains("--keep: 0"), "{error}");
}

#[test]
fn restore_refuses_and_writes_nothing() {
    let kept = Kept::new();
    let backup = kept.backup();
    let fresh_file = kept.path("fresh.sqlite");
    let fresh = format!("sqlite:{}", fresh_file.display());
    let whole = std::fs::read(&backup).expect("the backup");
    let cut = kept.path("cut.backup.gz");
    std::fs::write(&cut, &whole[..whole.len() / 2]).expect("a file");
    let other = kept.path("other.backup.gz");
    std::fs::write(&other, "no backup").expect("a file");
    let absent = kept.path("absent.backup.gz");
    for file in [&cut, &other, &absent] {
        let error = refused(&["restore", &text(file), "--database", &fresh]);
        assert!(error.contains(&text(file)), "{error}");
        assert!(!fresh_file.exists(), "{error}");
    }
    // What holds something is not overwritten.
    let error = refused(&["restore", &text(&backup), "--database", &kept.database]);
    assert!(error.contains("not empty"), "{error}");
    assert!(error.contains("answers.sqlite"), "{error}");
    assert_eq!(stored(&kept.database), [(1, 3), (2, 3)]);
    // A list of deletions that cannot be read is not left out silently.
    let list = kept.path("broken.jsonl");
    std::fs::write(&list, "{\n").expect("a file");
    let error =
        refused(&["restore", &text(&backup), "--database", &fresh, "--deletions", &text(&list)]);
    assert!(error.contains(&text(&list)) && error.contains("line 1"), "{error}");
    assert!(!fresh_file.exists());
    let left: Vec<_> =
        names(kept.folder.path()).into_iter().filter(|name| name.contains(".part")).collect();
    assert_eq!(left, [""; 0]);
}

#[test]
fn erase_refuses_and_deletes_nothing() {
    let kept = Kept::new();
    let absent = kept.path("absent.sqlite");
    let database = format!("sqlite:{}", absent.display());
    let error = refused(&["erase", "--database", &database, "--study", "faces", "-k", "1"]);
    assert!(error.contains(&text(&absent)), "{error}");
    assert!(!absent.exists());
    let error = refused(&["erase", "--database", &kept.database, "--study", "faces", "-k", "9"]);
    assert!(error.contains("answers.sqlite") && error.contains("faces: 9"), "{error}");
    let error = refused(&["erase", "--database", &kept.database, "--study", "other", "-k", "1"]);
    assert!(error.contains("other: 1"), "{error}");
    assert_eq!(stored(&kept.database), [(1, 3), (2, 3)]);
}

#[test]
fn a_withdrawal_code_is_redeemed_by_the_code_alone() {
    let kept = Kept::new();
    let erase = |code: &str, more: &[&str]| {
        let mut words = vec!["erase", "--database", &kept.database, "--code", code];
        words.extend(more);
        words.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    for (code, more) in [("cccc-cccc-cccc-cccc", &[][..]), ("b", &[]), ("", &[])] {
        let said = erase(code, more);
        let error = refused(&said.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(error.contains("answers.sqlite") && error.contains("--code"), "{error}");
    }
    let elsewhere = erase("bbbb-bbbb-bbbb-bbbb", &["--study", "other"]);
    refused(&elsewhere.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(stored(&kept.database), [(1, 3), (2, 3)]);
    let done = erase("BBBB bbbb-bbbb-bbbb", &[]);
    let said = ok(&done.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.starts_with("3 events deleted"), "{said}");
    assert_eq!(stored(&kept.database), [(1, 3), (2, 0)]);
}
