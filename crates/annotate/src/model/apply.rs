//! Labelling a take by a model.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{Classifier, Model};
use crate::evaluate::Segment;
use crate::features::mean;
use crate::labels::check;
use crate::numbers::highest;
use crate::stretches::Segmentation;
use crate::{AnnotateError, LabelPath, Mark, Marked, Rows, Take, runs};

/// How the labels of frames become segments, as a model keeps it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decoding {
    /// Labels that stay: the most probable path.
    Path(LabelPath),
    /// Stretches of the take, each labelled by the mean of its frames (thesis 4.6).
    Segments(Segmentation),
    /// Each frame by itself.
    Frames,
}

impl Default for Decoding {
    fn default() -> Self {
        Self::Path(LabelPath::default())
    }
}

impl Decoding {
    /// What it is for a take whose columns these shapes name.
    ///
    /// # Errors
    /// [`AnnotateError::Filter`] when the cut-off does not fit the rate.
    pub fn of(&self, take: &Take, shapes: &[String]) -> Result<Decode, AnnotateError> {
        Ok(match self {
            Self::Path(path) => Decode::Path(*path),
            Self::Segments(of) => Decode::Segments(of.stretches(take, shapes)?),
            Self::Frames => Decode::Frames,
        })
    }
}

/// How the labels of a take's frames become segments.
#[derive(Debug, Clone, PartialEq)]
pub enum Decode {
    /// Labels that stay: the most probable path.
    Path(LabelPath),
    /// Given segments, each labelled by the mean of its frames (thesis 4.6).
    Segments(Vec<Range<usize>>),
    /// Each frame by itself.
    Frames,
}

impl Default for Decode {
    fn default() -> Self {
        Self::Path(LabelPath::default())
    }
}

/// A suggested segment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Suggested {
    /// First frame, one past the last.
    pub frames: Range<usize>,
    /// The label.
    pub label: usize,
    /// Mean of its probability over the frames.
    pub probability: f64,
    /// The most probable of the others, and its mean probability.
    pub second: Option<(usize, f64)>,
}

/// What a model says of a take.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Answer {
    /// Segments in order of time.
    pub segments: Vec<Suggested>,
    /// Probability of each label: a frame a row.
    pub probabilities: Rows,
}

impl Model {
    /// Label a take whose columns are the model's shapes in its order. Methods that label frames by
    /// themselves take a take of any rate; hidden Markov models only one of the rate they learnt at.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] for other shapes, [`AnnotateError::Rate`],
    /// [`AnnotateError::Interval`] for segments out of order or beyond the take, and
    /// [`AnnotateError::Setting`].
    pub fn label(&self, take: &Take, decode: &Decode) -> Result<Answer, AnnotateError> {
        self.answer(take, &self.scores(take)?, decode)
    }

    /// The scores of a take's frames, a label a column, before the temperature.
    ///
    /// # Errors
    /// As [`Model::label`].
    pub fn scores(&self, take: &Take) -> Result<Rows, AnnotateError> {
        crate::error::as_many("shapes of a take", take.weights.width(), self.shapes.len())?;
        let sequential = matches!(self.classifier, Classifier::Hmm(_));
        if sequential && take.rate_hz != self.rate_hz {
            return Err(AnnotateError::Rate { found: take.rate_hz, expected: self.rate_hz });
        }
        self.classifier.scores(&take.weights)
    }

    /// The answer that follows from the scores of a take.
    pub(crate) fn answer(
        &self,
        take: &Take,
        scores: &Rows,
        decode: &Decode,
    ) -> Result<Answer, AnnotateError> {
        let mut probabilities = scores.values().to_vec();
        let labels = self.labels.len();
        probabilities.chunks_exact_mut(labels).for_each(|row| self.temperature.apply(row));
        let mut probabilities = Rows::new(probabilities, labels)?;
        let found: Vec<Segment> = match decode {
            Decode::Segments(segments) => {
                let (found, by_segment) = self.segments(take, segments, &probabilities)?;
                probabilities = by_segment;
                found
            }
            Decode::Frames => of_runs(&self.classifier.labels(&take.weights, scores)?),
            Decode::Path(path) => of_runs(&match &self.classifier {
                Classifier::Hmm(joined) => joined.path(&take.weights)?,
                _ => {
                    let tempered: Vec<f64> =
                        scores.values().iter().map(|s| s / self.temperature.value()).collect();
                    path.labels(&tempered, labels, take.rate_hz)?
                }
            }),
        };
        let segments = found.into_iter().map(|(frames, label)| {
            let shares = mean(&probabilities, frames.clone());
            let second = (0..labels)
                .filter(|&l| l != label)
                .max_by(|&a, &b| shares[a].total_cmp(&shares[b]).then(b.cmp(&a)));
            let second = second.map(|second| (second, shares[second]));
            Suggested { frames, label, probability: shares[label], second }
        });
        Ok(Answer { segments: segments.collect(), probabilities })
    }

    /// Label given segments. Frames inside have their segment's probabilities.
    fn segments(
        &self,
        take: &Take,
        segments: &[Range<usize>],
        frames: &Rows,
    ) -> Result<(Vec<Segment>, Rows), AnnotateError> {
        let marked =
            |frames: &Range<usize>| Marked { frames: frames.clone(), mark: Mark::Stable(0) };
        check(&segments.iter().map(marked).collect::<Vec<_>>(), take.frames())?;
        let mut by_segment = frames.values().to_vec();
        let width = frames.width();
        let mut found = Vec::with_capacity(segments.len());
        for segment in segments {
            let (label, shares) = if let Classifier::Hmm(_) = self.classifier {
                let shares = mean(frames, segment.clone());
                (highest(&shares), shares)
            } else {
                let row = mean(&take.weights, segment.clone());
                let row = Rows::new(row, take.weights.width())?;
                let scores = self.classifier.scores(&row)?;
                let mut shares = scores.values().to_vec();
                self.temperature.apply(&mut shares);
                (self.classifier.labels(&row, &scores)?[0], shares)
            };
            let own = &mut by_segment[segment.start * width..segment.end * width];
            own.chunks_exact_mut(width).for_each(|row| row.copy_from_slice(&shares));
            found.push((segment.clone(), label));
        }
        Ok((found, Rows::new(by_segment, width)?))
    }
}

fn of_runs(labels: &[usize]) -> Vec<Segment> {
    runs(labels).into_iter().map(|run| (run.frames, run.label)).collect()
}
