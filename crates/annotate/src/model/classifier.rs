//! All classifiers behind one: examples or sequences in, a score a label out.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::numbers::highest;
use crate::{
    AnnotateError, BaumWelch, Beginning, Composite, Examples, Forest, ForestOptions, Hmm, Learnt,
    Logistic, LogisticOptions, Neighbours, Rows, Svm, SvmOptions, Topology,
};

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

/// What the user decides of hidden Markov models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
}

impl Default for HmmOptions {
    /// As the short paper has it: 5 states of 20 Gaussians; p_out = 0.01 at 200 Hz is 0.5 s.
    fn default() -> Self {
        Self {
            topology: Topology::Ergodic,
            states: 5,
            components: 20,
            learning: BaumWelch::default(),
            mean_stay_s: 0.5,
        }
    }
}

/// A classifier that has learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Classifier {
    /// Nearest neighbours.
    Knn(Neighbours),
    /// Support vector machines.
    Svm(Svm),
    /// Logistic regression.
    Logistic(Logistic),
    /// Random forest.
    Forest(Forest),
    /// Joined hidden Markov models.
    Hmm(Composite),
}

/// What a classifier learns from: frames thinned, with their labels, and whole stretches of each
/// label, for what learns sequences.
pub(super) struct Material {
    /// The frames.
    pub examples: Examples,
    /// Stretches of each label.
    pub sequences: Vec<Vec<Rows>>,
    /// Frames per second of the stretches.
    pub rate_hz: f64,
}

/// The least probability of which a logarithm is taken.
const LEAST: f64 = 1e-300;

impl Classifier {
    /// The classifier, and how each label's sequences were learnt.
    pub(super) fn learn(
        method: &Method,
        from: &Material,
    ) -> Result<(Self, Vec<LearntLabel>), AnnotateError> {
        let examples = &from.examples;
        let mut report = Vec::new();
        let classifier = match method {
            Method::Knn { k } => Self::Knn(Neighbours::new(examples, *k)?),
            Method::Svm(options) => Self::Svm(Svm::fit(examples, options)?),
            Method::Logistic(options) => Self::Logistic(Logistic::fit(examples, options)?),
            Method::Forest(options) => Self::Forest(Forest::fit(examples, options)?),
            Method::Hmm(options) => {
                let (joined, labels) = joined(options, from)?;
                report = labels;
                Self::Hmm(joined)
            }
        };
        Ok((classifier, report))
    }

    /// A score a label for every row, to be divided by a temperature: log probabilities of logistic
    /// regression and hidden Markov models; of votes (neighbours, trees) ln((votes + 1/2) / (voters
    /// + K/2)), so that no vote is not impossible; of support vector machines [`Svm::scores`].
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the rows have another width, [`AnnotateError::Impossible`].
    pub fn scores(&self, rows: &Rows) -> Result<Rows, AnnotateError> {
        let (mut values, mut labels) = (Vec::new(), 1);
        if let Self::Hmm(joined) = self {
            let posterior = joined.posterior(rows)?;
            values = posterior.values().iter().map(|&p| libm::log(p.max(LEAST))).collect();
            return Rows::new(values, joined.classes());
        }
        let each = (0..rows.len()).into_par_iter().map(|row| self.row_scores(rows.row(row)));
        for scores in each.collect::<Result<Vec<Vec<f64>>, AnnotateError>>()? {
            labels = scores.len();
            values.extend(scores);
        }
        Rows::new(values, labels)
    }

    fn row_scores(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        let (mut shares, voters) = match self {
            Self::Svm(svm) => return svm.scores(row),
            Self::Knn(knn) => (knn.probabilities(row)?, Some(knn.k())),
            Self::Forest(forest) => (forest.probabilities(row)?, Some(forest.trees().len())),
            Self::Logistic(logistic) => (logistic.probabilities(row)?, None),
            Self::Hmm(joined) => {
                let row = Rows::new(row.to_vec(), row.len())?;
                (joined.posterior(&row)?.row(0).to_vec(), None)
            }
        };
        let labels = shares.len() as f64;
        shares.iter_mut().for_each(|share| {
            let share_seen = voters.map_or(*share, |voters| {
                let voters = voters as f64;
                (*share * voters + 0.5) / (voters + labels / 2.0)
            });
            *share = libm::log(share_seen.max(LEAST));
        });
        Ok(shares)
    }

