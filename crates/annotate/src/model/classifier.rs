//! All classifiers behind one: examples or sequences in, a score a label out.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::joined::{LearntLabel, joined};
use super::{AnnotatedTake, Method};
use crate::numbers::highest;
use crate::{AnnotateError, Composite, Examples, Forest, Logistic, Neighbours, Rows, Svm};

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

/// What a classifier learns from.
pub(super) struct Material<'a> {
    /// Frames, thinned, with their labels.
    pub examples: Examples,
    /// The takes that they are from, for what learns sequences.
    pub takes: &'a [&'a AnnotatedTake],
}

/// The least probability of which a logarithm is taken.
const LEAST: f64 = 1e-300;

impl Classifier {
    /// The classifier, and how each of its hidden Markov models was learnt.
    pub(super) fn learn(
        method: &Method,
        from: &Material<'_>,
    ) -> Result<(Self, Vec<LearntLabel>), AnnotateError> {
        let examples = &from.examples;
        let mut report = Vec::new();
        let classifier = match method {
            Method::Knn { k } => Self::Knn(Neighbours::new(examples, *k)?),
            Method::Svm(options) => Self::Svm(Svm::fit(examples, options)?),
            Method::Logistic(options) => Self::Logistic(Logistic::fit(examples, options)?),
            Method::Forest(options) => Self::Forest(Forest::fit(examples, options)?),
            Method::Hmm(options) => {
                let (joined, models) = joined(options, from.takes, examples.count())?;
                report = models;
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
            return Rows::new(values, joined.labels());
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
    /// highest of its `scores`.
    ///
    /// # Errors
    /// As [`Classifier::scores`].
    pub fn labels(&self, rows: &Rows, scores: &Rows) -> Result<Vec<usize>, AnnotateError> {
        match self {
            Self::Knn(knn) => rows.iter().map(|row| Ok(knn.vote(row)?.label)).collect(),
            Self::Svm(_) => Ok(scores.iter().map(Svm::label_of_scores).collect()),
            _ => Ok(scores.iter().map(highest).collect()),
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
