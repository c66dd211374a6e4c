//! Backups: whole at one instant, restored on either database, without what was deleted.

use std::path::{Path, PathBuf};

use mimique_storage::{
    BackupError, Deletion, RestoreOptions, Storage, read_deletions, scrub_backup, write_deletions,
};

use crate::client::{TestServer, event, events};

/// Everything there is, from the outside.
async fn contents(storage: &Storage) -> String {
    let mut text = String::new();
    for version in storage.study_versions().await.unwrap() {
        text.push_str(&format!("{version:?}\n"));
    }
    for session in storage.sessions("faces").await.unwrap() {
        let events = storage.events(session.key).await.unwrap();
        text.push_str(&format!("{session:?} {events:?}\n"));
    }
    let conflicts = storage.conflict_counts("faces").await.unwrap();
    text.push_str(&format!("{conflicts:?} {:?}", storage.recruitment("faces").await.unwrap()));
    text
}

fn whole(skip_numbers: bool) -> RestoreOptions<'static> {
    RestoreOptions { skip_numbers, deletions: &[] }
}

fn fresh(folder: &Path, name: &str) -> (String, PathBuf) {
    let path = folder.join(name);
    (format!("sqlite:{}", path.display()), path)
}

pub async fn a_backup_restores_everything(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.backup.gz");
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..20)).await;
    server.receipt(&started.session, 20).await;
    let other = mimique_session::wire::Event { at_ms: 0.1, ..event(3) };
    server.append(&started.session, &[other]).await;
    let second = server.start(2).await;
    server.stored(&second.session, &[event(7), event(0)]).await;
    let expected = contents(&server.storage).await;
    // People go on answering while the backup is made.
    let (facts, _) = tokio::join!(server.storage.backup(&file, 17), async {
        for sequence in 20..60 {
            server.stored(&started.session, &[event(sequence)]).await;
        }
    });
    let facts = facts.unwrap();
    assert_eq!(facts.made_ms, 17);

    let (url, path) = fresh(folder.path(), "restored.sqlite");
    let restored = Storage::restore(&url, &file, whole(false)).await.unwrap();
    assert_eq!(restored.rows, facts.rows);
    let storage = Storage::open(&url).await.unwrap();
    let found = contents(&storage).await;
    // The backup's instant lies somewhere among the appends: a prefix of them is there.
    let session = &storage.sessions("faces").await.unwrap()[0];
    let stored = storage.events(session.key).await.unwrap();
    assert_eq!(stored, events(0..stored.len() as u64));
    if session.event_count == 20 {
        assert_eq!(found, expected);
    }
    storage.close().await;
    // The keys came along: the session goes on, and the next participant is the third.
    let twin = TestServer::open(&url).await;
    assert_eq!(twin.start(1).await, started);
    assert_eq!(twin.start(3).await.participant, 3);
    twin.storage.close().await;
    assert!(path.exists());

    // A second backup, of the restored database, says the same as the first restored elsewhere.
    let (again, _) = fresh(folder.path(), "again.sqlite");
    let storage = Storage::open(&url).await.unwrap();
    let file = folder.path().join("two.backup.gz");
    storage.backup(&file, 18).await.unwrap();
    Storage::restore(&again, &file, whole(true)).await.unwrap();
    let twin = TestServer::open(&again).await;
    assert_eq!(contents(&twin.storage).await, contents(&storage).await);
    assert_eq!(twin.start(4).await.participant, 1001, "numbers given since are not given again");
    twin.storage.close().await;
    storage.close().await;
}

pub async fn a_backup_fills_only_what_is_empty(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.backup.gz");
    server.start(1).await;
    server.storage.backup(&file, 0).await.unwrap();
    let error = Storage::restore(server.url(), &file, whole(true)).await.unwrap_err();
    assert!(matches!(error, BackupError::NotEmpty { .. }), "{error}");
    assert_eq!(server.storage.sessions("faces").await.unwrap().len(), 1);
    // A file that was cut, or is none, leaves nothing behind.
    let bytes = std::fs::read(&file).unwrap();
    for (name, bytes) in [
        ("cut", &bytes[..bytes.len() / 2]),
        ("short", &bytes[..bytes.len() - 9]),
        ("text", b"{}\n"),
    ] {
        let damaged = folder.path().join(name);
        std::fs::write(&damaged, bytes).unwrap();
        let (url, path) = fresh(folder.path(), "not.sqlite");
        let error = Storage::restore(&url, &damaged, whole(true)).await.unwrap_err();
        assert!(matches!(error, BackupError::Damaged { .. }), "{name}: {error}");
        assert!(!path.exists(), "{name}");
    }
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 4, "three damaged files and the good one");
}

pub async fn deletions_reach_the_backups(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.backup.gz");
    for nonce in 1..5 {
        let started = server.start(nonce).await;
        server.stored(&started.session, &events(0..4)).await;
    }
    server.storage.backup(&file, 0).await.unwrap();
    let first = server.start(1).await;
    server.withdrawn(&first.session, &first.withdrawal_code).await;
    assert_eq!(server.storage.erase_participant("faces", 2, "somebody", 5).await.unwrap(), 4);
    assert_eq!(server.storage.erase_identifiers("faces", Some(3), "somebody", 6).await.unwrap(), 1);
    let deletions = server.storage.deletions().await.unwrap();
    let list = folder.path().join("deletions.jsonl");
    write_deletions(&list, &deletions).unwrap();
    assert_eq!(read_deletions(&list).unwrap(), deletions);
    let kinds: Vec<&str> = deletions.iter().map(|d| d.what.as_str()).collect();
    assert_eq!(kinds, ["withdrawn", "identifiers", "withdrawn"]);

    // Restored as it is, the old backup obeys the list.
    let check = async |name: &str, file: &Path, deletions: &[Deletion], again: u64| {
        let (url, _) = fresh(folder.path(), name);
        let options = RestoreOptions { skip_numbers: false, deletions };
        let restored = Storage::restore(&url, file, options).await.unwrap();
        assert_eq!(restored.deleted_again, again, "{name}");
        let storage = Storage::open(&url).await.unwrap();
        let mut counts = Vec::new();
        for session in storage.sessions("faces").await.unwrap() {
            counts.push(storage.events(session.key).await.unwrap().len());
        }
        assert_eq!(counts, [0, 0, 4, 4], "{name}");
        let known: Vec<u64> =
            storage.recruitment("faces").await.unwrap().iter().map(|r| r.participant).collect();
        assert_eq!(known, [4], "{name}");
        storage.close().await;
    };
    check("obeyed.sqlite", &file, &deletions, 3).await;
    // Rewritten, it does not hold them any more, whoever reads it.
    let holds = |text: &str| {
        let mut all = String::new();
        let bytes = std::fs::File::open(&file).unwrap();
        std::io::Read::read_to_string(&mut flate2::read::MultiGzDecoder::new(bytes), &mut all)
            .unwrap();
        all.contains(text)
    };
    assert!(holds("person 1") && holds("person 3"));
    assert_eq!(scrub_backup(&file, &deletions).unwrap(), 3);
    assert!(!holds("person 1") && !holds("person 2") && !holds("person 3") && holds("person 4"));
    assert_eq!(scrub_backup(&file, &deletions).unwrap(), 0, "once is enough");
    check("scrubbed.sqlite", &file, &[], 0).await;
}
