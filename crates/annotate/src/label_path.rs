//! Labels that stay: the most probable path over the scores of a classifier's frames.
//!
//! Viterbi over `temper` times the log scores; every label begins with 1 / K, stays with
//! exp(-1 / (mean stay x rate)) and gives way to each other one with the rest / (K - 1).

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::AnnotateError;
use crate::error::above_zero;
use crate::hmm::Emissions;
use crate::hmm::viterbi::best_path;

/// How long labels stay, and how much the frames' scores count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LabelPath {
    /// Mean time that a label stays, seconds.
    pub mean_stay_s: f64,
    /// Factor of the log scores: below 1 where neighbouring frames say the same thing again.
    pub temper: f64,
}

impl Default for LabelPath {
    fn default() -> Self {
        Self { mean_stay_s: 2.0, temper: 1.0 }
    }
}

/// Frames of one label.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Run {
    /// First frame, one past the last.
    pub frames: Range<usize>,
    /// Index of the label.
    pub label: usize,
}

impl LabelPath {
    /// The probability that a label stays for another frame.
    pub fn stay(&self, rate_hz: f64) -> f64 {
        libm::exp(-1.0 / (self.mean_stay_s * rate_hz))
    }

    /// The label of every frame, of log scores: frame after frame, `labels` a frame; minus infinity
    /// is a label that cannot be.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`], [`AnnotateError::Shape`]; [`AnnotateError::NotFinite`] for NaN;
    /// [`AnnotateError::Impossible`] when a frame can have no label.
    pub fn labels(
        &self,
        log_scores: &[f64],
        labels: usize,
        rate_hz: f64,
    ) -> Result<Vec<usize>, AnnotateError> {
        above_zero("mean stay in seconds", self.mean_stay_s)?;
        above_zero("temper", self.temper)?;
        above_zero("rate in Hz", rate_hz)?;
        crate::error::at_most("labels", labels, usize::from(u16::MAX))?;
        if labels == 0 || !log_scores.len().is_multiple_of(labels) {
            return Err(AnnotateError::Shape { values: log_scores.len(), width: labels });
        }
        if let Some(at) = log_scores.iter().position(|s| s.is_nan() || *s == f64::INFINITY) {
            let (row, column, value) = (at / labels, at % labels, log_scores[at]);
            return Err(AnnotateError::NotFinite { row, column, value });
        }
        let stay = -1.0 / (self.mean_stay_s * rate_hz);
        let leave = libm::log(-libm::expm1(stay) / (labels.max(2) - 1) as f64);
        let of = |from: usize, to: usize| match (labels, from == to) {
            (1, _) => 0.0,
            (_, true) => stay,
            (_, false) => leave,
        };
        let transition: Vec<f64> =
            (0..labels).flat_map(|from| (0..labels).map(move |to| of(from, to))).collect();
        let start = vec![-libm::log(labels as f64); labels];
        let tempered = log_scores.iter().map(|s| self.temper * s).collect();
        best_path(&start, &transition, Emissions::of(tempered, labels))
            .map(|path| path.states)
            .ok_or(AnnotateError::Impossible { sequence: 0 })
    }
}

/// The runs of equal labels, in order.
pub fn runs(labels: &[usize]) -> Vec<Run> {
    let mut start = 0;
    let mut found = Vec::new();
    for own in labels.chunk_by(|a, b| a == b) {
        found.push(Run { frames: start..start + own.len(), label: own[0] });
        start += own.len();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_frame_is_overruled_and_a_stretch_is_kept() {
        let mut scores = vec![[-0.1f64, -2.0]; 100];
        scores[30] = [-2.0, -0.1];
        scores[60..].fill([-2.0, -0.1]);
        let path = LabelPath::default();
        let found = path.labels(scores.as_flattened(), 2, 60.0).unwrap();
        let expected = [Run { frames: 0..60, label: 0 }, Run { frames: 60..100, label: 1 }];
        assert_eq!(runs(&found), expected);
        let doubled: Vec<f64> = scores.as_flattened().iter().map(|s| s - 7.0).collect();
        assert_eq!(path.labels(&doubled, 2, 60.0).unwrap(), found);
        assert_eq!(path.labels(&[-1.0; 3], 1, 60.0).unwrap(), [0; 3]);
        assert!(runs(&[]).is_empty());
    }

    #[test]
    fn what_is_no_score_is_refused() {
        let path = LabelPath::default();
        let none = [f64::NEG_INFINITY; 2];
        assert_eq!(path.labels(&none, 2, 60.0), Err(AnnotateError::Impossible { sequence: 0 }));
        assert!(path.labels(&[0.0, f64::NAN], 2, 60.0).is_err());
        assert!(path.labels(&[0.0; 3], 2, 60.0).is_err());
        assert!(LabelPath { mean_stay_s: 0.0, ..path }.labels(&[0.0; 2], 2, 60.0).is_err());
    }
}