    /// The label of every row taken by itself: LIBSVM's vote, the neighbours' tie rule, else the
    /// highest score.
    ///
    /// # Errors
    /// As [`Classifier::scores`].
    pub fn labels(&self, rows: &Rows) -> Result<Vec<usize>, AnnotateError> {
        match self {
            Self::Knn(knn) => rows.iter().map(|row| Ok(knn.vote(row)?.label)).collect(),
            Self::Svm(svm) => rows.iter().map(|row| svm.label(row)).collect(),
            _ => Ok(self.scores(rows)?.iter().map(highest).collect()),
        }
    }

    /// Columns of a row.
    pub fn width(&self) -> usize {
        match self {
            Self::Knn(knn) => knn.width(),
            Self::Svm(svm) => svm.width(),
            Self::Logistic(logistic) => logistic.width(),
            Self::Forest(forest) => forest.width(),
            Self::Hmm(joined) => joined.hmm().width(),
        }
    }

    /// Whether the classifier holds frames of people as they were: its file is then their data.
    pub fn holds_frames(&self) -> bool {
        matches!(self, Self::Knn(_) | Self::Svm(_))
    }

    /// Whether what was read is a classifier of that many labels.
    pub(super) fn fits(&self, labels: usize) -> bool {
        match self {
            Self::Knn(knn) => knn.fits(labels),
            Self::Svm(svm) => svm.fits(labels),
            Self::Logistic(logistic) => logistic.fits(labels),
            Self::Forest(forest) => forest.fits(labels),
            Self::Hmm(joined) => joined.fits(labels),
        }
    }
}

/// A model a label, joined.
fn joined(
    options: &HmmOptions,
    from: &Material,
) -> Result<(Composite, Vec<LearntLabel>), AnnotateError> {
    crate::error::above_zero("mean stay in seconds", options.mean_stay_s)?;
    let HmmOptions { topology, states, components, .. } = *options;
    let stay = libm::exp(-1.0 / (options.mean_stay_s * from.rate_hz));
    let beginning = Beginning { topology, states, components, stay };
    let learn = |(label, sequences): (usize, &Vec<Rows>)| -> Result<Learnt, AnnotateError> {
        // A chain is not gone through in fewer frames than states.
        let short = if topology == Topology::LeftRight { states } else { 1 };
        let own: Vec<Rows> = sequences.iter().filter(|s| s.len() >= short).cloned().collect();
        if own.is_empty() {
            return Err(AnnotateError::NoExamples { label });
        }
        let begin = beginning.hmm(&own, options.learning.variance_floor)?;
        options.learning.learn(&begin, &own)
    };
    let learnt: Vec<Learnt> =
        from.sequences.iter().enumerate().map(learn).collect::<Result<_, AnnotateError>>()?;
    let models: Vec<Hmm> = learnt.iter().map(|learnt| learnt.hmm.clone()).collect();
    let p_out = Composite::p_out(options.mean_stay_s, from.rate_hz);
    let report = learnt.into_iter().map(|learnt| LearntLabel {
        log_likelihood: learnt.log_likelihood,
        starved: learnt.starved,
    });
    Ok((Composite::join(&models, p_out)?, report.collect()))
}

/// How the hidden Markov model of a label was learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LearntLabel {
    /// ln of the density of its sequences, before each step and after the last.
    pub log_likelihood: Vec<f64>,
    /// Components that had too few frames at the last step: state, component.
    pub starved: Vec<(usize, usize)>,
}
