//! Votes of several laboratories in one table: each session once, each laboratory by its name.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::left_out::LeftOut;
use crate::votes::{ExportedVotes, Vote};

/// Votes that are not pooled, for one reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOutVotes {
    /// Why.
    #[serde(flatten)]
    pub reason: LeftOut,
    /// How many.
    pub votes: usize,
}

/// What a laboratory brought.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Laboratory {
    /// Its name.
    pub name: String,
    /// SHA-256 of its exports.
    pub exports: Vec<String>,
    /// Sessions with votes that are pooled.
    pub sessions: usize,
    /// Votes that are pooled.
    pub votes: usize,
    /// Votes that are not.
    pub left_out: Vec<LeftOutVotes>,
    /// Hashes of what drew its clips.
    pub renderers: Vec<String>,
    /// Hashes of its study files.
    pub configurations: Vec<String>,
}

/// Votes of all laboratories.
#[derive(Debug, Clone, PartialEq)]
pub struct Pooled {
    /// By name.
    pub laboratories: Vec<Laboratory>,
    /// By laboratory, session and place.
    pub votes: Vec<Vote>,
}

/// Pools votes. What comes out does not depend on the order of the exports. A session that is in several exports counts
/// once: where it has most votes, among equals in the laboratory whose name comes first.
pub fn pool(exports: &[ExportedVotes]) -> Pooled {
    let mut sorted: Vec<&ExportedVotes> = exports.iter().collect();
    sorted.sort_by(|a, b| (&a.laboratory, &a.sha256).cmp(&(&b.laboratory, &b.sha256)));
    // Session -> votes, and the place of the export that counts.
    let mut best: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    let counts: Vec<BTreeMap<&str, usize>> = sorted.iter().map(|own| sessions(own)).collect();
    for (place, own) in counts.iter().enumerate() {
        for (session, votes) in own {
            let known = best.entry(session).or_insert((*votes, place));
            if *votes > known.0 {
                *known = (*votes, place);
            }
        }
    }
    let mut laboratories: BTreeMap<&str, Gathered> = BTreeMap::new();
    let mut votes = Vec::new();
    for (place, own) in sorted.iter().enumerate() {
        let gathered = laboratories.entry(&own.laboratory).or_default();
        gathered.exports.insert(&own.sha256);
        gathered.renderers.extend(own.renderers.iter().map(String::as_str));
        gathered.configurations.extend(own.configurations.iter().map(String::as_str));
        for (reason, count) in &own.left_out {
            *gathered.left_out.entry(reason.clone()).or_default() += count;
        }
        for vote in &own.votes {
            let counted = best[vote.session.as_str()].1;
            if counted == place {
                gathered.sessions.insert(&vote.session);
                gathered.votes += 1;
                votes.push(vote.clone());
            } else {
                let counted = sorted[counted].laboratory.clone();
                *gathered.left_out.entry(LeftOut::Duplicate { counted }).or_default() += 1;
            }
        }
    }
    votes.sort_by(|a, b| {
        (&a.laboratory, &a.session, a.place).cmp(&(&b.laboratory, &b.session, b.place))
    });
    let laboratories =
        laboratories.into_iter().map(|(name, own)| own.as_laboratory(name)).collect();
    Pooled { laboratories, votes }
}

/// How many votes each session of an export has.
fn sessions(own: &ExportedVotes) -> BTreeMap<&str, usize> {
    let mut counts = BTreeMap::new();
    own.votes.iter().for_each(|vote| *counts.entry(vote.session.as_str()).or_default() += 1);
    counts
}

#[derive(Default)]
struct Gathered<'a> {
    exports: BTreeSet<&'a str>,
    sessions: BTreeSet<&'a str>,
    votes: usize,
    left_out: BTreeMap<LeftOut, usize>,
    renderers: BTreeSet<&'a str>,
    configurations: BTreeSet<&'a str>,
}

impl Gathered<'_> {
    fn as_laboratory(&self, name: &str) -> Laboratory {
        let texts = |all: &BTreeSet<&str>| all.iter().map(|text| (*text).to_owned()).collect();
        let left_out = self.left_out.iter();
        Laboratory {
            name: name.to_owned(),
            exports: texts(&self.exports),
            sessions: self.sessions.len(),
            votes: self.votes,
            left_out: left_out
                .map(|(reason, votes)| LeftOutVotes { reason: reason.clone(), votes: *votes })
                .collect(),
            renderers: texts(&self.renderers),
            configurations: texts(&self.configurations),
        }
    }
}
