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
    /// Probability of each label: a frame a row. Frames of given segments have their segment's.
    pub probabilities: Rows,
    /// The scores that these are of, before the temperature.
    #[serde(skip)]
    pub scores: Rows,
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
        crate::error::as_many("shapes of a take", take.weights.width(), self.shapes.len())?;
        if matches!(self.classifier, Classifier::Hmm(_)) {
            crate::error::same_rate(take.rate_hz, self.rate_hz)?;
        }
        let (scores, found) = match decode {
            Decode::Segments(segments) => self.by_segment(take, segments)?,
            Decode::Frames => {
                let scores = self.classifier.scores(&take.weights)?;
                let labels = self.classifier.labels(&take.weights, &scores)?;
                (scores, of_runs(&labels))
            }
            Decode::Path(path) => {
                let scores = self.classifier.scores(&take.weights)?;
                let labels = match &self.classifier {
                    Classifier::Hmm(joined) => joined.path(&take.weights)?,
                    _ => {
                        // Below 1 it would take frames, which say the same thing again and again, for
                        // more evidence than they are.
                        let by = self.temperature.value().max(1.0);
                        let tempered: Vec<f64> = scores.values().iter().map(|s| s / by).collect();
                        path.labels(&tempered, self.labels.len(), take.rate_hz)?
                    }
                };
                (scores, of_runs(&labels))
            }
        };
        let probabilities = self.probabilities(&scores)?;
        let segments = found.into_iter().map(|own| suggested(own, &probabilities)).collect();
        Ok(Answer { segments, probabilities, scores })
    }

    /// The probabilities of scores, a frame a row.
    fn probabilities(&self, scores: &Rows) -> Result<Rows, AnnotateError> {
        let mut values = scores.values().to_vec();
        values.chunks_exact_mut(scores.width()).for_each(|row| self.temperature.apply(row));
        Rows::new(values, scores.width())
    }

    /// Label given segments by the mean of their frames. Frames inside have their segment's scores,
    /// others their own.
    fn by_segment(
        &self,
        take: &Take,
        segments: &[Range<usize>],
    ) -> Result<(Rows, Vec<Segment>), AnnotateError> {
        let marked =
            |frames: &Range<usize>| Marked { frames: frames.clone(), mark: Mark::Stable(0) };
        check(&segments.iter().map(marked).collect::<Vec<_>>(), take.frames())?;
        if let Classifier::Hmm(_) = self.classifier {
            return self.by_posterior(take, segments);
        }
        // A row a segment, then the frames that lie in none.
        let mut row_of = vec![usize::MAX; take.frames()];
        let mut rows = Vec::new();
        for (row, segment) in segments.iter().enumerate() {
            rows.extend(mean(&take.weights, segment.clone()));
            row_of[segment.clone()].fill(row);
        }
        let outside = row_of.iter_mut().enumerate().filter(|(_, row)| **row == usize::MAX);
        for (next, (frame, row)) in (segments.len()..).zip(outside) {
            rows.extend_from_slice(take.weights.row(frame));
            *row = next;
        }
        let rows = Rows::new(rows, take.weights.width())?;
        let scores = self.classifier.scores(&rows)?;
        let whole = 0..segments.len();
        let labels = self.classifier.labels(&rows.select(whole.clone()), &scores.select(whole))?;
        let found = segments.iter().cloned().zip(labels).collect();
        Ok((scores.select(row_of), found))
    }

    /// The same of a sequential classifier: the mean probability of a segment's frames.
    fn by_posterior(
        &self,
        take: &Take,
        segments: &[Range<usize>],
    ) -> Result<(Rows, Vec<Segment>), AnnotateError> {
        let mut scores = self.classifier.scores(&take.weights)?.values().to_vec();
        let width = self.labels.len();
        let frames = self.probabilities(&Rows::new(scores.clone(), width)?)?;
        let mut found = Vec::with_capacity(segments.len());
        for segment in segments {
            let shares = mean(&frames, segment.clone());
            found.push((segment.clone(), highest(&shares)));
            let own: Vec<f64> =
                shares.iter().map(|share| self.temperature.score_of(*share)).collect();
            let rows = &mut scores[segment.start * width..segment.end * width];
            rows.chunks_exact_mut(width).for_each(|row| row.copy_from_slice(&own));
        }
        Ok((Rows::new(scores, width)?, found))
    }
}

/// A segment with the mean probability of its label, and of the next most probable.
fn suggested((frames, label): Segment, probabilities: &Rows) -> Suggested {
    let shares = mean(probabilities, frames.clone());
    let second = (0..shares.len())
        .filter(|&other| other != label)
        .max_by(|&a, &b| shares[a].total_cmp(&shares[b]).then(b.cmp(&a)));
    let second = second.map(|second| (second, shares[second]));
    Suggested { frames, label, probability: shares[label], second }
}

fn of_runs(labels: &[usize]) -> Vec<Segment> {
    runs(labels).into_iter().map(|run| (run.frames, run.label)).collect()
}
