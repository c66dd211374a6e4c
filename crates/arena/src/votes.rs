//! Votes: out of the export of a laboratory, and as the table of pooled votes.

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::{Chosen, Refusal, Table, TableError};
use serde::{Deserialize, Serialize};

use crate::left_out::{LATE_SHARE, LeftOut, SHORTEST_RT_MS};
use crate::stimuli::ArenaStimuli;
use crate::study::{QUESTION, TAKE};
use crate::submission::sha256;

/// A vote: which of two clips of a segment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Vote {
    /// Where it was given.
    pub laboratory: String,
    /// Whose it is: a hash of the session, the same in every export of it.
    pub session: String,
    /// Place among all pages and trials of the session.
    pub place: u32,
    /// The segment.
    pub take: String,
    /// The method on the left.
    pub left: String,
    /// The method on the right.
    pub right: String,
    /// `left`, `right` or `same`.
    #[serde(with = "chosen_word")]
    pub chosen: Chosen,
    /// Provenance of the clip on the left.
    pub left_hash: String,
    /// Provenance of the clip on the right.
    pub right_hash: String,
    /// The day, YYYY-MM-DD, by the participant's clock.
    pub day: String,
    /// How long the answer took from when it could be given, milliseconds.
    pub rt_ms: Option<f64>,
    /// Of a pair that was chosen by the answers so far its batch.
    pub batch: Option<u32>,
}

mod chosen_word {
    use mimique_stats::Chosen;
    use serde::de::{Deserialize as _, Deserializer, Error};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(chosen: &Chosen, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(chosen.word())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Chosen, D::Error> {
        let word = String::deserialize(from)?;
        let known = Chosen::ALL.into_iter().find(|chosen| chosen.word() == word);
        known.ok_or_else(|| D::Error::custom(format!("{word:?}; there are left, same and right")))
    }
}

/// The votes of an export, and those that are not pooled.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportedVotes {
    /// The laboratory.
    pub laboratory: String,
    /// SHA-256 of the export.
    pub sha256: String,
    /// Votes on the arena's clips.
    pub votes: Vec<Vote>,
    /// Others, by their reason.
    pub left_out: BTreeMap<LeftOut, usize>,
    /// Hashes of what drew the clips.
    pub renderers: BTreeSet<String>,
    /// Hashes of the study files.
    pub configurations: BTreeSet<String>,
}

/// Why an export gives no votes.
#[derive(Debug, thiserror::Error)]
pub enum ExportProblem {
    /// It is no table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A column is not there.
    #[error("{0}; give the tidy export of an arena's study (`mimique export --format csv`)")]
    Column(#[from] Refusal),
    /// No row is a vote.
    #[error(
        "no row answers {QUESTION:?} about two methods; give the tidy export of an arena's study (`mimique export \
         --format csv`)"
    )]
    NoVotes,
}

/// A table of pooled votes that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{0}; write it anew by `mimique arena merge`")]
pub struct VoteFileError(#[from] csv::Error);

/// The columns of an export that votes are made of, by place.
struct Columns {
    participant: usize,
    configuration: usize,
    stage: usize,
    status: usize,
    response_id: usize,
    answer: usize,
    item_left: usize,
    item_right: usize,
    take: usize,
    provenance: usize,
    beside_provenance: usize,
    start: usize,
    place: usize,
    attention: usize,
    rest: BTreeMap<&'static str, usize>,
}

impl Columns {
    fn of(table: &Table) -> Result<Self, Refusal> {
        let at = |name: &str| table.position(name);
        let others = [
            "beside_side",
            "rt",
            "rt_open",
            "batch",
            "renderer",
            "frames",
            "frames_late",
            "excluded",
            "exclusion_reason",
        ];
        Ok(Self {
            participant: at("participant_id")?,
            configuration: at("config_hash")?,
            stage: at("stage")?,
            status: at("status")?,
            response_id: at("response_id")?,
            answer: at("answer")?,
            item_left: at("item_left")?,
            item_right: at("item_right")?,
            take: at(TAKE)?,
            provenance: at("provenance")?,
            beside_provenance: at("beside_provenance")?,
            start: at("start_time")?,
            place: at("trial_index")?,
            attention: at("attention_passed")?,
            rest: others.into_iter().filter_map(|name| Some((name, at(name).ok()?))).collect(),
        })
    }
}

/// A row of an export.
struct Row<'t> {
    table: &'t Table,
    columns: &'t Columns,
    row: usize,
}

