//! A database of every earlier schema is brought to today's with all that it holds.
//!
//! `tests/schemas/{sqlite,postgres}/000N.sql` is a database as version N left it. Whoever adds a
//! migration adds the database of the version before it.

use std::path::{Path, PathBuf};

use mimique_session::{Record, Standing};
use mimique_storage::{Role, Storage};
use sqlx::{AssertSqlSafe, Connection, Executor};

use crate::client::block_on;
use crate::postgres::Cluster;
use crate::study::sha256;

/// Version that this binary writes.
const LATEST: usize = 8;

fn dump(kind: &str, version: usize) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join(format!("tests/schemas/{kind}/{version:04}.sql"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_earlier_schema_of_sqlite_is_read() {
    let folder = tempfile::tempdir().unwrap();
    for version in 1..=LATEST {
        let path: PathBuf = folder.path().join(format!("{version}.sqlite"));
        let url = format!("sqlite:{}", path.display());
        block_on(async {
            let address = format!("{url}?mode=rwc");
            let mut connection = sqlx::SqliteConnection::connect(&address).await.unwrap();
            connection.execute(AssertSqlSafe(dump("sqlite", version))).await.unwrap();
            connection.close().await.unwrap();
            is_all_there(&url, version).await;
        });
    }
}

#[test]
fn every_earlier_schema_of_postgres_is_read() {
    let Some(cluster) = Cluster::start("every_earlier_schema_of_postgres_is_read") else { return };
    for version in 1..=LATEST {
        block_on(async {
            let url = cluster.fresh_database(&format!("schema_{version}")).await;
            let mut connection = sqlx::PgConnection::connect(&url).await.unwrap();
            connection.execute(AssertSqlSafe(dump("postgres", version))).await.unwrap();
            connection.close().await.unwrap();
            is_all_there(&url, version).await;
        });
    }
}

async fn is_all_there(url: &str, version: usize) {
    let storage = Storage::open(url).await.unwrap();
    assert!(storage.is_current().await.unwrap());
    let sessions = storage.sessions("faces").await.unwrap();
    let numbers: Vec<u64> = sessions.iter().map(|session| session.participant).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 5]);
    let slots: Vec<u64> = sessions.iter().map(|session| session.slot).collect();
    // Before version 3 the number was the place in the balance; then the third was replaced.
    assert_eq!(slots, if version < 3 { [1, 2, 3, 4, 5] } else { [1, 2, 3, 4, 3] });
    let conditions: Vec<Option<&str>> =
        sessions.iter().map(|session| session.condition.as_deref()).collect();
    let (plain, named) = (Some("plain"), Some("named"));
    assert_eq!(
        conditions,
        if version < 4 { [None; 5] } else { [plain, named, plain, named, plain] }
    );
    let standing: Vec<Standing> = sessions.iter().map(|session| session.standing).collect();
    let (ended, open) = (Standing::Completed, Standing::InProgress);
    assert_eq!(standing, [ended, open, Standing::Withdrawn, Standing::Declined, open]);
    let deleted: Vec<bool> = sessions.iter().map(|session| session.is_deleted()).collect();
    assert_eq!(deleted, [false, false, true, false, false]);
    for session in &sessions {
        let stored = storage.events(session.key).await.unwrap();
        let known: Vec<u64> = stored.iter().map(|event| event.sequence).collect();
        let first_gap = (0..).find(|sequence| !known.contains(sequence)).unwrap();
        assert_eq!(session.first_gap, first_gap, "{known:?}");
    }
    assert_eq!(sessions[0].receipt, Some(("receipt-1".into(), 3)));
    assert_eq!((sessions[0].seed, sessions[0].event_count), ((-7_i64).cast_unsigned(), 3));
    let events = storage.events(sessions[0].key).await.unwrap();
    let times: Vec<f64> = events.iter().map(|event| event.at_ms).collect();
    assert_eq!(times, [1_700_000_000_123.25, 1_700_000_000_123.1, 1.0 / 3.0]);
    assert_eq!(events[0].body["note"], "é \u{0} \"finished\"");
    assert_eq!(storage.conflict_counts("faces").await.unwrap(), [(sessions[0].key, 1)]);
    let identifiers = storage.recruitment("faces").await.unwrap();
    assert_eq!((identifiers[1].participant, identifiers[1].value.as_str()), (2, "def"));
    // From version 7 on there are roles in single studies, and sums beside the events.
    let roles = storage.study_roles().await.unwrap();
    let roles: Vec<_> = roles.iter().map(|it| (it.study_id.as_str(), it.role)).collect();
    assert_eq!(roles, if version < 7 { vec![] } else { vec![("faces", Role::Analyst)] });
    let kept = storage.kept_sums_of(&[sessions[0].key], 1).await.unwrap();
    assert_eq!(kept.len(), usize::from(version >= 7));
    // From version 8 on a version of a study keeps what was measured of its clips.
    let versions = storage.study_versions().await.unwrap();
    let measured = versions[0].measures.contains("jerk_m_per_s3");
    assert_eq!((measured, versions[0].measures.starts_with('[')), (version >= 8, true));
    assert_eq!(storage.server_key("tokens", || "new".into()).await.unwrap(), "k1");
    // Life goes on: nobody gets a number or a slot that is taken.
    storage.append(&sha256("token12"), vec![crate::client::event(2)], 0).await.unwrap();
    let mut next = crate::storage::session("faces", "9".repeat(64));
    next.config_hash = "c1".into();
    // From version 4 on each condition has slots of its own.
    if version >= 4 {
        next.conditions = vec!["plain".into()];
    }
    let next = storage.start(next).await.unwrap();
    let slot = [6, 6, 5, 4, 4, 4, 4, 4][version - 1];
    assert_eq!((next.participant, next.slot), (6, slot));
    assert_eq!(next.condition, (version >= 4).then(|| "plain".into()));
    storage.close().await;
}

