//! Where learning a hidden Markov model begins: which states follow which, and Gaussians from
//! clusters of the frames.

use serde::{Deserialize, Serialize};

use super::Hmm;
use crate::mixture::Mixture;
use crate::numbers::squared_distance;
use crate::{AnnotateError, Rows};

/// Which states follow which.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    /// Every state follows every other.
    #[default]
    Ergodic,
    /// Each state is followed by itself or the next; the first begins, the last stays.
    LeftRight,
}

/// Size and shape of the model that learning begins at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Beginning {
    /// Which states follow which.
    pub topology: Topology,
    /// States.
    pub states: usize,
    /// Gaussians a state.
    pub components: usize,
    /// Probability that a state follows itself, above 0 and below 1.
    pub stay: f64,
}

impl Beginning {
    /// A model of the frames of some sequences. Ergodic: the states are clusters of all frames;
    /// left-right: each sequence is cut into as many even parts. The Gaussians of a state are
    /// clusters of its frames, none narrower than `variance_floor`; a cluster without frames has
    /// weight 0.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`]; [`AnnotateError::Count`] without frames, or fewer of them in a
    /// sequence than a left-right model has states.
    pub fn hmm(&self, sequences: &[Rows], variance_floor: f64) -> Result<Hmm, AnnotateError> {
        for (setting, n) in [("states", self.states), ("components", self.components)] {
            crate::error::above_zero(setting, n as f64)?;
        }
        crate::error::above_zero("variance floor", variance_floor)?;
        if !(self.stay > 0.0 && self.stay < 1.0) {
            let (value, range) = (self.stay, "above 0 and below 1");
            return Err(AnnotateError::Setting { setting: "stay", value, range });
        }
        let frames: Vec<&[f64]> = sequences.iter().flat_map(Rows::iter).collect();
        let Some(width) = frames.first().map(|f| f.len()) else {
            return Err(AnnotateError::Count { what: "frames", found: 0, expected: 1 });
        };
        if let Some(other) = frames.iter().find(|f| f.len() != width) {
            crate::error::as_many("columns of a sequence", other.len(), width)?;
        }
        let state = match self.topology {
            Topology::Ergodic => clusters(&frames, self.states),
            Topology::LeftRight => self.even_parts(sequences)?,
        };
        let mixtures = (0..self.states).map(|s| {
            let own = || frames.iter().zip(&state).filter(move |(_, own)| **own == s);
            let own: Vec<&[f64]> = own().map(|(frame, _)| *frame).collect();
            // A state without frames begins as all of them.
            mixture(if own.is_empty() { &frames } else { &own }, self.components, variance_floor)
        });
        let mixtures = mixtures.collect::<Result<Vec<Mixture>, AnnotateError>>()?;
        Hmm::new(self.start(), self.transition()?, mixtures)
    }

    fn even_parts(&self, sequences: &[Rows]) -> Result<Vec<usize>, AnnotateError> {
        let mut state = Vec::new();
        for found in sequences.iter().map(Rows::len) {
            if found < self.states {
                let what = "frames of a sequence";
                return Err(AnnotateError::Count { what, found, expected: self.states });
            }
            state.extend((0..found).map(|f| f * self.states / found));
        }
        Ok(state)
    }

    fn start(&self) -> Vec<f64> {
        match self.topology {
            Topology::Ergodic => vec![1.0 / self.states as f64; self.states],
            Topology::LeftRight => (0..self.states).map(|s| f64::from(s == 0)).collect(),
        }
    }

    fn transition(&self) -> Result<Rows, AnnotateError> {
        let n = self.states;
        let of = |from: usize, to: usize| match self.topology {
            _ if n == 1 => 1.0,
            Topology::Ergodic if from == to => self.stay,
            Topology::Ergodic => (1.0 - self.stay) / (n - 1) as f64,
            Topology::LeftRight if from == to && from == n - 1 => 1.0,
            Topology::LeftRight if from == to => self.stay,
            Topology::LeftRight if to == from + 1 => 1.0 - self.stay,
            Topology::LeftRight => 0.0,
        };
        Rows::new((0..n).flat_map(|from| (0..n).map(move |to| of(from, to))).collect(), n)
    }
}

