//! The ranking as rows of a table.

use serde::Serialize;

use super::document::submitted;
use super::{Ranking, Standing};
use crate::submission::Submission;

/// A method's row.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RankingRow {
    /// Its name.
    pub method: String,
    /// Its band, from 1; none while it waits for votes, or nothing is ranked.
    pub band: Option<usize>,
    /// The best and the worst rank that the votes leave it.
    pub ranks: Option<[usize; 2]>,
    /// Its worth in just noticeable differences.
    pub worth: Option<f64>,
    /// Its interval at 95 %.
    pub interval: Option<[f64; 2]>,
    /// Votes on pairs with it.
    pub votes: usize,
    /// Those that chose it.
    pub chosen: usize,
    /// People who gave them.
    pub people: usize,
    /// The day it was submitted.
    pub submitted: String,
}

/// A row for each method: those with a place by band and, within it, by name, then the others.
pub fn ranking_rows(ranking: &Ranking, submissions: &[&Submission]) -> Vec<RankingRow> {
    let row = |standing: &Standing| RankingRow {
        method: standing.method.clone(),
        band: None,
        ranks: None,
        worth: None,
        interval: None,
        votes: standing.votes,
        chosen: standing.chosen,
        people: standing.people,
        submitted: submitted(submissions, &standing.method),
    };
    let mut rows: Vec<RankingRow> = (ranking.placed.iter())
        .map(|own| RankingRow {
            band: Some(own.band),
            ranks: Some(own.ranks),
            worth: Some(own.worth),
            interval: own.interval,
            ..row(&own.standing)
        })
        .collect();
    rows.sort_by(|a, b| (a.band, &a.method).cmp(&(b.band, &b.method)));
    rows.extend(ranking.waiting.iter().map(row));
    rows
}

/// Ranks as `2` or `2 to 4`.
pub(super) fn span([first, last]: [usize; 2]) -> String {
    if first == last { first.to_string() } else { format!("{first} to {last}") }
}
