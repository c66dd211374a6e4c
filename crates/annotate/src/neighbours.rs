//! The labels of the nearest training rows (thesis 4.5: 1NN and 3NN).

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::as_many;
use crate::tiles::Tiles;
use crate::{AnnotateError, Examples, Rows};

/// Training rows to compare with, and how many of the nearest vote. The rows are people's frames: a
/// model that holds them holds their data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Neighbours {
    rows: Rows,
    labels: Vec<usize>,
    count: usize,
    k: usize,
}

/// What the neighbours of a row say.
#[derive(Debug, Clone, PartialEq)]
pub struct Vote {
    /// The label with most votes; of several the one whose nearest member comes first.
    pub label: usize,
    /// Its votes over k.
    pub share: f64,
    /// The neighbours, nearest first; of equally near ones the earlier row first.
    pub neighbours: Vec<usize>,
}

impl Neighbours {
    /// Keep examples; the `k` nearest vote (all, when there are fewer).
    ///
    /// # Errors
    /// [`AnnotateError::Setting`] for k = 0, [`AnnotateError::Limit`] above 200,000 rows.
    pub fn new(examples: &Examples, k: usize) -> Result<Self, AnnotateError> {
        if k == 0 {
            return Err(AnnotateError::Setting { setting: "k", value: 0.0, range: "above 0" });
        }
        crate::error::at_most("training rows", examples.rows().len(), 200_000)?;
        let k = k.min(examples.rows().len());
        let (rows, labels) = (examples.rows().clone(), examples.labels().to_vec());
        Ok(Self { rows, labels, count: examples.count(), k })
    }

    /// The vote on a row.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the row has another width.
    pub fn vote(&self, row: &[f64]) -> Result<Vote, AnnotateError> {
        as_many("columns", row.len(), self.rows.width())?;
        Ok(self.vote_of(&Tiles::of(&self.rows).distances(row)))
    }

    /// The votes on all rows of a table, which takes less time than one after the other.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when they have another width.
    pub fn votes(&self, rows: &Rows) -> Result<Vec<Vote>, AnnotateError> {
        as_many("columns", rows.width(), self.rows.width())?;
        let tiles = Tiles::of(&self.rows);
        let blocks = rows.values().par_chunks(Tiles::most() * rows.width());
        let votes = blocks.flat_map_iter(|asked| {
            let distances = tiles.distances(asked);
            let each = distances.chunks_exact(tiles.len());
            each.map(|distances| self.vote_of(distances)).collect::<Vec<Vote>>()
        });
        Ok(votes.collect())
    }

    /// The vote, of the distances of all rows.
    fn vote_of(&self, distances: &[f64]) -> Vote {
        // The nearest so far, nearest first; a row that is as near as an earlier one comes after it.
        let mut near: Vec<(f64, usize)> = Vec::with_capacity(self.k + 1);
        let mut farthest = f64::INFINITY;
        for (place, &distance) in distances.iter().enumerate() {
            if distance >= farthest {
                continue;
            }
            near.insert(near.partition_point(|&(other, _)| other <= distance), (distance, place));
            near.truncate(self.k);
            if near.len() == self.k {
                farthest = near[self.k - 1].0;
            }
        }
        let mut votes = vec![0usize; self.count];
        near.iter().for_each(|&(_, row)| votes[self.labels[row]] += 1);
        let most = votes.iter().copied().max().unwrap_or(0);
        let neighbours: Vec<usize> = near.into_iter().map(|(_, row)| row).collect();
        let mut labels = neighbours.iter().map(|&row| self.labels[row]);
        let label = labels.find(|&label| votes[label] == most).unwrap_or(0);
        Vote { label, share: most as f64 / self.k as f64, neighbours }
    }

    /// The share of votes of each label.
    ///
    /// # Errors
    /// As [`Neighbours::vote`].
    pub fn probabilities(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        Ok(self.shares(&self.vote(row)?))
    }

    /// The share of votes of each label, of a vote.
    pub(crate) fn shares(&self, vote: &Vote) -> Vec<f64> {
        let mut shares = vec![0.0; self.count];
        for &neighbour in &vote.neighbours {
            shares[self.labels[neighbour]] += 1.0 / self.k as f64;
        }
        shares
    }

    /// How many labels there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How many vote.
    pub fn k(&self) -> usize {
        self.k
    }

    /// Whether what was read is a classifier of that many labels.
    pub(crate) fn fits(&self, labels: usize) -> bool {
        let rows = self.labels.len() == self.rows.len() && (1..=self.rows.len()).contains(&self.k);
        self.count == labels && rows && self.labels.iter().all(|&label| label < labels)
    }

    /// Columns of a row.
    pub fn width(&self) -> usize {
        self.rows.width()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Examples {
        let rows = Rows::new(vec![0.0, 1.0, 1.0, 4.0], 1).unwrap();
        Examples::new(rows, vec![1, 0, 1, 0], 2).unwrap()
    }

    #[test]
    fn ties_go_to_the_earlier_row_and_the_label_of_the_nearest() {
        let vote = Neighbours::new(&three(), 3).unwrap().vote(&[0.5]).unwrap();
        assert_eq!((vote.label, vote.neighbours), (1, vec![0, 1, 2]));
        let vote = Neighbours::new(&three(), 4).unwrap().vote(&[0.9]).unwrap();
        assert_eq!((vote.label, vote.share, vote.neighbours[0]), (0, 0.5, 1));
        let all = Neighbours::new(&three(), 9).unwrap();
        assert_eq!(all.probabilities(&[0.0]).unwrap(), [0.5, 0.5]);
        let asked = Rows::new(vec![0.5, 0.9, -1.0, 3.0, 0.4, 2.6], 1).unwrap();
        let knn = Neighbours::new(&three(), 2).unwrap();
        let each: Vec<Vote> = asked.iter().map(|row| knn.vote(row).unwrap()).collect();
        assert_eq!(knn.votes(&asked).unwrap(), each);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let of = Neighbours::new(&three(), 1).unwrap();
        let expected = AnnotateError::Count { what: "columns", found: 2, expected: 1 };
        assert_eq!(of.vote(&[0.0, 1.0]).unwrap_err(), expected);
        assert!(Neighbours::new(&three(), 0).is_err());
    }
}
