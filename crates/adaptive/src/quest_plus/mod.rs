//! QUEST+: the level whose answer tells most about the psychometric function (Watson 2017, Journal of
//! Vision 17(3):10), on a grid of its parameters.
//!
//! | Watson | here | size |
//! |---|---|---|
//! | x | level | L |
//! | θ | cell: location, spread, guess, lapse | C at most [`MOST_CELLS`] |
//! | p(θ) | posterior | C |
//! | p(right given x, θ) | `right` | L x C |
//!
//! The entropy that is expected after an answer at level x is, with w the posterior, p the probability of
//! a right answer in a cell and P = Σ w p,
//! P ln P + (1 - P) ln (1 - P) - Σ w ln w - Σ w (p ln p + (1 - p) ln (1 - p)).
//! The last bracket does not depend on the answers, so that a level costs two sums over the cells.

use std::sync::Arc;

mod grid;

pub use grid::{Grid, GridError, MOST_CELLS, PARAMETERS};

use crate::psychometric::Psychometric;

/// Two levels whose expected entropies are nearer than this are alike: the lower one is taken.
const ALIKE: f64 = 1e-12;

/// An answer that no cell of the grid allows: the posterior is what it was.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("no cell of the grid allows this answer at level {level}")]
pub struct ImpossibleAnswer {
    /// The level.
    pub level: f64,
}

/// A level and what is expected of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Its place among the levels.
    pub place: usize,
    /// The level.
    pub level: f64,
    /// Entropy of the posterior that is expected after the answer, in nats.
    pub entropy: f64,
}

/// The state of one track: a posterior over the cells of a grid. Clones share the grid.
#[derive(Debug, Clone)]
pub struct QuestPlus {
    tables: Arc<Tables>,
    posterior: Vec<f64>,
}

/// What does not depend on the answers.
#[derive(Debug)]
struct Tables {
    grid: Grid,
    /// Probability of a right answer: level by level, cell by cell.
    right: Vec<f64>,
    /// p ln p + (1 - p) ln (1 - p) of it.
    certainty: Vec<f64>,
}

impl QuestPlus {
    /// Before the first answer.
    pub fn new(grid: Grid) -> Result<Self, GridError> {
        grid.check()?;
        let cells = grid.cells();
        let mut right = Vec::with_capacity(cells * grid.levels.len());
        for &level in &grid.levels {
            grid.rights_at(level, &mut right);
        }
        let certainty = right.iter().map(|&p| p_ln_p(p) + p_ln_p(1.0 - p)).collect();
        let posterior = grid.before_answers();
        Ok(Self { tables: Arc::new(Tables { grid, right, certainty }), posterior })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.tables.grid
    }

    /// The level of least expected entropy; of levels alike the lower one.
    pub fn choice(&self) -> Choice {
        let own: f64 = self.posterior.iter().map(|&weight| p_ln_p(weight)).sum();
        let levels = &self.tables.grid.levels;
        let mut best = Choice { place: 0, level: levels[0], entropy: f64::INFINITY };
        for (place, &level) in levels.iter().enumerate() {
            let (share, known) = self.weighed(
                self.of_level(place, &self.tables.right),
                self.of_level(place, &self.tables.certainty),
            );
            let entropy = p_ln_p(share) + p_ln_p(1.0 - share) - own - known;
            if entropy < best.entropy - ALIKE {
                best = Choice { place, level, entropy };
            }
        }
        best
    }

    fn of_level<'t>(&self, place: usize, table: &'t [f64]) -> &'t [f64] {
        let cells = self.posterior.len();
        &table[place * cells..(place + 1) * cells]
    }

    /// Σ w p and Σ w c over the cells, in four sums each: their order is fixed, and four can run at a time.
    fn weighed(&self, right: &[f64], certainty: &[f64]) -> (f64, f64) {
        let (mut shares, mut known) = ([0.0; 4], [0.0; 4]);
        let quads = self.posterior.len() / 4 * 4;
        for start in (0..quads).step_by(4) {
            let weights = &self.posterior[start..start + 4];
            let (right, certainty) = (&right[start..start + 4], &certainty[start..start + 4]);
            for lane in 0..4 {
                shares[lane] += weights[lane] * right[lane];
                known[lane] += weights[lane] * certainty[lane];
            }
        }
        for cell in quads..self.posterior.len() {
            shares[0] += self.posterior[cell] * right[cell];
            known[0] += self.posterior[cell] * certainty[cell];
        }
        let sum = |lanes: [f64; 4]| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
        (sum(shares), sum(known))
    }

    /// Takes in an answer at the level of a place. An answer that no cell allows changes nothing.
    ///
    /// # Panics
    /// For a place beyond the levels.
    pub fn answer(&mut self, place: usize, right: bool) -> Result<(), ImpossibleAnswer> {
        let shares = self.of_level(place, &self.tables.right);
        let weight =
            |(weight, share): (&f64, &f64)| weight * if right { *share } else { 1.0 - *share };
        let mut next: Vec<f64> = self.posterior.iter().zip(shares).map(weight).collect();
        let all: f64 = next.iter().sum();
        if all.is_nan() || all <= 0.0 {
            return Err(ImpossibleAnswer { level: self.tables.grid.levels[place] });
        }
        next.iter_mut().for_each(|weight| *weight /= all);
        self.posterior = next;
        Ok(())
    }

    /// The posterior of each value of each parameter.
    pub fn marginals(&self) -> [Vec<f64>; 4] {
        let mut marginals =
            self.tables.grid.values.each_ref().map(|values| vec![0.0; values.len()]);
        for (cell, weight) in self.posterior.iter().enumerate() {
            let places = self.tables.grid.places(cell);
            for (marginal, place) in marginals.iter_mut().zip(places) {
                marginal[place] += weight;
            }
        }
        marginals
    }

    /// Mean and standard deviation of each parameter under the posterior.
    pub fn moments(&self) -> [[f64; 2]; 4] {
        let marginals = self.marginals();
        [0, 1, 2, 3].map(|parameter| {
            let values = self.tables.grid.values[parameter].iter();
            let weighed = || values.clone().zip(&marginals[parameter]);
            let mean: f64 = weighed().map(|(value, weight)| value * weight).sum();
            let square: f64 = weighed().map(|(v, weight)| (v - mean) * (v - mean) * weight).sum();
            [mean, square.sqrt()]
        })
    }

    /// The cell of greatest posterior, the first of several alike.
    pub fn mode(&self) -> Psychometric {
        let mut best = 0;
        for (cell, weight) in self.posterior.iter().enumerate() {
            if *weight > self.posterior[best] {
                best = cell;
            }
        }
        self.tables.grid.function(best)
    }

    /// Entropy of the posterior, in nats.
    pub fn entropy(&self) -> f64 {
        -self.posterior.iter().map(|&weight| p_ln_p(weight)).sum::<f64>()
    }
}

