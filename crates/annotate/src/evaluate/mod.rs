//! How good suggested labels are: frame by frame, segment by segment, border by border, and beside
//! it what always answering the commonest label would score.

mod borders;
mod frames;
mod held_out;
mod labelled;
mod resample;
mod score;
mod segments;
mod split;
mod summary;

use serde::Serialize;

pub use borders::{BorderCounts, BorderScores, answered_borders, true_borders};
pub use frames::{Confusion, FrameScores, LabelScores, Majority};
pub use held_out::{Candidate, Cut, Judged, held_out, judged};
pub use labelled::{LabelledCounts, LabelledScores};
pub use resample::{FEWEST, draws, intervals};
pub use score::Score;
pub use segments::{
    OVERLAPS, Pairing, Segment, SegmentCounts, SegmentScores, answered_segments, edit, pairs,
    true_segments,
};
pub use split::{Fold, check_folds, folds, leave_out};
pub use summary::{Interval, Summary, summary};

use crate::labels::{by_frame, check};
use crate::{AnnotateError, Mark, Marked};

/// What is counted of a take, or of several together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Counts {
    /// Frames by true and answered label; those in a transition or without label are left out.
    pub confusion: Confusion,
    /// Frames with a true label to which the answer gives none.
    pub frames_without_answer: usize,
    /// Segments that the answer has found of the truth.
    pub segments: SegmentCounts,
    /// Segments of the answer, each right or wrong.
    pub labelled: LabelledCounts,
    /// Borders.
    pub borders: BorderCounts,
}

/// The scores of counts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scores {
    /// Frame by frame.
    pub frames: FrameScores,
    /// What always answering the commonest true label would score.
    pub majority: Option<Majority>,
    /// True segments found.
    pub segments: SegmentScores,
    /// Answered segments right.
    pub labelled: LabelledScores,
    /// Border by border.
    pub borders: BorderScores,
}

/// What a comparison needs to know of a take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Comparison {
    /// Labels of the vocabulary.
    pub labels: usize,
    /// Frames of the take.
    pub frames: usize,
    /// How many frames apart two borders are one.
    pub tolerance: usize,
}

impl Comparison {
    /// Compare an answer with the truth, both in order of time.
    ///
    /// # Errors
    /// [`AnnotateError::Interval`], [`AnnotateError::Label`].
    pub fn counts(&self, truth: &[Marked], answer: &[Marked]) -> Result<Counts, AnnotateError> {
        for marked in [truth, answer] {
            check(marked, self.frames)?;
            self.check_labels(marked)?;
        }
        let answered = by_frame(answer, self.frames);
        let mut confusion = Confusion::new(self.labels);
        let mut frames_without_answer = 0;
        for pair in by_frame(truth, self.frames).into_iter().zip(answered) {
            match pair {
                (Some(truth), Some(answer)) => confusion.count(truth, answer),
                (Some(_), None) => frames_without_answer += 1,
                (None, _) => {}
            }
        }
        let answer = answered_segments(answer);
        let labelled = LabelledCounts::of(truth, &answer, self.labels);
        let truth = true_segments(truth);
        let borders = answered_borders(&answer, self.frames);
        Ok(Counts {
            confusion,
            frames_without_answer,
            segments: SegmentCounts::of(&truth, &answer),
            labelled,
            borders: BorderCounts::of(&true_borders(&truth), &borders, self.tolerance),
        })
    }

    fn check_labels(&self, marked: &[Marked]) -> Result<(), AnnotateError> {
        for (row, Marked { mark, .. }) in marked.iter().enumerate() {
            let [a, b] = match *mark {
                Mark::Stable(label) => [label; 2],
                Mark::Transition(from, to) => [from, to],
            };
            if let Some(label) = [a, b].into_iter().find(|&label| label >= self.labels) {
                return Err(AnnotateError::Label { row, label, labels: self.labels });
            }
        }
        Ok(())
    }
}

impl Counts {
    /// Counts added up; none of none.
    pub fn pooled<'a>(counts: impl IntoIterator<Item = &'a Self>) -> Option<Self> {
        let mut counts = counts.into_iter();
        let mut all = counts.next()?.clone();
        for other in counts {
            all.confusion.add(&other.confusion);
            all.frames_without_answer += other.frames_without_answer;
            all.segments.add(&other.segments);
            all.labelled.add(&other.labelled);
            all.borders.add(&other.borders);
        }
        Some(all)
    }

    /// The scores.
    pub fn scores(&self) -> Scores {
        Scores {
            frames: self.confusion.scores(),
            majority: self.confusion.majority(),
            segments: self.segments.scores(),
            labelled: self.labelled.scores(),
            borders: self.borders.scores(),
        }
    }
}
