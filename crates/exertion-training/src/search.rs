//! The best C and gamma of a curve: a grid of exponents of ten, coarse first, then finer around the best
//! (thesis 3.3.2: 10^-10 to 10^10 by half exponents).

use rayon::prelude::*;

use crate::TrainingError;
use crate::cross_validation::{contiguous_blocks, hold_out};
use crate::regression::EpsilonSvr;

/// Steps of the exponents: the whole grid by the first, then around the best by the others.
const STEPS: [f64; 3] = [2.0, 1.0, 0.5];
/// What an error must fall by, once it has begun to fall, that a still larger C is tried.
const WORTH_GOING_ON: f64 = 0.999;
/// What an error must be of that of the smallest C that it has begun to fall.
const HAS_BEGUN: f64 = 0.98;

/// What is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Least and largest exponent of C.
    pub c: [f64; 2],
    /// Least and largest exponent of gamma.
    pub gamma: [f64; 2],
    /// Half the width of the tube, per cent.
    pub epsilon: f64,
    /// Contiguous blocks that are held out in turn.
    pub folds: usize,
}

impl Default for Grid {
    fn default() -> Self {
        Self { c: [-10.0, 10.0], gamma: [-10.0, 10.0], epsilon: 1.0, folds: 10 }
    }
}

/// The tolerance of a search, per cent: a tenth of what the tube forgives.
const SEARCH_TOLERANCE: f64 = 0.1;

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Best {
    /// Exponent of C.
    pub c: f64,
    /// Exponent of gamma.
    pub gamma: f64,
    /// Root of the mean squared error of the held-out rows, per cent.
    pub rmse: f64,
}

/// Error of a pair, and whether any of its regressions has a coefficient at C.
type Tried = (f64, bool);

impl Grid {
    /// Searches the pair that foretells held-out blocks best. Of equal errors the smaller C and gamma win.
    /// The rows of the grid are computed by all threads, with the same answer on any number of them.
    ///
    /// # Errors
    /// [`TrainingError`]: rows that cannot be learnt from, exponents out of range.
    pub fn search(
        &self,
        rows: &[&[f64]],
        targets: &[f64],
        curve: &'static str,
    ) -> Result<Best, TrainingError> {
        self.check()?;
        let tried = |c: f64, gamma: f64| self.tried(rows, targets, c, gamma);
        let coarse: Vec<Result<Option<Best>, TrainingError>> = exponents(self.gamma, STEPS[0])
            .into_par_iter()
            .map(|gamma| self.line(gamma, &tried))
            .collect();
        let mut best: Option<Best> = None;
        for found in coarse {
            best = better(best, found?);
        }
        let mut best = best.ok_or(TrainingError::NoPair { curve })?;
        for step in &STEPS[1..] {
            let around: Vec<(f64, f64)> = [-step, 0.0, *step]
                .into_iter()
                .flat_map(|c| [-step, 0.0, *step].map(|gamma| (best.c + c, best.gamma + gamma)))
                .filter(|pair| *pair != (best.c, best.gamma) && self.holds(*pair))
                .collect();
            let found: Vec<Option<Best>> = around
                .into_par_iter()
                .map(|(c, gamma)| {
                    let found = not_converged(tried(c, gamma))?;
                    Ok(found.map(|(rmse, _)| Best { c, gamma, rmse }))
                })
                .collect::<Result<_, TrainingError>>()?;
            let all = found.into_iter().fold(Some(best), better);
            best = all.unwrap_or(best);
        }
        Ok(best)
    }

    fn check(&self) -> Result<(), TrainingError> {
        for (setting, [least, most]) in [("C", self.c), ("gamma", self.gamma)] {
            // Beyond, numbers are no longer told apart.
            if !(-15.0..=15.0).contains(&least) || !(-15.0..=15.0).contains(&most) || least > most {
                let range = "whose exponent lies between -15 and 15, the smaller first";
                return Err(TrainingError::Setting { setting, value: least, range });
            }
        }
        if self.folds < 2 {
            let (setting, value) = ("folds", self.folds as f64);
            return Err(TrainingError::Setting { setting, value, range: "of 2 or more" });
        }
        Ok(())
    }

    fn holds(&self, (c, gamma): (f64, f64)) -> bool {
        (self.c[0]..=self.c[1]).contains(&c) && (self.gamma[0]..=self.gamma[1]).contains(&gamma)
    }