/// A mixture whose components are clusters of the frames.
fn mixture(frames: &[&[f64]], components: usize, floor: f64) -> Result<Mixture, AnnotateError> {
    let width = frames[0].len();
    let cluster = clusters(frames, components);
    let mut weight = Vec::with_capacity(components);
    let (mut means, mut variances) = (Vec::new(), Vec::new());
    let all = (0..frames.len()).collect::<Vec<usize>>();
    for component in 0..components {
        let own: Vec<usize> = all.iter().copied().filter(|&f| cluster[f] == component).collect();
        weight.push(own.len() as f64 / frames.len() as f64);
        let own = if own.is_empty() { &all } else { &own };
        let n = own.len() as f64;
        let centre: Vec<f64> =
            (0..width).map(|c| own.iter().map(|&f| frames[f][c]).sum::<f64>() / n).collect();
        let spread = |(c, mean): (usize, &f64)| {
            let square = |&f: &usize| (frames[f][c] - mean) * (frames[f][c] - mean);
            (own.iter().map(square).sum::<f64>() / n).max(floor)
        };
        variances.extend(centre.iter().enumerate().map(spread));
        means.extend(centre);
    }
    Mixture::new(weight, Rows::new(means, width)?, Rows::new(variances, width)?)
}

/// Rounds of k-means at most.
const ROUNDS: usize = 100;

/// k-means from farthest-first starts: the first centre is the row nearest to the mean of all, each
/// next one the row farthest from its nearest centre; of equals the earliest. The cluster of each
/// row; there may be empty ones when rows are alike.
pub(crate) fn clusters(rows: &[&[f64]], count: usize) -> Vec<usize> {
    let mut centres = farthest_first(rows, count);
    let mut cluster = vec![usize::MAX; rows.len()];
    for _ in 0..ROUNDS {
        let mut changed = false;
        for (row, own) in rows.iter().zip(&mut cluster) {
            let mut best = (f64::INFINITY, 0);
            for (place, centre) in centres.iter().enumerate() {
                let distance = squared_distance(row, centre);
                if distance < best.0 {
                    best = (distance, place);
                }
            }
            changed |= *own != best.1;
            *own = best.1;
        }
        if !changed {
            break;
        }
        for (place, centre) in centres.iter_mut().enumerate() {
            let own = rows.iter().zip(&cluster).filter(|(_, c)| **c == place).map(|(r, _)| *r);
            if let Some(mean) = mean(own) {
                *centre = mean;
            }
        }
    }
    cluster
}

fn farthest_first(rows: &[&[f64]], count: usize) -> Vec<Vec<f64>> {
    let Some(centre) = mean(rows.iter().copied()) else { return Vec::new() };
    let from_mean: Vec<f64> = rows.iter().map(|row| -squared_distance(row, &centre)).collect();
    let mut picked = rows[crate::numbers::highest(&from_mean)];
    let mut centres = vec![picked.to_vec()];
    let mut nearest = vec![f64::INFINITY; rows.len()];
    for _ in 1..count.min(rows.len()) {
        for (near, row) in nearest.iter_mut().zip(rows) {
            *near = near.min(squared_distance(row, picked));
        }
        picked = rows[crate::numbers::highest(&nearest)];
        centres.push(picked.to_vec());
    }
    centres
}

fn mean<'a>(rows: impl Iterator<Item = &'a [f64]>) -> Option<Vec<f64>> {
    let mut sum: Option<Vec<f64>> = None;
    let mut n = 0.0;
    for row in rows {
        n += 1.0;
        match &mut sum {
            Some(sum) => sum.iter_mut().zip(row).for_each(|(s, v)| *s += v),
            None => sum = Some(row.to_vec()),
        }
    }
    sum.map(|sum| sum.into_iter().map(|s| s / n).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planted_clusters_are_found_whatever_their_order() {
        let at = [0.0, 0.1, 5.0, 5.1, 9.0, 9.2];
        let rows: Vec<&[f64]> = at.iter().map(std::slice::from_ref).collect();
        let found = clusters(&rows, 3);
        assert!(found[0] == found[1] && found[2] == found[3] && found[4] == found[5]);
        assert!(found[0] != found[2] && found[2] != found[4] && found[0] != found[4]);
        assert_eq!(clusters(&[&[1.0], &[1.0]], 2), [0, 0]);
    }

    #[test]
    fn a_left_right_model_begins_first_and_stays_last() {
        let sequence = Rows::new((0..9).map(f64::from).collect(), 1).unwrap();
        let beginning =
            Beginning { topology: Topology::LeftRight, states: 3, components: 2, stay: 0.8 };
        let hmm = beginning.hmm(std::slice::from_ref(&sequence), 1e-4).unwrap();
        assert_eq!(hmm.start, [1.0, 0.0, 0.0]);
        assert_eq!(hmm.transition.row(2), [0.0, 0.0, 1.0]);
        assert_eq!(hmm.best_path(&sequence).unwrap().states, [0, 0, 0, 1, 1, 1, 2, 2, 2]);
        let short = Rows::new(vec![0.0; 2], 1).unwrap();
        assert!(beginning.hmm(&[short], 1e-4).is_err());
        assert!(Beginning { stay: 1.0, ..beginning }.hmm(&[sequence], 1e-4).is_err());
    }
}
