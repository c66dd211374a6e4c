//! Do laboratories differ? For each pair of methods the table of laboratories by answers has Pearson's chi-square; their
//! sum is held against its distribution over permutations of participants over laboratories, so that a person's votes
//! stay together and no distribution is assumed. Beside it stand the worths in each laboratory.

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::{
    BradleyTerryOptions, Chosen, Outcome, Stream, bradley_terry, t_quantile_upper,
};
use serde::Serialize;

use super::{JND, RankOptions, comparisons};
use crate::votes::Vote;

/// Whether laboratories differ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Heterogeneity {
    /// Sum of Pearson's chi-squares over pairs of methods.
    pub statistic: f64,
    /// Share of permutations whose sum is as large, the observed one among them.
    pub p: f64,
    /// Number of permutations.
    pub permutations: usize,
}

/// The worths in a laboratory.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LaboratoryWorths {
    /// Its name.
    pub laboratory: String,
    /// People.
    pub people: usize,
    /// Votes.
    pub votes: usize,
    /// Method -> worth in just noticeable differences and the 95 % interval of it alone; empty where the votes of this
    /// laboratory alone do not tell them.
    pub worths: BTreeMap<String, (f64, Option<[f64; 2]>)>,
}

/// Answers of a person: place of the pair, and which of its methods was chosen, or neither.
type Answers = Vec<(usize, usize)>;

/// The test; none where fewer than two laboratories have votes.
pub(super) fn heterogeneity(votes: &[&Vote], options: &RankOptions) -> Option<Heterogeneity> {
    let laboratories: BTreeSet<&str> = votes.iter().map(|vote| vote.laboratory.as_str()).collect();
    if laboratories.len() < 2 || options.permutations == 0 {
        return None;
    }
    let mut pairs: BTreeMap<[&str; 2], usize> = BTreeMap::new();
    let mut people: BTreeMap<[&str; 2], Answers> = BTreeMap::new();
    for vote in votes {
        let mut pair = [vote.left.as_str(), vote.right.as_str()];
        let chosen = match vote.chosen {
            Chosen::Left => pair[0],
            Chosen::Right => pair[1],
            Chosen::Same => "",
        };
        pair.sort_unstable();
        let answer = if chosen.is_empty() { 1 } else { 2 * usize::from(chosen == pair[1]) };
        let next = pairs.len();
        let place = *pairs.entry(pair).or_insert(next);
        people.entry([&vote.laboratory, &vote.session]).or_default().push((place, answer));
    }
    let at = |name: &str| laboratories.iter().position(|own| *own == name).unwrap_or(0);
    let mut own: Vec<usize> = people.keys().map(|[laboratory, _]| at(laboratory)).collect();
    let answers: Vec<&Answers> = people.values().collect();
    let sum = |own: &[usize]| chi_squares(own, &answers, laboratories.len(), pairs.len());
    let statistic = sum(&own);
    let mut stream = Stream::new(options.seed, 0);
    let mut as_large = 1;
    for _ in 0..options.permutations {
        let count = own.len();
        stream.draw_first(&mut own, count);
        // Sums in another order differ by rounding alone.
        as_large += usize::from(sum(&own) >= statistic * (1.0 - 1e-12));
    }
    let p = as_large as f64 / (options.permutations + 1) as f64;
    Some(Heterogeneity { statistic, p, permutations: options.permutations })
}

/// The sum over pairs of Pearson's chi-square of laboratories by answers.
fn chi_squares(own: &[usize], answers: &[&Answers], laboratories: usize, pairs: usize) -> f64 {
    let mut counts = vec![0.0; pairs * laboratories * 3];
    for (laboratory, answers) in own.iter().zip(answers) {
        for (pair, answer) in *answers {
            counts[(pair * laboratories + laboratory) * 3 + answer] += 1.0;
        }
    }
    counts.chunks_exact(3 * laboratories).map(chi_square).sum()
}

/// Pearson's chi-square of a table of rows of three; rows and columns without counts add nothing.
fn chi_square(table: &[f64]) -> f64 {
    let rows: Vec<f64> = table.chunks_exact(3).map(|row| row.iter().sum()).collect();
    let columns: [f64; 3] =
        std::array::from_fn(|column| table.iter().skip(column).step_by(3).sum());
    let all: f64 = rows.iter().sum();
    let mut sum = 0.0;
    for (row, cells) in rows.iter().zip(table.chunks_exact(3)) {
        for (column, count) in columns.iter().zip(cells) {
            let expected = row * column / all;
            if expected > 0.0 {
                sum += (count - expected).powi(2) / expected;
            }
        }
    }
    sum
}

/// The worths in each laboratory.
pub(super) fn worths(votes: &[&Vote]) -> Vec<LaboratoryWorths> {
    let mut by_name: BTreeMap<&str, Vec<&Vote>> = BTreeMap::new();
    votes.iter().for_each(|vote| by_name.entry(&vote.laboratory).or_default().push(vote));
    by_name.into_iter().map(|(name, votes)| worths_of(name, &votes)).collect()
}

fn worths_of(name: &str, votes: &[&Vote]) -> LaboratoryWorths {
    let data = comparisons(votes);
    let options =
        BradleyTerryOptions { rounds: 0, fit_rounds: 0, ..BradleyTerryOptions::default() };
    let people = data.participants.len();
    let mut worths = BTreeMap::new();
    if let Ok(found) = bradley_terry(&data, &options)
        && let Outcome::Ok(found) = found.estimates
    {
        let quantile = (people > 1).then(|| t_quantile_upper(0.025, (people - 1) as f64));
        for (place, item) in data.items.iter().enumerate() {
            let worth = found.worth[place];
            let half = found.se_cluster.as_ref().zip(quantile).map(|(se, t)| t * se[place]);
            let interval = half.map(|half| [worth - half, worth + half].map(|end| end / JND));
            worths.insert(item.clone(), (worth / JND, interval));
        }
    }
    LaboratoryWorths { laboratory: name.to_owned(), people, votes: votes.len(), worths }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chi_square_is_that_of_the_table() {
        // Two laboratories, 10 : 0 : 20 and 20 : 0 : 10: 4 cells of expectation 15, each 5 off.
        let found = chi_square(&[10.0, 0.0, 20.0, 20.0, 0.0, 10.0]);
        assert!((found - 4.0 * 25.0 / 15.0).abs() < 1e-12);
        assert_eq!(chi_square(&[3.0, 1.0, 2.0, 0.0, 0.0, 0.0]), 0.0);
    }
}
