//! The scores that an evaluation tells, in their order.

use serde::{Deserialize, Serialize};

use super::Scores;

/// One number of [`Scores`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Score {
    /// Share of the frames labelled rightly.
    Accuracy,
    /// Mean of the labels' recalls.
    BalancedAccuracy,
    /// Mean of the labels' F1.
    MacroF1,
    /// Cohen's kappa.
    Kappa,
    /// Share of the answered segments labelled rightly (thesis 4.5).
    SegmentsRight,
    /// F1 of segments that overlap with an IoU of 0.10 at least.
    F1At10,
    /// F1 of segments that overlap with an IoU of 0.25 at least.
    F1At25,
    /// F1 of segments that overlap with an IoU of 0.50 at least.
    F1At50,
    /// Mean IoU over true segments, weighted by their length.
    WeightedIou,
    /// Edit score of the sequence of labels.
    Edit,
    /// Answered segments per true one: 1 is best.
    Ratio,
    /// F1 of borders.
    BorderF1,
}

impl Score {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Accuracy,
        Self::BalancedAccuracy,
        Self::MacroF1,
        Self::Kappa,
        Self::SegmentsRight,
        Self::F1At10,
        Self::F1At25,
        Self::F1At50,
        Self::WeightedIou,
        Self::Edit,
        Self::Ratio,
        Self::BorderF1,
    ];

    /// Its value.
    pub fn of(self, scores: &Scores) -> Option<f64> {
        match self {
            Self::Accuracy => scores.frames.accuracy,
            Self::BalancedAccuracy => scores.frames.balanced_accuracy,
            Self::MacroF1 => scores.frames.macro_f1,
            Self::Kappa => scores.frames.kappa,
            Self::SegmentsRight => scores.labelled.accuracy,
            Self::F1At10 => scores.segments.f1[0],
            Self::F1At25 => scores.segments.f1[1],
            Self::F1At50 => scores.segments.f1[2],
            Self::WeightedIou => scores.segments.weighted_iou,
            Self::Edit => scores.segments.edit,
            Self::Ratio => scores.segments.ratio,
            Self::BorderF1 => scores.borders.f1,
        }
    }
}
