//! Border by border: how near the answer's borders are to the true ones.

use serde::Serialize;

use super::Segment;

/// Starts of all true segments but the first.
pub fn true_borders(truth: &[Segment]) -> Vec<usize> {
    truth.iter().skip(1).map(|(frames, _)| frames.start).collect()
}

/// All ends of the answered segments, each once, but 0 and the take's end.
pub fn answered_borders(answer: &[Segment], frames: usize) -> Vec<usize> {
    let mut borders: Vec<usize> = answer.iter().flat_map(|(own, _)| [own.start, own.end]).collect();
    borders.sort_unstable();
    borders.dedup();
    borders.retain(|&border| border != 0 && border != frames);
    borders
}

/// Counts of borders, of one take or several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct BorderCounts {
    /// True borders.
    pub truth: usize,
    /// Answered borders.
    pub answer: usize,
    /// Pairs, one to one, nearest first, then the truth's place, then the answer's.
    pub hits: usize,
    /// Sum of the pairs' distances, frames.
    distance: usize,
}

/// How well borders are found; none where there is nothing to count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BorderScores {
    /// Share of the answered borders that are hits.
    pub precision: Option<f64>,
    /// Share of the true borders that are hit.
    pub recall: Option<f64>,
    /// 2 hits / (truth + answer).
    pub f1: Option<f64>,
    /// Mean distance of the hits, frames.
    pub distance: Option<f64>,
}

impl BorderCounts {
    /// Count one take; borders in ascending order, pairs at most `tolerance` frames apart.
    pub fn of(truth: &[usize], answer: &[usize], tolerance: usize) -> Self {
        let mut near: Vec<(usize, usize, usize)> = Vec::new();
        for (t, &own) in truth.iter().enumerate() {
            let first = answer.partition_point(|&other| other + tolerance < own);
            let reach = answer.iter().enumerate().skip(first);
            for (a, &other) in reach.take_while(|(_, other)| **other <= own + tolerance) {
                near.push((own.abs_diff(other), t, a));
            }
        }
        near.sort_unstable();
        let mut counts = Self { truth: truth.len(), answer: answer.len(), ..Self::default() };
        let (mut used_truth, mut used_answer) =
            (vec![false; truth.len()], vec![false; answer.len()]);
        for (distance, t, a) in near {
            if !used_truth[t] && !used_answer[a] {
                (used_truth[t], used_answer[a]) = (true, true);
                counts.hits += 1;
                counts.distance += distance;
            }
        }
        counts
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.truth += other.truth;
        self.answer += other.answer;
        self.hits += other.hits;
        self.distance += other.distance;
    }

    /// The scores.
    pub fn scores(&self) -> BorderScores {
        let over = |value: usize, count: usize| (count > 0).then(|| value as f64 / count as f64);
        BorderScores {
            precision: over(self.hits, self.answer),
            recall: over(self.hits, self.truth),
            f1: over(2 * self.hits, self.truth + self.answer),
            distance: over(self.distance, self.hits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_first_and_each_once() {
        // 12 is nearer to 11 than to 10; 10 is left the one at 5.
        let counts = BorderCounts::of(&[10, 11, 50], &[5, 12, 80], 5);
        assert_eq!((counts.hits, counts.distance), (2, 6));
        assert_eq!(counts.scores().distance, Some(3.0));
        assert_eq!(BorderCounts::of(&[], &[3], 5).scores().recall, None);
        assert_eq!(answered_borders(&[(0..4, 0), (4..9, 1), (10..12, 0)], 12), [4, 9, 10]);
        assert_eq!(true_borders(&[(2..4, 0), (4..9, 1)]), [4]);
    }
}
