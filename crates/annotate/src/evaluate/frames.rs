//! Frame by frame: the confusion of truth and answer, and what follows of it.

use serde::Serialize;

/// Frames by true label (a row) and answered label.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Confusion {
    counts: Vec<u64>,
    labels: usize,
}

/// How well frames are labelled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameScores {
    /// Frames counted.
    pub n: u64,
    /// Share labelled rightly; none of no frames.
    pub accuracy: Option<f64>,
    /// Mean of the labels' recalls, over labels in the truth.
    pub balanced_accuracy: Option<f64>,
    /// Mean of the labels' F1, over labels in truth or answer.
    pub macro_f1: Option<f64>,
    /// Cohen's kappa; none where chance alone agrees wholly.
    pub kappa: Option<f64>,
    /// Its standard error (Fleiss, Cohen and Everitt, Psychological Bulletin 1969, eq. 13).
    pub kappa_se: Option<f64>,
}

/// How well the frames of one label are labelled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LabelScores {
    /// Frames that truly have it.
    pub n: u64,
    /// Share of them that is found; none where there are none.
    pub recall: Option<f64>,
    /// Share of the frames answered so that truly have it; none where none is answered so.
    pub precision: Option<f64>,
    /// 2 right / (truth + answer); none where both are 0.
    pub f1: Option<f64>,
}

/// What always answering the commonest true label would score.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Majority {
    /// The commonest true label, of several the lowest.
    pub label: usize,
    /// Its scores.
    pub scores: FrameScores,
}

impl Confusion {
    /// Nothing counted.
    pub fn new(labels: usize) -> Self {
        Self { counts: vec![0; labels * labels], labels }
    }

    /// Count a frame.
    pub(super) fn count(&mut self, truth: usize, answer: usize) {
        self.counts[truth * self.labels + answer] += 1;
    }

    /// Frames of a true label, by answered label.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, u64> {
        self.counts.chunks_exact(self.labels.max(1))
    }

    /// Add another's counts.
    pub(super) fn add(&mut self, other: &Self) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(own, other)| *own += other);
    }

    /// Frames of each true label.
    fn truths(&self) -> Vec<u64> {
        self.rows().map(|row| row.iter().sum()).collect()
    }

    /// Frames of each answered label.
    fn answers(&self) -> Vec<u64> {
        (0..self.labels).map(|label| self.rows().map(|row| row[label]).sum()).collect()
    }

    fn right(&self, label: usize) -> u64 {
        self.counts[label * self.labels + label]
    }

    /// The scores of each label, by index.
    pub fn label_scores(&self) -> Vec<LabelScores> {
        let (truths, answers) = (self.truths(), self.answers());
        let of = |label: usize| {
            let (n, answered, right) = (truths[label], answers[label], self.right(label) as f64);
            let share = |of: u64, times: f64| (of > 0).then(|| times * right / of as f64);
            LabelScores {
                n,
                recall: share(n, 1.0),
                precision: share(answered, 1.0),
                f1: share(n + answered, 2.0),
            }
        };
        (0..self.labels).map(of).collect()
    }

    /// The scores.
    pub fn scores(&self) -> FrameScores {
        let (truths, answers) = (self.truths(), self.answers());
        let n: u64 = truths.iter().sum();
        let right = |label: usize| self.right(label);
        let mean = |values: Vec<f64>| {
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let labels = self.label_scores();
        let accuracy = (n > 0).then(|| (0..self.labels).map(right).sum::<u64>() as f64 / n as f64);
        let kappa = self.kappa(&truths, &answers, n);
        FrameScores {
            n,
            accuracy,
            balanced_accuracy: mean(labels.iter().filter_map(|label| label.recall).collect()),
            macro_f1: mean(labels.iter().filter_map(|label| label.f1).collect()),
            kappa: kappa.map(|(kappa, _)| kappa),
            kappa_se: kappa.map(|(_, se)| se),
        }
    }

    /// Kappa and its standard error.
    fn kappa(&self, truths: &[u64], answers: &[u64], n: u64) -> Option<(f64, f64)> {
        let share = |count: u64| count as f64 / n as f64;
        let observed: f64 =
            (0..self.labels).map(|l| share(self.counts[l * (self.labels + 1)])).sum();
        let chance: f64 = truths.iter().zip(answers).map(|(t, a)| share(*t) * share(*a)).sum();
        let certain = truths.iter().zip(answers).any(|(t, a)| *t == n && *a == n);
        if n == 0 || certain {
            return None;
        }
        let (mut agreed, mut differing) = (0.0, 0.0);
        for (i, row) in self.rows().enumerate() {
            for (j, &count) in row.iter().enumerate() {
                if i == j {
                    let marginal = share(truths[i]) + share(answers[i]);
                    let own = (1.0 - chance) - marginal * (1.0 - observed);
                    agreed += share(count) * own * own;
                } else {
                    let marginal = share(answers[i]) + share(truths[j]);
                    differing += share(count) * marginal * marginal;
                }
            }
        }
        let left = observed * chance - 2.0 * chance + observed;
        let lost = 1.0 - observed;
        let variance = (agreed + lost * lost * differing - left * left).max(0.0) / n as f64;
        let rest = 1.0 - chance;
        Some(((observed - chance) / rest, variance.sqrt() / (rest * rest)))
    }

    /// What always answering the commonest true label would score; none of no frames.
    pub fn majority(&self) -> Option<Majority> {
        let truths = self.truths();
        let most = truths.iter().copied().max().filter(|&most| most > 0)?;
        let label = truths.iter().position(|&n| n == most)?;
        let mut always = Self::new(self.labels);
        for (truth, n) in truths.iter().enumerate() {
            always.counts[truth * self.labels + label] = *n;
        }
        Some(Majority { label, scores: always.scores() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(counts: &[u64], labels: usize) -> Confusion {
        Confusion { counts: counts.to_vec(), labels }
    }

    #[test]
    fn two_by_two_by_hand() {
        // Accuracy 0.7, chance 0.5: kappa 0.4.
        let scores = of(&[20, 5, 10, 15], 2).scores();
        assert!((scores.accuracy.unwrap() - 0.7).abs() < 1e-15);
        assert!((scores.kappa.unwrap() - 0.4).abs() < 1e-12);
        assert!((scores.macro_f1.unwrap() - (40.0 / 55.0 + 30.0 / 45.0) / 2.0).abs() < 1e-12);
        let second = of(&[20, 5, 10, 15], 2).label_scores()[1];
        assert_eq!((second.n, second.recall, second.precision), (25, Some(0.6), Some(0.75)));
        let whole = of(&[9, 0, 0, 0], 2).scores();
        assert_eq!(
            (whole.kappa, whole.balanced_accuracy, whole.macro_f1),
            (None, Some(1.0), Some(1.0))
        );
        let nothing = Confusion::new(3);
        assert_eq!((nothing.scores().accuracy, nothing.majority()), (None, None));
    }

    #[test]
    fn the_order_of_the_labels_does_not_matter() {
        let (one, other) =
            (of(&[5, 1, 0, 2, 7, 3, 1, 1, 4], 3), of(&[7, 3, 2, 1, 4, 1, 1, 0, 5], 3));
        let (one, other) = (one.scores(), other.scores());
        assert!((one.kappa.unwrap() - other.kappa.unwrap()).abs() < 1e-15);
        assert!((one.kappa_se.unwrap() - other.kappa_se.unwrap()).abs() < 1e-15);
        assert_eq!(one.macro_f1, other.macro_f1);
    }
}
