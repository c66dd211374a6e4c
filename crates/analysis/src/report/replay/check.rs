//! A number of the results under a key: the call that computes it again, and how near another program comes.

use crate::hypothesis::call::Call;

/// One computation: a key, how it is called, and what came out.
pub(super) struct Check {
    pub key: String,
    pub call: Call,
    pub values: Vec<(&'static str, f64)>,
    /// Values that come in a list: `z` stands for `z.1`, `z.2`.
    pub lists: Vec<(String, Vec<f64>)>,
    pub nearness: Nearness,
}

/// How near another program comes to a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Nearness {
    /// But for rounding.
    Rounding,
    /// To 1e-6: sums in which nearly everything cancels.
    Cancelling,
    /// To 1e-5 of the number and of this size: the highest place of a likelihood is found by another search.
    Search(f64),
    /// A share of random draws, so many of them, and as many times: to five standard errors of the difference of two such
    /// shares, and two draws.
    Draws { draws: usize, times: usize },
}

/// p-values that are corrected together: keys of their checks, and keys for the corrected ones.
pub(super) struct Family {
    pub of: Vec<String>,
    pub into: Vec<String>,
    pub p_holm: Vec<f64>,
    /// The hypothesis of each p, where one may have two; empty where each has one.
    pub hypothesis: Vec<usize>,
    pub nearness: Nearness,
}

impl Check {
    pub(super) fn new(key: String, call: Call, values: Vec<(&'static str, f64)>) -> Self {
        Self { key, call, values, lists: Vec::new(), nearness: Nearness::Rounding }
    }

    pub(super) fn list(mut self, name: impl Into<String>, values: &[f64]) -> Self {
        self.lists.push((name.into(), values.to_vec()));
        self
    }

    pub(super) fn near(mut self, nearness: Nearness) -> Self {
        self.nearness = nearness;
        self
    }

    /// Every value with its name.
    pub(super) fn named(&self) -> impl Iterator<Item = (String, f64)> {
        let values = self.values.iter().map(|(name, value)| ((*name).to_owned(), *value));
        let lists = self.lists.iter().flat_map(|(name, values)| {
            let numbered = values.iter().enumerate();
            numbered.map(move |(place, value)| (format!("{name}.{}", place + 1), *value))
        });
        values.chain(lists)
    }
}

impl Family {
    pub(super) fn empty(nearness: Nearness) -> Self {
        Self {
            of: Vec::new(),
            into: Vec::new(),
            p_holm: Vec::new(),
            hypothesis: Vec::new(),
            nearness,
        }
    }
}

impl Nearness {
    /// The difference that a value may have beside that of rounding.
    pub(super) fn tolerance(self, value: f64) -> f64 {
        match self {
            Self::Rounding => 0.0,
            Self::Cancelling => 1e-6,
            Self::Search(size) => 1e-5 * (value.abs() + size),
            Self::Draws { draws, times } => {
                let (draws, times) = (draws as f64, times as f64);
                // No share that was drawn is known better than one of a few draws.
                let share = (value / times).clamp(5.0 / draws, 1.0 - 5.0 / draws);
                times * (5.0 * (2.0 * share * (1.0 - share) / draws).sqrt() + 2.0 / draws)
            }
        }
    }
}
