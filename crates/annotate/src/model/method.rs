//! Methods and what the user decides of them.

use serde::{Deserialize, Serialize};

use crate::{BaumWelch, ForestOptions, LogisticOptions, SvmOptions, Topology};

/// A method and its settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
pub enum Method {
    /// Nearest neighbours.
    Knn {
        /// How many vote.
        k: usize,
    },
    /// Support vector machines, one against one.
    Svm(SvmOptions),
    /// Multinomial logistic regression.
    Logistic(LogisticOptions),
    /// Random forest.
    Forest(ForestOptions),
    /// Hidden Markov models, one a label, joined.
    Hmm(HmmOptions),
}

impl Default for Method {
    fn default() -> Self {
        Self::Forest(ForestOptions::default())
    }
}

impl Method {
    /// The same, learning the annotators' stretches whatever it learnt before: what a person has
    /// confirmed is not to be cut anew.
    pub fn of_labels(self) -> Self {
        match self {
            Self::Hmm(options) => Self::Hmm(HmmOptions { isolation: None, ..options }),
            other => other,
        }
    }
}

/// What the user decides of hidden Markov models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct HmmOptions {
    /// Which states of a label follow which.
    pub topology: Topology,
    /// States a label.
    pub states: usize,
    /// Gaussians a state.
    pub components: usize,
    /// How each is learnt.
    pub learning: BaumWelch,
    /// Mean time that a label stays, seconds.
    pub mean_stay_s: f64,
    /// Factor of the logarithms of the emissions: below 1 where so many dimensions outweigh the
    /// probability of a change.
    pub temper: f64,
    /// How isolated expressions are cut into neutral, way and peak without labels; where it is not
    /// given, the annotators' stretches are learnt from.
    pub isolation: Option<Isolation>,
}

impl Default for HmmOptions {
    fn default() -> Self {
        Self {
            topology: Topology::Ergodic,
            states: 5,
            components: 20,
            learning: BaumWelch::default(),
            mean_stay_s: 2.0,
            temper: 1.0,
            isolation: None,
        }
    }
}

impl HmmOptions {
    /// As the short paper has them (2.3): 5 states of 20 Gaussians, learnt from the peaks, and from the
    /// neutral stretches, that a model of 3 states of 20 finds in takes of one expression; p_out = 0.01
    /// at its 200 Hz is a stay of 0.5 s. Variances, of which it says nothing, have a floor that only
    /// keeps them above 0. `neutral` is the index of that label.
    pub fn as_in_the_short_paper(neutral: usize) -> Self {
        let learning = BaumWelch { variance_floor: 1e-6, ..BaumWelch::default() };
        let isolation = Some(Isolation { neutral, components: 20 });
        Self { learning, mean_stay_s: 0.5, isolation, ..Self::default() }
    }
}

/// How takes of one expression are cut without labels: a hidden Markov model of three states a take,
/// which are the neutral face, the way and the peak by their rising distance from the neutral (short
/// paper, 2.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Isolation {
    /// Index of the neutral face's label.
    pub neutral: usize,
    /// Gaussians a state.
    pub components: usize,
}
