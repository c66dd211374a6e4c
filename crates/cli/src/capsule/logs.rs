//! The logs of a capsule: who has events, who withdrew, and what each person saw, frame by frame.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead as _, BufReader};
use std::path::Path;

use anyhow::{Context as _, anyhow};
use mimique_session::EventKind;
use mimique_session::flow::{KeptFrames, Plan, Plays, Seen};
use mimique_session::wire::SessionStarted;
use mimique_study::Study;
use serde::Deserialize;
use serde_json::Value;

use super::answers::Row;

/// A line of `mimique export --format events`.
#[derive(Deserialize)]
struct Line {
    participant_id: String,
    sequence: u64,
    at_ms: f64,
    config_hash: String,
    misfit: Option<String>,
    body: Value,
}

/// Events of a session.
#[derive(Default)]
pub struct Session {
    config_hash: String,
    events: Vec<(u64, f64, Option<EventKind>)>,
}

/// The events of all sessions.
#[derive(Default)]
pub struct Logs {
    /// By `participant_id`.
    pub people: BTreeMap<String, Session>,
    /// Who took everything back.
    pub withdrawn: BTreeSet<String>,
}

impl Logs {
    /// Reads an export of events.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let file = std::fs::File::open(path)
            .map_err(|error| anyhow!("cannot be read ({error}); check the path"))?;
        let mut logs = Self::default();
        for (number, line) in (1..).zip(BufReader::new(file).lines()) {
            let place = || format!("line {number}");
            let line = line.with_context(place)?;
            if line.trim().is_empty() {
                continue;
            }
            let line: Line = serde_json::from_str(&line)
                .map_err(|error| {
                    anyhow!(
                        "{error}; give the events, as `mimique export --format events` writes them"
                    )
                })
                .with_context(place)?;
            // What cannot be of its session is in no form of the answers.
            if line.misfit.is_some() {
                continue;
            }
            let kind = EventKind::from_body(&line.body);
            if kind == Some(EventKind::Withdrawn) {
                logs.withdrawn.insert(line.participant_id.clone());
            }
            let session = logs.people.entry(line.participant_id).or_default();
            session.config_hash = line.config_hash;
            session.events.push((line.sequence, line.at_ms, kind));
        }
        Ok(logs)
    }
}

impl Session {
    /// Whether it is of that version of the study.
    pub fn is_of(&self, config_hash: &str) -> bool {
        self.config_hash == config_hash
    }

    /// What the person saw: the plays of each step, by its identifier. `row` is a row of the person in the tidy export,
    /// which says how the session began.
    pub fn plays(&self, study: &Study, row: Row<'_>) -> anyhow::Result<BTreeMap<String, Plays>> {
        let number = |name: &str| {
            let cell = row.get(name);
            cell.parse::<u64>().map_err(|_| {
                anyhow!("column {name}: {cell:?} is no number; give the export as it was written")
            })
        };
        let condition = row.get(mimique_study::columns::ASSIGNED_CONDITION);
        let started = SessionStarted {
            session: String::new(),
            participant_id: row.get("participant_id").to_owned(),
            participant: number("participant")?,
            slot: number("slot")?,
            condition: (!condition.is_empty()).then(|| condition.to_owned()),
            seed: study.seed,
            stage: row.get("stage").to_owned(),
            config_hash: self.config_hash.clone(),
            withdrawal_code: String::new(),
        };
        let plan = Plan::new(study.projection(), started)?;
        let mut seen = Seen::new(&plan, KeptFrames::All);
        for (sequence, at_ms, kind) in &self.events {
            seen.add(*sequence, *at_ms, kind.clone());
        }
        let pages = seen.pages().into_iter().filter(|page| !page.plays.is_empty());
        Ok(pages.map(|page| (page.step.clone(), Plays::of(&plan, &page))).collect())
    }
}
