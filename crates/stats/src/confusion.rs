//! Confusion matrix of what was shown and what was answered, and agreement.

use serde::Serialize;

use crate::factor::{Factor, alphabetical};
use crate::outcome::{Labelled, Refusal};
use crate::proportion::{Proportion, proportion};
use crate::sample::complete_rows;

/// Result of [`confusion`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Confusion {
    /// Always `confusion`.
    pub test: &'static str,
    /// Trials.
    pub n: u64,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// All labels shown or answered.
    pub labels: Vec<String>,
    /// Trials by shown label, then answered label.
    pub matrix: Labelled<Labelled<u64>>,
    /// Share of right answers.
    pub accuracy: f64,
    /// Its Clopper-Pearson interval.
    pub accuracy_ci_clopper_pearson: [f64; 2],
    /// Its Wilson interval.
    pub accuracy_ci_wilson: [f64; 2],
    /// Cohen's kappa; none where chance alone gives perfect agreement.
    pub kappa: Option<f64>,
    /// Share of a shown label that was recognised; none if it was never shown.
    pub recall: Labelled<Option<f64>>,
    /// Its Wilson interval.
    pub recall_ci_wilson: Labelled<Option<[f64; 2]>>,
    /// Share of an answered label that was right; none if it was never answered.
    pub precision: Labelled<Option<f64>>,
}

impl Confusion {
    /// Trials in which `truth` was shown and `answer` given.
    pub fn count(&self, truth: &str, answer: &str) -> u64 {
        self.matrix.get(truth).and_then(|row| row.get(answer)).copied().unwrap_or(0)
    }

    /// Labels that were shown.
    pub fn shown(&self) -> Vec<&str> {
        self.matrix
            .iter()
            .filter(|(_, row)| row.iter().any(|(_, count)| *count > 0))
            .map(|(label, _)| label)
            .collect()
    }
}

/// Counts answers. Truths and answers need not have the same labels.
pub fn confusion(truth: &Factor, answer: &Factor) -> Result<Confusion, Refusal> {
    let complete = complete_rows(&[], &[truth, answer])?;
    let dropped = complete.dropped();
    let (truth, answer) = (complete.factor(truth), complete.factor(answer));
    let mut labels = truth.levels.clone();
    labels.extend(answer.levels.iter().filter(|level| !truth.levels.contains(level)).cloned());
    labels.sort_by(|a, b| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => a.total_cmp(&b),
        _ => alphabetical(a, b),
    });
    let place = |level: &str| labels.iter().position(|label| label == level).unwrap_or(0);
    let truth_place: Vec<usize> = truth.levels.iter().map(|level| place(level)).collect();
    let answer_place: Vec<usize> = answer.levels.iter().map(|level| place(level)).collect();
    let size = labels.len();
    let mut counts = vec![vec![0u64; size]; size];
    for (&shown, &answered) in truth.codes.iter().zip(&answer.codes) {
        counts[truth_place[shown as usize]][answer_place[answered as usize]] += 1;
    }
    let shown: Vec<u64> = counts.iter().map(|row| row.iter().sum()).collect();
    let answered: Vec<u64> = (0..size).map(|j| counts.iter().map(|row| row[j]).sum()).collect();
    let right: u64 = (0..size).map(|i| counts[i][i]).sum();
    let n: u64 = shown.iter().sum();
    let total = n as f64;
    let observed = right as f64 / total;
    let chance: f64 =
        shown.iter().zip(&answered).map(|(&s, &a)| s as f64 / total * (a as f64 / total)).sum();
    let recall: Vec<Proportion> = (0..size).map(|i| proportion(counts[i][i], shown[i])).collect();
    let accuracy = proportion(right, n);
    Ok(Confusion {
        test: "confusion",
        n,
        dropped,
        matrix: Labelled::zip(
            &labels,
            counts.iter().map(|row| Labelled::zip(&labels, row.iter().copied())),
        ),
        accuracy: observed,
        accuracy_ci_clopper_pearson: accuracy.clopper_pearson.unwrap_or([0.0, 1.0]),
        accuracy_ci_wilson: accuracy.wilson.unwrap_or([0.0, 1.0]),
        kappa: (chance < 1.0).then(|| (observed - chance) / (1.0 - chance)),
        recall: Labelled::zip(&labels, recall.iter().map(|share| share.proportion)),
        recall_ci_wilson: Labelled::zip(&labels, recall.iter().map(|share| share.wilson)),
        precision: Labelled::zip(
            &labels,
            (0..size).map(|i| (answered[i] > 0).then(|| counts[i][i] as f64 / answered[i] as f64)),
        ),
        labels,
    })
}