impl Row<'_> {
    fn text(&self, column: usize) -> String {
        self.table.cell(self.row, column).unwrap_or_default().to_owned()
    }

    fn rest(&self, name: &str) -> Option<&str> {
        self.table.cell(self.row, *self.columns.rest.get(name)?)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.rest(name)?.parse().ok()
    }

    /// The vote, without its session.
    fn vote(&self, laboratory: &str) -> Option<Vote> {
        let columns = self.columns;
        if self.text(columns.response_id) != QUESTION {
            return None;
        }
        let answer = self.text(columns.answer);
        let chosen = Chosen::ALL.into_iter().find(|chosen| chosen.word() == answer)?;
        let [left, right] = [columns.item_left, columns.item_right].map(|at| self.text(at));
        if left.is_empty() || right.is_empty() {
            return None;
        }
        let mut hashes = [columns.provenance, columns.beside_provenance].map(|at| self.text(at));
        if self.rest("beside_side") == Some("left") {
            hashes.reverse();
        }
        let [left_hash, right_hash] = hashes;
        Some(Vote {
            laboratory: laboratory.to_owned(),
            session: String::new(),
            place: self.text(columns.place).parse().unwrap_or(0),
            take: self.text(columns.take),
            left,
            right,
            chosen,
            left_hash,
            right_hash,
            day: self.text(columns.start).chars().take(10).collect(),
            rt_ms: self.number("rt_open").or_else(|| self.number("rt")),
            batch: self.rest("batch").and_then(|batch| batch.parse().ok()),
        })
    }

    /// Why a vote of this row is not pooled.
    fn left_out(&self, vote: &Vote, stimuli: &ArenaStimuli) -> Option<LeftOut> {
        let columns = self.columns;
        let status = self.text(columns.status);
        if self.text(columns.stage) == "pilot" {
            return Some(LeftOut::Pilot);
        }
        if self.rest("excluded").is_some_and(|excluded| excluded == "true") {
            let why = self.rest("exclusion_reason").unwrap_or_default().to_owned();
            return Some(LeftOut::Excluded { why });
        }
        if status != "completed" {
            return Some(LeftOut::Unfinished { status });
        }
        if vote.left_hash.is_empty() || vote.right_hash.is_empty() {
            return Some(LeftOut::NoHash);
        }
        let sides = [(&vote.left, &vote.left_hash), (&vote.right, &vote.right_hash)];
        for (method, hash) in sides {
            if !stimuli.is(method, &vote.take, hash) {
                let expected = stimuli.clip(method, &vote.take);
                return Some(LeftOut::Stimulus {
                    method: method.clone(),
                    take: vote.take.clone(),
                    found: hash.clone(),
                    expected: expected.map(|clip| clip.provenance.clone()),
                });
            }
        }
        if vote.rt_ms.is_some_and(|ms| ms < SHORTEST_RT_MS) {
            return Some(LeftOut::TooFast);
        }
        let late = self.number("frames_late").zip(self.number("frames"));
        late.is_some_and(|(late, all)| all > 0.0 && late > LATE_SHARE * all)
            .then_some(LeftOut::LateFrames)
    }
}

/// Reads the votes of a laboratory's tidy export.
///
/// # Errors
/// [`ExportProblem`]: it is no export of an arena's study.
pub fn read_export(
    laboratory: &str,
    bytes: Vec<u8>,
    stimuli: &ArenaStimuli,
) -> Result<ExportedVotes, ExportProblem> {
    let sha256 = sha256(&bytes);
    let table = Table::parse(bytes)?;
    let columns = Columns::of(&table)?;
    let rows = || (0..table.rows()).map(|row| Row { table: &table, columns: &columns, row });
    let person = |row: &Row<'_>| [row.text(columns.configuration), row.text(columns.participant)];
    let failed: BTreeSet<[String; 2]> = rows()
        .filter(|row| row.text(columns.attention) == "false")
        .map(|row| person(&row))
        .collect();
    let mut read = ExportedVotes {
        laboratory: laboratory.to_owned(),
        sha256,
        votes: Vec::new(),
        left_out: BTreeMap::new(),
        renderers: BTreeSet::new(),
        configurations: BTreeSet::new(),
    };
    let mut sessions: BTreeMap<[String; 2], String> = BTreeMap::new();
    let mut any = false;
    for row in rows() {
        let Some(mut vote) = row.vote(laboratory) else { continue };
        any = true;
        let who = person(&row);
        // The first vote tells sessions of one configuration apart that were numbered alike in two places.
        vote.session =
            sessions.entry(who.clone()).or_insert_with(|| session(&who, &row, &vote)).clone();
        read.renderers.extend(row.rest("renderer").map(str::to_owned));
        read.configurations.insert(who[0].clone());
        let failed = failed.contains(&who).then_some(LeftOut::FailedCheck);
        match row.left_out(&vote, stimuli).or(failed) {
            Some(reason) => *read.left_out.entry(reason).or_default() += 1,
            None => read.votes.push(vote),
        }
    }
    if any { Ok(read) } else { Err(ExportProblem::NoVotes) }
}

/// What a session is known by: its configuration, its participant, and its first vote with its times.
fn session([configuration, participant]: &[String; 2], row: &Row<'_>, vote: &Vote) -> String {
    let start = row.text(row.columns.start);
    let rt = row.rest("rt").unwrap_or_default();
    let text = [
        configuration,
        participant,
        &start,
        rt,
        &vote.take,
        &vote.left,
        &vote.right,
        vote.chosen.word(),
    ]
    .join("\n");
    sha256(text.as_bytes())[..16].to_owned()
}

/// The table of pooled votes.
pub fn votes_csv(votes: &[Vote]) -> Result<Vec<u8>, VoteFileError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    votes.iter().try_for_each(|vote| writer.serialize(vote))?;
    writer.into_inner().map_err(|error| VoteFileError(error.into_error().into()))
}

/// Reads a table of pooled votes.
///
/// # Errors
/// [`VoteFileError`] with line and column.
pub fn read_votes(bytes: &[u8]) -> Result<Vec<Vote>, VoteFileError> {
    Ok(csv::Reader::from_reader(bytes).deserialize().collect::<Result<_, _>>()?)
}
