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
        let values: Vec<f64> = match self {
            Self::Hmm(joined) => {
                let posterior = joined.posterior(rows)?;
                posterior.values().iter().map(|&p| libm::log(p.max(LEAST))).collect()
            }
            Self::Knn(knn) => {
                let shares = knn.votes(rows)?.into_iter().flat_map(|vote| knn.shares(&vote));
                logs_of_votes(shares, knn.k(), self.labels_count())
            }
            Self::Forest(forest) => {
                let shares = forest.probabilities_of(rows)?;
                logs_of_votes(shares.into_iter(), forest.trees().len(), self.labels_count())
            }
            Self::Svm(svm) => each_row(rows, |row| svm.scores(row))?,
            Self::Logistic(logistic) => {
                let shares = each_row(rows, |row| logistic.probabilities(row))?;
                shares.into_iter().map(|share| libm::log(share.max(LEAST))).collect()
            }
        };
        Rows::new(values, self.labels_count())
    }

    /// How many labels it tells apart.
    fn labels_count(&self) -> usize {
        match self {
            Self::Knn(knn) => knn.count(),
            Self::Svm(svm) => svm.count(),
            Self::Logistic(logistic) => logistic.bias().len(),
            Self::Forest(forest) => forest.count(),
            Self::Hmm(joined) => joined.labels(),
        }
    }

    /// The label of every row taken by itself: LIBSVM's vote, the neighbours' tie rule, else the
    /// highest of its `scores`.
    ///
    /// # Errors
    /// As [`Classifier::scores`].
    pub fn labels(&self, rows: &Rows, scores: &Rows) -> Result<Vec<usize>, AnnotateError> {
        match self {
            Self::Knn(knn) => Ok(knn.votes(rows)?.into_iter().map(|vote| vote.label).collect()),
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

/// What a classifier says of every row, one after the other.
fn each_row(
    rows: &Rows,
    of: impl Fn(&[f64]) -> Result<Vec<f64>, AnnotateError> + Sync,
) -> Result<Vec<f64>, AnnotateError> {
    let each = (0..rows.len()).into_par_iter().map(|row| of(rows.row(row)));
    Ok(each.collect::<Result<Vec<Vec<f64>>, AnnotateError>>()?.concat())
}

/// ln((votes + 1/2) / (voters + K/2)) of shares of votes.
fn logs_of_votes(shares: impl Iterator<Item = f64>, voters: usize, labels: usize) -> Vec<f64> {
    let (voters, labels) = (voters as f64, labels as f64);
    shares.map(|share| libm::log((share * voters + 0.5) / (voters + labels / 2.0))).collect()
}
