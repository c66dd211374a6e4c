//! Segments as the thesis scores them (4.5): each answered segment is right or wrong; its truth is the
//! stable label that it shares most frames with.

use serde::Serialize;

use super::Segment;
use crate::Marked;
use crate::labels::most_shared;

/// Counts of answered segments, of one take or several.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LabelledCounts {
    /// Answered segments of each true label; those that share no frame with any are left out.
    pub truth: Vec<u64>,
    /// Those that are labelled rightly.
    pub right: u64,
}

/// How many segments are labelled rightly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LabelledScores {
    /// Segments counted.
    pub n: u64,
    /// Share labelled rightly; none of no segments.
    pub accuracy: Option<f64>,
    /// What always answering the commonest true label of these segments would score.
    pub majority: Option<f64>,
}

impl LabelledCounts {
    /// Count one take.
    pub fn of(truth: &[Marked], answer: &[Segment], labels: usize) -> Self {
        let mut counts = Self { truth: vec![0; labels], right: 0 };
        for (frames, label) in answer {
            if let Some(own) = most_shared(truth, frames) {
                counts.truth[own] += 1;
                counts.right += u64::from(own == *label);
            }
        }
        counts
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.truth.iter_mut().zip(&other.truth).for_each(|(own, other)| *own += other);
        self.right += other.right;
    }

    /// The scores.
    pub fn scores(&self) -> LabelledScores {
        let n: u64 = self.truth.iter().sum();
        let share = |count: u64| (n > 0).then(|| count as f64 / n as f64);
        let most = self.truth.iter().copied().max().unwrap_or(0);
        LabelledScores { n, accuracy: share(self.right), majority: share(most) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mark;

    #[test]
    fn a_segment_s_truth_is_what_it_shares_most_frames_with() {
        let stable = |frames, label| Marked { frames, mark: Mark::Stable(label) };
        let way = Marked { frames: 10..30, mark: Mark::Transition(0, 1) };
        let truth = [stable(0..10, 0), way, stable(30..50, 1)];
        let answer = [(0..25, 0), (12..28, 0), (25..40, 0), (40..50, 1)];
        let counts = LabelledCounts::of(&truth, &answer, 2);
        assert_eq!(counts, LabelledCounts { truth: vec![1, 2], right: 2 });
        let scores = counts.scores();
        assert_eq!(
            (scores.n, scores.accuracy, scores.majority),
            (3, Some(2.0 / 3.0), Some(2.0 / 3.0))
        );
        assert_eq!(LabelledCounts::of(&truth, &[], 2).scores().accuracy, None);
    }
}