/// p ln p, 0 at 0.
fn p_ln_p(p: f64) -> f64 {
    if p > 0.0 { p * libm::log(p) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psychometric::Shape;

    fn grid() -> Grid {
        Grid {
            shape: Shape::Normal,
            levels: (0..=20).map(|step| f64::from(step) / 20.0).collect(),
            values: [
                (1..20).map(|step| f64::from(step) / 20.0).collect(),
                vec![0.05, 0.1, 0.3],
                vec![0.5],
                vec![0.0, 0.02],
            ],
            prior: [const { None }; 4],
        }
    }

    /// The expected entropy as Watson 2017 writes it: both posteriors, and their entropies weighed.
    fn literal(track: &QuestPlus, place: usize) -> f64 {
        [true, false].iter().fold(0.0, |sum, &right| {
            let shares = track.of_level(place, &track.tables.right);
            let joint: Vec<f64> = track
                .posterior
                .iter()
                .zip(shares)
                .map(|(weight, p)| weight * if right { *p } else { 1.0 - p })
                .collect();
            let all: f64 = joint.iter().sum();
            let entropy: f64 = joint.iter().map(|weight| -p_ln_p(weight / all)).sum();
            sum + all * entropy
        })
    }

    #[test]
    fn the_choice_has_the_least_expected_entropy_of_all_levels() {
        let mut track = QuestPlus::new(grid()).unwrap();
        for trial in 0..30 {
            let choice = track.choice();
            let all: Vec<f64> = (0..21).map(|place| literal(&track, place)).collect();
            assert!((choice.entropy - all[choice.place]).abs() < 1e-12, "{trial}");
            assert!(all.iter().all(|entropy| *entropy > choice.entropy - 1e-11), "{trial}");
            track.answer(choice.place, trial % 3 != 0).unwrap();
        }
        let marginals = track.marginals();
        for (marginal, name) in marginals.iter().zip(PARAMETERS) {
            assert!((marginal.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn a_planted_threshold_is_found() {
        let mut random = mimique_test_support::Random::new(3);
        let truth = Psychometric {
            shape: Shape::Normal,
            location: 0.6,
            spread: 0.1,
            guess: 0.5,
            lapse: 0.02,
        };
        let mut track = QuestPlus::new(grid()).unwrap();
        for _ in 0..300 {
            let choice = track.choice();
            track.answer(choice.place, random.uniform() < truth.right(choice.level)).unwrap();
        }
        let [[location, sd], ..] = track.moments();
        assert!((location - 0.6).abs() < 3.0 * sd && sd < 0.03, "{location} {sd}");
        assert!((track.mode().location - 0.6).abs() < 0.06);
        assert!(track.entropy() < 3.0);
    }

    #[test]
    fn levels_alike_give_the_lower_one() {
        // Every level tells the same of a function that is level.
        let flat = Grid {
            levels: vec![10.0, 11.0, 12.0],
            values: [vec![-1e6], vec![1.0], vec![0.5], vec![0.0, 0.1]],
            ..grid()
        };
        assert_eq!(QuestPlus::new(flat).unwrap().choice().place, 0);
    }

    #[test]
    fn an_answer_that_cannot_be_changes_nothing() {
        let sure = Grid {
            shape: Shape::Weibull,
            levels: vec![0.0, 1e9],
            values: [vec![1.0], vec![2.0], vec![0.0], vec![0.0]],
            prior: [const { None }; 4],
        };
        let mut track = QuestPlus::new(sure).unwrap();
        assert_eq!(track.answer(0, true), Err(ImpossibleAnswer { level: 0.0 }));
        assert_eq!(track.answer(1, false), Err(ImpossibleAnswer { level: 1e9 }));
        assert_eq!(track.posterior, [1.0]);
        track.answer(1, true).unwrap();
    }

    #[test]
    fn the_prior_weighs_the_values() {
        let mut with = grid();
        let weights: Vec<f64> = (1..20).map(f64::from).collect();
        with.prior[0] = Some(weights.clone());
        let marginal = QuestPlus::new(with).unwrap().marginals()[0].clone();
        let all: f64 = weights.iter().sum();
        assert!(marginal.iter().zip(&weights).all(|(m, w)| (m - w / all).abs() < 1e-14));
    }
}
