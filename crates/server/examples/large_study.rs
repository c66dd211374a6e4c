//! Fills a database with a study of so many events, as its participants' pages would send them, and gives
//! it an owner with a token for scripts: what `cargo xtask bench --server` measures.
//!
//! ```text
//! cargo run --release -p mimique-server --example large_study -- DATABASE STUDY.json [events] [token]
//! ```
//!
//! `DATABASE` is `sqlite:FILE`, `postgres://…`, or `postgres` for a cluster of its own in the temporary folder.
//! It prints the database's address, then what it holds, and ends when its input does; the cluster ends with it.
//! Where PostgreSQL is not installed it prints nothing.
//!
//! The participants are simulated ones (`mimique_analysis::Simulation`): each event is one of the page's
//! own state machine, with the frames of its clips. The same study and number give the same answers.
#![allow(clippy::print_stdout, reason = "it prints what it has stored")]

#[path = "../tests/it/postgres.rs"]
#[allow(dead_code)]
mod postgres;

use std::collections::BTreeMap;
use std::sync::Arc;

use mimique_analysis::{Dropout, Parameters, SimulatedSession, Simulation};
use mimique_storage::{AccountLink, LinkPurpose, NewSession, Role, Storage, StudyVersion};
use mimique_study::Study;
use sha2::{Digest, Sha256};

/// Participants that are under way at the same time.
const AT_ONCE: u64 = 64;
/// Milliseconds since 1970 at which the first participant begins.
const BEGIN_MS: i64 = 1_790_000_000_000;

#[tokio::main]
async fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(database), Some(path)) = (arguments.next(), arguments.next()) else {
        return Err("give a database and a study file".into());
    };
    let wanted: u64 = arguments.next().map_or(Ok(1_000_000), |text| text.parse())?;
    let file = mimique_study::parse(&std::fs::read_to_string(&path)?)?;
    let study = Study::from_value(&file)?;
    let version = StudyVersion {
        study_id: study.id.clone(),
        config_hash: mimique_study::config_hash(&file),
        file: file.to_string(),
        clips: "{}".to_owned(),
        measures: "[]".to_owned(),
    };
    let cluster = match database.as_str() {
        "postgres" => match postgres::Cluster::start_with("large_study", "") {
            Some(cluster) => Some(cluster),
            None => return Ok(()),
        },
        _ => None,
    };
    let database = match &cluster {
        Some(cluster) => cluster.fresh_database("large_study").await,
        None => database,
    };
    println!("{database}");
    let storage = Storage::open(&database).await?;
    storage.register_study(&version, BEGIN_MS).await?;
    if let Some(token) = arguments.next() {
        add_owner(&storage, &token).await?;
    }
    let mut parameters = Parameters::for_study(&study);
    parameters.dropout = Dropout { declined: 0.02, per_trial: 0.002, withdrawn: 0.0 };
    let simulation = Simulation::new(&study, &version.config_hash, &parameters, 1)?;
    let (mut events, mut bytes, mut participant) = (0, 0, 0);
    while events < wanted {
        let batch: Vec<SimulatedSession> = (participant + 1..=participant + AT_ONCE)
            .map(|number| simulation.session(number))
            .collect::<Result<_, _>>()?;
        let mut tasks = Vec::new();
        for session in batch {
            let (storage, version) = (storage.clone(), version.clone());
            tasks.push(tokio::spawn(store(storage, version, Arc::new(session))));
        }
        for task in tasks {
            let (stored, size) = task.await?.map_err(|error| error.to_string())?;
            events += stored;
            bytes += size;
        }
        participant += AT_ONCE;
    }
    println!(
        "{}: {participant} participants, {events} events, {:.0} MB of events",
        study.id,
        bytes as f64 / 1e6
    );
    storage.close().await;
    // Whoever measures needs the cluster.
    std::io::copy(&mut std::io::stdin(), &mut std::io::sink())?;
    Ok(())
}

/// Stores a session in pieces, as a page sends it, and completes one that has come to an end.
async fn store(
    storage: Storage,
    version: StudyVersion,
    session: Arc<SimulatedSession>,
) -> Result<(u64, u64), Box<dyn std::error::Error + Send + Sync>> {
    let number = session.started.participant;
    let token_hash = hash(&format!("session {number}"));
    let began = BEGIN_MS + i64::try_from(number)? * 1000;
    let new = NewSession {
        token_hash: token_hash.clone(),
        withdrawal_hash: hash(&format!("code {number}")),
        study_id: version.study_id,
        config_hash: version.config_hash,
        seed: session.started.seed,
        stage: "live".to_owned(),
        language: "en".to_owned(),
        client: r#"{"browser":"Firefox","platform":"Linux","version":"140"}"#.to_owned(),
        recruitment: BTreeMap::new(),
        marks: Vec::new(),
        conditions: session.started.condition.iter().cloned().collect(),
        places: None,
        reservation_ms: 3_600_000,
        now_ms: began,
    };
    storage.start(new).await?;
    let mut bytes = 0;
    for part in session.events.chunks(20) {
        bytes += part.iter().map(|event| event.body.to_string().len() as u64).sum::<u64>();
        let now_ms = part.last().map_or(began, |event| event.at_ms as i64);
        storage.append(&token_hash, part.to_vec(), now_ms).await?;
    }
    let stored = session.events.len() as u64;
    if mimique_session::Record::of(None, &session.events).standing.has_receipt() {
        let now_ms = session.events.last().map_or(began, |event| event.at_ms as i64);
        storage.complete(&token_hash, stored, b"a key", now_ms).await?;
    }
    Ok((stored, bytes))
}

/// An owner whose scripts have this token.
async fn add_owner(storage: &Storage, token: &str) -> Result<(), Box<dyn std::error::Error>> {
    let link = AccountLink {
        purpose: LinkPurpose::FirstOwner,
        email: String::new(),
        role: Role::Owner,
        study_id: None,
        expires_ms: i64::MAX,
    };
    storage.add_link("link", &link, BEGIN_MS).await?;
    let owner = storage.use_link("link", "owner@example.org", "no password", BEGIN_MS).await?;
    let owner = owner.ok_or("there is an owner already: fill a new database")?;
    storage.add_token(&hash(token), owner.key, "measurement", Role::Owner, BEGIN_MS).await?;
    Ok(())
}

/// SHA-256, hexadecimal.
fn hash(text: &str) -> String {
    hex::encode(Sha256::digest(text))
}