    /// The best C of a gamma, from the smallest on: until no coefficient lies at C, so that no larger one
    /// has another answer; until the error no longer falls; or until the solver does not arrive.
    fn line(
        &self,
        gamma: f64,
        tried: &(impl Fn(f64, f64) -> Result<Tried, TrainingError> + Sync),
    ) -> Result<Option<Best>, TrainingError> {
        let (mut best, mut first) = (None::<Best>, None);
        for c in exponents(self.c, STEPS[0]) {
            let Some((rmse, at_bound)) = not_converged(tried(c, gamma))? else { break };
            let begun = HAS_BEGUN * *first.get_or_insert(rmse);
            let least = best.map_or(f64::INFINITY, |own| own.rmse);
            best = better(best, Some(Best { c, gamma, rmse }));
            if !at_bound || (least < begun && rmse > WORTH_GOING_ON * least) {
                break;
            }
        }
        Ok(best)
    }

    fn tried(
        &self,
        rows: &[&[f64]],
        targets: &[f64],
        c: f64,
        gamma: f64,
    ) -> Result<Tried, TrainingError> {
        let svr = EpsilonSvr {
            c: 10f64.powf(c),
            gamma: 10f64.powf(gamma),
            epsilon: self.epsilon,
            tolerance: SEARCH_TOLERANCE,
        };
        let (mut squares, mut count, mut at_bound) = (0.0, 0, false);
        for block in contiguous_blocks(rows.len(), self.folds) {
            let out = hold_out(&svr, rows, targets, |row| block.contains(&row), true)?;
            squares += out.squares;
            count += out.rows;
            at_bound |= out.at_bound;
        }
        Ok(((squares / count as f64).sqrt(), at_bound))
    }
}

/// The better of two, the first where they are equal.
fn better(one: Option<Best>, other: Option<Best>) -> Option<Best> {
    match (one, other) {
        (Some(one), Some(other)) if other.rmse < one.rmse => Some(other),
        (None, other) => other,
        (one, _) => one,
    }
}

/// A pair that the solver does not arrive at is none; any other refusal is one.
fn not_converged<T>(outcome: Result<T, TrainingError>) -> Result<Option<T>, TrainingError> {
    match outcome {
        Ok(found) => Ok(Some(found)),
        Err(TrainingError::NotConverged { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Exponents from the least to the largest, both included.
fn exponents([least, most]: [f64; 2], step: f64) -> Vec<f64> {
    let count = ((most - least) / step + 1e-9).floor() as usize;
    let mut all: Vec<f64> = (0..=count).map(|k| least + step * k as f64).collect();
    if all.last().is_some_and(|last| most - last > 1e-9) {
        all.push(most);
    }
    all
}

#[cfg(test)]
mod tests {
    use mimique_test_support::Random;

    use super::*;

    #[test]
    fn both_ends_are_tried() {
        assert_eq!(exponents([-10.0, 10.0], 2.0).len(), 11);
        assert_eq!(exponents([-1.0, 2.0], 2.0), [-1.0, 1.0, 2.0]);
        assert_eq!(exponents([3.0, 3.0], 2.0), [3.0]);
    }

    #[test]
    fn the_search_finds_what_the_whole_grid_finds() {
        let mut random = Random::new(11);
        // A slow wave with noise: neither a constant nor every row by itself.
        let x: Vec<Vec<f64>> = (0..80).map(|i| vec![f64::from(i) * 0.1]).collect();
        let y: Vec<f64> =
            x.iter().map(|x| 40.0 + 25.0 * (1.3 * x[0]).sin() + 3.0 * random.normal()).collect();
        let rows: Vec<&[f64]> = x.iter().map(Vec::as_slice).collect();
        let grid = Grid { c: [-2.0, 3.0], gamma: [-3.0, 3.0], folds: 5, ..Grid::default() };
        let found = grid.search(&rows, &y, "wave").unwrap();
        let mut all = f64::INFINITY;
        for c in exponents(grid.c, 1.0) {
            for gamma in exponents(grid.gamma, 1.0) {
                all = all.min(grid.tried(&rows, &y, c, gamma).unwrap().0);
            }
        }
        assert!(found.rmse < 1.03 * all, "{found:?} instead of {all}");
        assert!((0.0..=3.0).contains(&found.c) && (-1.5..=2.5).contains(&found.gamma), "{found:?}");
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(one.install(|| grid.search(&rows, &y, "wave")).unwrap(), found);
    }

    #[test]
    fn grids_that_are_none_are_refused() {
        let rows: [&[f64]; 4] = [&[0.0], &[1.0], &[2.0], &[3.0]];
        for grid in [
            Grid { c: [2.0, 1.0], ..Grid::default() },
            Grid { gamma: [-40.0, 1.0], ..Grid::default() },
            Grid { folds: 1, ..Grid::default() },
        ] {
            let refused = grid.search(&rows, &[0.0; 4], "none");
            assert!(matches!(refused, Err(TrainingError::Setting { .. })), "{grid:?}");
        }
    }
}
