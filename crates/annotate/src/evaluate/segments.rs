//! Segment by segment: which true segments the answer has found.

use std::ops::Range;

use serde::Serialize;

use crate::{Mark, Marked};

/// A segment: its frames and its label.
pub type Segment = (Range<usize>, usize);

/// IoU from which a pair is a hit, one score each.
pub const OVERLAPS: [f64; 3] = [0.10, 0.25, 0.50];

/// The true segments: a transition is shared between its labels at its middle, floor((first + end)
/// / 2), and neighbours of one label join.
pub fn true_segments(truth: &[Marked]) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    let mut push = |frames: Range<usize>, label: usize| {
        if frames.is_empty() {
            return;
        }
        match segments.last_mut() {
            Some((last, own)) if last.end == frames.start && *own == label => last.end = frames.end,
            _ => segments.push((frames, label)),
        }
    };
    for Marked { frames, mark } in truth {
        match *mark {
            Mark::Stable(label) => push(frames.clone(), label),
            Mark::Transition(from, to) => {
                let middle = (frames.start + frames.end) / 2;
                push(frames.start..middle, from);
                push(middle..frames.end, to);
            }
        }
    }
    segments
}

/// The answered segments: those with a label, as they are.
pub fn answered_segments(answer: &[Marked]) -> Vec<Segment> {
    let stable = |marked: &Marked| match marked.mark {
        Mark::Stable(label) => Some((marked.frames.clone(), label)),
        Mark::Transition(..) => None,
    };
    answer.iter().filter_map(stable).collect()
}

/// A true segment and the answer's that it is paired with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pairing {
    /// Place among the true segments.
    pub truth: usize,
    /// Place among the answer's.
    pub answer: usize,
    /// Frames in common over frames in either.
    pub iou: f64,
}

/// Pairs of one label that overlap, one to one, by falling IoU, then the truth's place, then the
/// answer's.
pub fn pairs(truth: &[Segment], answer: &[Segment]) -> Vec<Pairing> {
    let mut all = Vec::new();
    // Both are in order of time: answers that ended before a true segment began are passed once.
    let mut first = 0;
    for (t, (own, label)) in truth.iter().enumerate() {
        while answer.get(first).is_some_and(|(other, _)| other.end <= own.start) {
            first += 1;
        }
        let near = answer.iter().enumerate().skip(first);
        for (a, (other, answered)) in near.take_while(|(_, (other, _))| other.start < own.end) {
            let common = own.end.min(other.end).saturating_sub(own.start.max(other.start));
            if answered == label && common > 0 {
                let iou = common as f64 / (own.len() + other.len() - common) as f64;
                all.push(Pairing { truth: t, answer: a, iou });
            }
        }
    }
    all.sort_by(|a, b| {
        b.iou.total_cmp(&a.iou).then(a.truth.cmp(&b.truth)).then(a.answer.cmp(&b.answer))
    });
    let (mut used_truth, mut used_answer) = (vec![false; truth.len()], vec![false; answer.len()]);
    all.retain(|pair| {
        let free = !used_truth[pair.truth] && !used_answer[pair.answer];
        if free {
            (used_truth[pair.truth], used_answer[pair.answer]) = (true, true);
        }
        free
    });
    all
}

/// 1 - Levenshtein distance of the two sequences of labels / length of the longer; none of two
/// empty ones.
pub fn edit(truth: &[Segment], answer: &[Segment]) -> Option<f64> {
    let longer = truth.len().max(answer.len());
    let mut row: Vec<usize> = (0..=answer.len()).collect();
    for (t, (_, label)) in truth.iter().enumerate() {
        let mut corner = row[0];
        row[0] = t + 1;
        for (a, (_, answered)) in answer.iter().enumerate() {
            let change = corner + usize::from(answered != label);
            corner = row[a + 1];
            row[a + 1] = change.min(row[a] + 1).min(row[a + 1] + 1);
        }
    }
    (longer > 0).then(|| 1.0 - row[answer.len()] as f64 / longer as f64)
}

/// Counts of segments, of one take or several.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SegmentCounts {
    /// True segments.
    pub truth: usize,
    /// Answered segments.
    pub answer: usize,
    /// Pairs at each of [`OVERLAPS`].
    pub hits: [usize; 3],
    /// Sum of the pairs' IoU.
    iou: f64,
    /// The same, weighted by the true segments' frames.
    weighted: f64,
    /// Frames of the true segments.
    frames: usize,
    /// Sum of the takes' edit scores.
    edit: f64,
    /// Takes that have one.
    takes: usize,
}

/// How well segments are found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SegmentScores {
    /// 2 hits / (truth + answer) at each of [`OVERLAPS`]; none without segments.
    pub f1: [Option<f64>; 3],
    /// Mean IoU over true segments, 0 where unpaired; none without true segments.
    pub mean_iou: Option<f64>,
    /// The same, weighted by the true segments' frames.
    pub weighted_iou: Option<f64>,
    /// Answered segments per true one.
    pub ratio: Option<f64>,
    /// Mean over the takes of [`edit`].
    pub edit: Option<f64>,
}

impl SegmentCounts {
    /// Count one take.
    pub fn of(truth: &[Segment], answer: &[Segment]) -> Self {
        let pairs = pairs(truth, answer);
        let edit = edit(truth, answer);
        Self {
            truth: truth.len(),
            answer: answer.len(),
            hits: OVERLAPS.map(|least| pairs.iter().filter(|p| p.iou >= least).count()),
            iou: pairs.iter().map(|p| p.iou).sum(),
            weighted: pairs.iter().map(|p| p.iou * truth[p.truth].0.len() as f64).sum(),
            frames: truth.iter().map(|(frames, _)| frames.len()).sum(),
            edit: edit.unwrap_or(0.0),
            takes: usize::from(edit.is_some()),
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.truth += other.truth;
        self.answer += other.answer;
        self.hits.iter_mut().zip(other.hits).for_each(|(own, other)| *own += other);
        self.iou += other.iou;
        self.weighted += other.weighted;
        self.frames += other.frames;
        self.edit += other.edit;
        self.takes += other.takes;
    }

    /// The scores.
    pub fn scores(&self) -> SegmentScores {
        let over = |value: f64, count: usize| (count > 0).then(|| value / count as f64);
        SegmentScores {
            f1: self.hits.map(|hits| over(2.0 * hits as f64, self.truth + self.answer)),
            mean_iou: over(self.iou, self.truth),
            weighted_iou: over(self.weighted, self.frames),
            ratio: over(self.answer as f64, self.truth),
            edit: over(self.edit, self.takes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transition_is_shared_at_its_middle_and_neighbours_join() {
        let marked = |frames, mark| Marked { frames, mark };
        let truth = [
            marked(0..10, Mark::Stable(0)),
            marked(10..15, Mark::Transition(0, 1)),
            marked(15..20, Mark::Stable(1)),
            marked(25..26, Mark::Transition(1, 0)),
        ];
        assert_eq!(true_segments(&truth), [(0..12, 0), (12..20, 1), (25..26, 0)]);
        assert_eq!(answered_segments(&truth), [(0..10, 0), (15..20, 1)]);
        assert_eq!(edit(&[], &[]), None);
        assert_eq!(edit(&[(0..1, 0), (1..2, 1)], &[(0..2, 1)]), Some(0.5));
    }
}
