//! The support vector machine of several labels: one machine a pair of labels, which vote.

use mimique_stats::{KernelMatrix, SupportVectorDual};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::{above_zero, as_many, at_most};
use crate::numbers::highest;
use crate::{AnnotateError, ClassWeight, Examples, Kernel, Rows};

/// What the user decides of a support vector machine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SvmOptions {
    /// How alike rows are.
    pub kernel: Kernel,
    /// Price of a row on the wrong side of its margin.
    pub c: f64,
    /// How much the rows of each label count.
    pub class_weight: ClassWeight,
    /// How far the optimality conditions may be violated.
    pub tolerance: f64,
}

impl Default for SvmOptions {
    fn default() -> Self {
        let kernel = Kernel::Rbf { gamma: 0.2 };
        Self { kernel, c: 1.0, class_weight: ClassWeight::Even, tolerance: 1e-5 }
    }
}

/// The machine of a pair of labels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// The two labels; a positive decision votes for the first.
    pub labels: [usize; 2],
    /// Added to the sum.
    pub bias: f64,
    /// 1/2 a'Qa - sum a at the optimum.
    pub objective: f64,
    /// Which support vector, and its coefficient y a.
    coefficients: Vec<(usize, f64)>,
}

/// A support vector machine of several labels. Its support vectors are people's frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Svm {
    kernel: Kernel,
    count: usize,
    vectors: Rows,
    pairs: Vec<Pair>,
}

impl Svm {
    /// Learn: labels without rows take part in no pair.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`], [`AnnotateError::Limit`] above 20,000 rows,
    /// [`AnnotateError::NotConverged`].
    pub fn fit(examples: &Examples, options: &SvmOptions) -> Result<Self, AnnotateError> {
        above_zero("C", options.c)?;
        above_zero("tolerance", options.tolerance)?;
        if let Kernel::Rbf { gamma } = options.kernel {
            above_zero("gamma", gamma)?;
        }
        at_most("training rows", examples.rows().len(), 20_000)?;
        let present: Vec<usize> =
            examples.sizes().iter().zip(0..).filter(|(n, _)| **n > 0).map(|(_, l)| l).collect();
        let weights = options.class_weight.of(examples);
        let all: Vec<[usize; 2]> = (0..present.len())
            .flat_map(|i| (i + 1..present.len()).map(move |j| (i, j)))
            .map(|(i, j)| [present[i], present[j]])
            .collect();
        let mut pairs = all
            .par_iter()
            .map(|labels| fit_pair(examples, *labels, &weights, options))
            .collect::<Result<Vec<Pair>, AnnotateError>>()?;
        // Rows that support some pair are kept once.
        let mut place = vec![usize::MAX; examples.rows().len()];
        let used = || pairs.iter().flat_map(|pair| pair.coefficients.iter().map(|c| c.0));
        let mut kept: Vec<usize> = used().collect();
        kept.sort_unstable();
        kept.dedup();
        kept.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        let places = pairs.iter_mut().flat_map(|pair| &mut pair.coefficients);
        places.for_each(|(row, _)| *row = place[*row]);
        let vectors = examples.rows().select(kept);
        Ok(Self { kernel: options.kernel, count: examples.count(), vectors, pairs })
    }

    /// How many labels there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The machines, by first label, then second.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The decision of each pair on a row.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the row has another width.
    pub fn decisions(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        as_many("columns", row.len(), self.vectors.width())?;
        let mut kernels = vec![0.0; self.vectors.len()];
        self.kernel.of_all(self.vectors.values(), row, &mut kernels);
        let sum = |pair: &Pair| pair.coefficients.iter().map(|&(v, a)| a * kernels[v]).sum::<f64>();
        Ok(self.pairs.iter().map(|pair| sum(pair) + pair.bias).collect())
    }

    /// The label of a row: most votes, of several the lowest (LIBSVM).
    ///
    /// # Errors
    /// As [`Svm::decisions`].
    pub fn label(&self, row: &[f64]) -> Result<usize, AnnotateError> {
        Ok(highest(&self.votes(&self.decisions(row)?)))
    }

    fn votes(&self, decisions: &[f64]) -> Vec<f64> {
        let mut votes = vec![0.0; self.count];
        for (pair, &decision) in self.pairs.iter().zip(decisions) {
            votes[pair.labels[usize::from(decision <= 0.0)]] += 1.0;
        }
        votes
    }

