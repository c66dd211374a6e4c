//! A random forest (Breiman, Machine Learning 2001): trees on bootstrap samples of the rows.

use mimique_stats::Stream;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::{as_many, at_most};
use crate::numbers::highest;
use crate::{AnnotateError, Examples, Rows, Tree};

/// Rows that go through a tree together.
const BLOCK: usize = 256;

/// What the user decides of a forest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ForestOptions {
    /// Trees.
    pub trees: usize,
    /// Columns drawn at a node; the whole part of the root of their number where not given.
    pub columns: Option<usize>,
    /// Seed of every drawing.
    pub seed: u64,
}

impl Default for ForestOptions {
    fn default() -> Self {
        Self { trees: 200, columns: None, seed: 1 }
    }
}

/// A forest that has learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Forest {
    width: usize,
    count: usize,
    trees: Vec<Tree>,
    out_of_bag: Option<f64>,
}

impl Forest {
    /// Learn. Each tree has a ChaCha stream of its own: the same forest on any number of threads.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`] for 0 trees or columns, [`AnnotateError::Limit`] above 200,000
    /// rows or 10,000 trees.
    pub fn fit(examples: &Examples, options: &ForestOptions) -> Result<Self, AnnotateError> {
        let n = examples.rows().len();
        let width = examples.rows().width();
        at_most("training rows", n, 200_000)?;
        at_most("trees", options.trees, 10_000)?;
        let columns = options.columns.unwrap_or_else(|| width.isqrt());
        for (setting, value) in [("trees", options.trees), ("columns", columns)] {
            crate::error::above_zero(setting, value as f64)?;
        }
        // A tree, and what it says of the rows that it has not seen.
        let grown: Vec<(Tree, Vec<usize>)> = (0..options.trees)
            .into_par_iter()
            .map(|number| {
                let mut stream = Stream::new(options.seed, number as u64);
                let rows: Vec<usize> = (0..n).map(|_| stream.below(n)).collect();
                let mut seen = vec![false; n];
                rows.iter().for_each(|&row| seen[row] = true);
                let unseen = (0..n).filter(|&row| !seen[row]).collect();
                (Tree::grow(examples, rows, columns.min(width), stream), unseen)
            })
            .collect();
        let out_of_bag = out_of_bag(examples, &grown);
        let trees = grown.into_iter().map(|(tree, _)| tree).collect();
        Ok(Self { width, count: examples.count(), trees, out_of_bag })
    }

    /// The probability of each label: the mean over the trees of the leaf's shares.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the row has another width.
    pub fn probabilities(&self, row: &[f64]) -> Result<Vec<f64>, AnnotateError> {
        as_many("columns", row.len(), self.width)?;
        let mut sum = vec![0.0; self.count];
        self.trees.iter().for_each(|tree| tree.add_shares(row, &mut sum));
        sum.iter_mut().for_each(|s| *s /= self.trees.len() as f64);
        Ok(sum)
    }

    /// The same of every row of a table, a row after the other: tree by tree, which takes less time.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the rows have another width.
    pub fn probabilities_of(&self, rows: &Rows) -> Result<Vec<f64>, AnnotateError> {
        as_many("columns", rows.width(), self.width)?;
        let mut sums = vec![0.0; rows.len() * self.count];
        let blocks = sums.par_chunks_mut(BLOCK * self.count);
        blocks.zip(rows.values().par_chunks(BLOCK * self.width)).for_each(|(sums, rows)| {
            for tree in &self.trees {
                tree.add_shares_of(rows, self.width, sums, self.count);
            }
            sums.iter_mut().for_each(|s| *s /= self.trees.len() as f64);
        });
        Ok(sums)
    }

    /// How many labels there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The trees.
    pub fn trees(&self) -> &[Tree] {
        &self.trees
    }

    /// Share of the training rows that the trees which have not seen them label rightly; none when
    /// every tree has seen every row.
    pub fn out_of_bag(&self) -> Option<f64> {
        self.out_of_bag
    }

    /// Columns of a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether what was read is a forest of that many labels.
    pub(crate) fn fits(&self, labels: usize) -> bool {
        let trees = || self.trees.iter().all(|tree| tree.fits(self.width, self.count));
        self.count == labels && !self.trees.is_empty() && trees()
    }
}

fn out_of_bag(examples: &Examples, grown: &[(Tree, Vec<usize>)]) -> Option<f64> {
    let count = examples.count();
    let mut sums = vec![0.0; examples.rows().len() * count];
    for (tree, unseen) in grown {
        for &row in unseen {
            tree.add_shares(examples.rows().row(row), &mut sums[row * count..(row + 1) * count]);
        }
    }
    let (mut right, mut all) = (0usize, 0usize);
    for (sum, &label) in sums.chunks_exact(count).zip(examples.labels()) {
        if sum.iter().any(|&s| s > 0.0) {
            all += 1;
            right += usize::from(highest(sum) == label);
        }
    }
    (all > 0).then(|| right as f64 / all as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn rings() -> Examples {
        let mut random = Random::new(11);
        let points: Vec<[f64; 2]> = (0..200).map(|_| [random.normal(), random.normal()]).collect();
        let labels = points.iter().map(|p| usize::from(p[0] * p[0] + p[1] * p[1] > 1.2)).collect();
        Examples::new(Rows::new(points.as_flattened().to_vec(), 2).unwrap(), labels, 2).unwrap()
    }

    #[test]
    fn the_same_forest_grows_on_one_thread_and_on_four_and_another_of_another_seed() {
        let examples = rings();
        let options = ForestOptions { trees: 20, ..ForestOptions::default() };
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Forest::fit(&examples, &options).unwrap())
        };
        assert_eq!(on(1), on(4));
        let other = Forest::fit(&examples, &ForestOptions { seed: 2, ..options }).unwrap();
        assert_ne!(on(1), other);
    }

    #[test]
    fn a_planted_ring_is_learnt_and_units_do_not_matter() {
        let examples = rings();
        let forest = Forest::fit(&examples, &ForestOptions::default()).unwrap();
        assert!(forest.out_of_bag().unwrap() > 0.9);
        // Powers of two scale every threshold without rounding.
        let scaled = examples.rows().values().iter().map(|v| v * 1024.0).collect();
        let scaled = Rows::new(scaled, 2).unwrap();
        let labels = examples.labels().to_vec();
        let scaled = Examples::new(scaled, labels, 2).unwrap();
        let larger = Forest::fit(&scaled, &ForestOptions::default()).unwrap();
        for point in [[0.1, 0.2], [2.0, -1.0], [0.9, 0.5]] {
            let one = forest.probabilities(&point).unwrap();
            let table = Rows::new(point.repeat(300), 2).unwrap();
            assert_eq!(forest.probabilities_of(&table).unwrap(), one.repeat(300));
            assert_eq!(one, larger.probabilities(&point.map(|p| p * 1024.0)).unwrap());
            assert!((one.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}
