//! What simulated participants are told of a kind of question.

use super::number::NumberField;

/// A scale: `points` values from `start`, `step` apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// The first value.
    pub start: f64,
    /// From one value to the next.
    pub step: f64,
    /// How many values there are.
    pub points: usize,
}

impl Scale {
    /// The value of a point, from 0.
    pub fn value(&self, point: usize) -> f64 {
        self.start + self.step * point as f64
    }

    /// From the lowest to the highest value.
    pub fn span(&self) -> f64 {
        self.step * (self.points.max(1) - 1) as f64
    }

    /// The borders half-way between neighbouring values.
    pub fn borders(&self) -> Vec<f64> {
        (1..self.points).map(|point| self.value(point) - self.step / 2.0).collect()
    }
}

/// How the answers of simulated participants come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Simulated<'a> {
    /// A latent value, shown on the kind's scale.
    Rated,
    /// One option: the right one or another where it has a `truth`, else by shares.
    OneOption,
    /// Any of the options, by shares.
    SeveralOptions {
        /// Fewest that must be chosen.
        fewest: Option<usize>,
        /// Most that may be chosen.
        most: usize,
    },
    /// A typed number.
    Number(&'a NumberField),
    /// Which of two clips, by their worths.
    Compared {
        /// Whether "no difference" can be answered.
        same: bool,
    },
    /// By [`super::KindOfQuestion::drawn`].
    Drawn {
        /// Whether its options are chosen by shares, which a parameters file can give.
        by_shares: bool,
    },
}

/// A source of random draws.
pub trait Chance {
    /// A whole number below `count`, each equally likely.
    fn below(&mut self, count: usize) -> usize;

    /// A place, each as likely as its weight.
    fn weighted(&mut self, weights: &[f64]) -> usize;

    /// Puts places in an order, each equally likely.
    fn shuffle(&mut self, places: &mut [usize]);
}