/// The events of sessions of every end, and what version 4 called them.
const ENDS: [(&str, u8, &[&str]); 12] = [
    ("started", 0, &[]),
    ("started", 0, &[OPENED, AGREED]),
    ("started", 0, &[OPENED, DECLINED]),
    ("completed", 1, &[OPENED, AGREED, PAGE, FINISHED]),
    ("started", 0, &[OPENED, AGREED, PAGE, FINISHED]),
    ("completed", 0, &[OPENED, AGREED, SCREENED_OUT]),
    ("completed", 0, &[OPENED, AGREED, DEVICE, FINISHED]),
    ("completed", 0, &[OPENED, AGREED, TRAINING]),
    ("completed", 0, &[OPENED, AGREED, CHECKS]),
    ("started", 0, &[OPENED, AGREED, DECLINED, PAGE]),
    ("completed", 1, &[OPENED, AGREED, PAGE, FINISHED, WITHDRAWN]),
    ("completed", 0, &[OPENED, AGREED, PAGE]),
];
const OPENED: &str = r#"{"client":{},"language":"en","type":"opened"}"#;
const AGREED: &str = r#"{"language":"en","type":"consented","version":"1"}"#;
const DECLINED: &str = r#"{"type":"declined"}"#;
const PAGE: &str = r#"{"answers":{"type":"finished"},"step":"a","type":"page_finished"}"#;
const FINISHED: &str = r#"{"type":"finished"}"#;
const SCREENED_OUT: &str =
    r#"{"details":["age"],"reason":"screening","step":"a","type":"screened_out"}"#;
const DEVICE: &str =
    r#"{"details":["kind"],"reason":"device","step":"device","type":"screened_out"}"#;
const TRAINING: &str = r#"{"details":[],"reason":"training","step":"a","type":"screened_out"}"#;
const CHECKS: &str = r#"{"failed":2,"type":"checks_failed"}"#;
const WITHDRAWN: &str = r#"{"type":"withdrawn"}"#;

/// Those sessions as rows of version 4, from participant 101 on.
fn sessions_of_every_end() -> String {
    let mut sql = String::new();
    for (number, (status, finished, events)) in (101..).zip(ENDS) {
        sql += &format!(
            "INSERT INTO sessions (token_hash, study_id, participant, config_hash, seed, stage, \
             language, client, withdrawal_hash, status, started_ms, event_count, next_sequence, \
             slot, finished) VALUES ('t{number}', 'faces', {number}, 'c1', 1, 'live', 'en', '{{}}', \
             'w{number}', '{status}', 1, {count}, {count}, {number}, {finished});\n",
            count = events.len(),
        );
        for (sequence, body) in events.iter().enumerate() {
            sql += &format!(
                "INSERT INTO events (session_key, sequence, at_ms, received_ms, body) SELECT \
                 session_key, {sequence}, 1, 1, '{body}' FROM sessions WHERE participant = {number};\n"
            );
        }
    }
    sql
}

/// What the migration says of a session is what its events say.
async fn every_standing_is_that_of_the_events(url: &str) {
    let storage = Storage::open(url).await.unwrap();
    let mut found = Vec::new();
    for session in storage.sessions("faces").await.unwrap() {
        let events = storage.events(session.key).await.unwrap();
        if !session.is_deleted() {
            let standing = Record::of(None, &events).standing;
            assert_eq!(session.standing, standing, "participant {}", session.participant);
        }
        found.push(session.standing);
    }
    for standing in Standing::ALL.into_iter().filter(|it| *it != Standing::Abandoned) {
        assert!(found.contains(&standing), "{standing:?} in {found:?}");
    }
    storage.close().await;
}

#[test]
fn the_standing_of_old_sessions_is_that_of_their_events_on_sqlite() {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("4.sqlite").display());
    block_on(async {
        let address = format!("{url}?mode=rwc");
        let mut connection = sqlx::SqliteConnection::connect(&address).await.unwrap();
        connection.execute(AssertSqlSafe(dump("sqlite", 4))).await.unwrap();
        connection.execute(AssertSqlSafe(sessions_of_every_end())).await.unwrap();
        connection.close().await.unwrap();
        every_standing_is_that_of_the_events(&url).await;
    });
}

#[test]
fn the_standing_of_old_sessions_is_that_of_their_events_on_postgres() {
    let name = "the_standing_of_old_sessions_is_that_of_their_events_on_postgres";
    let Some(cluster) = Cluster::start(name) else { return };
    block_on(async {
        let url = cluster.fresh_database("standing").await;
        let mut connection = sqlx::PgConnection::connect(&url).await.unwrap();
        connection.execute(AssertSqlSafe(dump("postgres", 4))).await.unwrap();
        connection.execute(AssertSqlSafe(sessions_of_every_end())).await.unwrap();
        connection.close().await.unwrap();
        every_standing_is_that_of_the_events(&url).await;
    });
}