    /// A score a label: votes, and between equals how clear the decisions are, s / (3 (|s| + 1)) of
    /// their signed sum s (as scikit-learn's `_ovr_decision_function`). A temperature makes
    /// probabilities of them.
    ///
    /// # Errors
    /// As [`Svm::decisions`].
    pub fn scores(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        let decisions = self.decisions(row)?;
        let mut clear = vec![0.0; self.count];
        for (pair, decision) in self.pairs.iter().zip(&decisions) {
            clear[pair.labels[0]] += decision;
            clear[pair.labels[1]] -= decision;
        }
        let scores = self.votes(&decisions).into_iter().zip(clear);
        Ok(scores.map(|(votes, s)| votes + s / (3.0 * (s.abs() + 1.0))).collect())
    }

    /// The label that [`Svm::label`] gives, of the scores of a row: they are within 1/3 of the votes.
    pub(crate) fn label_of_scores(scores: &[f64]) -> usize {
        highest(&scores.iter().map(|score| score.round()).collect::<Vec<f64>>())
    }

    /// Whether what was read is a classifier of that many labels.
    pub(crate) fn fits(&self, labels: usize) -> bool {
        let pair = |pair: &Pair| {
            let vectors = pair.coefficients.iter().all(|&(v, _)| v < self.vectors.len());
            vectors && pair.labels.iter().all(|&label| label < labels)
        };
        self.count == labels && self.pairs.iter().all(pair)
    }

    /// Columns of a row.
    pub fn width(&self) -> usize {
        self.vectors.width()
    }
}

fn fit_pair(
    examples: &Examples,
    labels: [usize; 2],
    weights: &[f64],
    options: &SvmOptions,
) -> Result<Pair, AnnotateError> {
    let of = |row: &usize| labels.contains(&examples.labels()[*row]);
    let members: Vec<usize> = (0..examples.labels().len()).filter(of).collect();
    let own: Vec<usize> = members.iter().map(|&row| examples.labels()[row]).collect();
    let rows = examples.rows().select(members.iter().copied());
    let sign = own.iter().map(|&label| if label == labels[0] { 1.0 } else { -1.0 }).collect();
    let bound = own.iter().map(|&label| options.c * weights[label]).collect();
    let matrix = kernel_matrix(&rows, options.kernel);
    let optimum = SupportVectorDual::classification(matrix, sign, bound, options.tolerance).solve();
    if !optimum.converged {
        let (steps, residual) = (optimum.steps, optimum.violation);
        return Err(AnnotateError::NotConverged { method: "svm", steps, residual });
    }
    let coefficients = members.into_iter().zip(optimum.coefficients).filter(|(_, a)| *a != 0.0);
    Ok(Pair {
        labels,
        bias: optimum.bias,
        objective: optimum.objective,
        coefficients: coefficients.collect(),
    })
}

/// The kernels of all pairs of rows, computed when the solver asks for them.
fn kernel_matrix(rows: &Rows, kernel: Kernel) -> KernelMatrix<impl Fn(usize, &mut [f64])> {
    let values = rows.values();
    let of = move |i: usize| &values[i * rows.width()..(i + 1) * rows.width()];
    let own = |i: usize| {
        let mut own = [0.0];
        kernel.of_all(of(i), of(i), &mut own);
        own[0]
    };
    let row = move |i: usize, out: &mut [f64]| kernel.of_all(values, of(i), out);
    KernelMatrix { diagonal: (0..rows.len()).map(own).collect(), row }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    #[test]
    fn scores_tell_the_label_that_the_votes_give() {
        let mut random = Random::new(12);
        let labels: Vec<usize> = (0..90).map(|i| i % 5).collect();
        let values = labels.iter().flat_map(|&l| {
            [(l as f64 * 1.3).sin(), (l as f64 * 1.3).cos()].map(|c| c + 1.5 * random.normal())
        });
        let rows = Rows::new(values.collect(), 2).unwrap();
        let examples = Examples::new(rows, labels, 5).unwrap();
        let mut tied = 0;
        for kernel in [Kernel::Linear, Kernel::Rbf { gamma: 0.2 }] {
            let svm = Svm::fit(&examples, &SvmOptions { kernel, ..SvmOptions::default() }).unwrap();
            for step in 0..1000 {
                let row = [f64::from(step % 40) / 10.0 - 2.0, f64::from(step / 40) / 6.0 - 2.0];
                let votes = svm.votes(&svm.decisions(&row).unwrap());
                let most = votes.iter().copied().fold(0.0, f64::max);
                tied += usize::from(votes.iter().filter(|v| **v == most).count() > 1);
                let scores = svm.scores(&row).unwrap();
                assert_eq!(Svm::label_of_scores(&scores), svm.label(&row).unwrap());
            }
        }
        assert!(tied > 0, "no tie was tried");
    }
}
