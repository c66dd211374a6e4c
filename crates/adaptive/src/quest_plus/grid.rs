//! The grid of QUEST+: levels that may be shown, and values of the psychometric function's parameters.

use crate::psychometric::{Psychometric, Shape};

/// Cells of a grid, at most: so many are weighed at all levels within 20 ms on a slow tablet.
pub const MOST_CELLS: usize = 20_000;

/// The names of the parameters, in the order of [`Grid::values`].
pub const PARAMETERS: [&str; 4] = ["location", "spread", "guess", "lapse"];

/// The levels that may be shown, and the values that each parameter may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Form of the function.
    pub shape: Shape,
    /// Levels that may be shown, ascending.
    pub levels: Vec<f64>,
    /// Values of the four parameters: location, spread, guess, lapse.
    pub values: [Vec<f64>; 4],
    /// Weight of each value before the first answer; none: all alike.
    pub prior: [Option<Vec<f64>>; 4],
}

/// Why a grid cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// No level, or levels that do not ascend.
    #[error("levels must be finite numbers that ascend")]
    Levels,
    /// A parameter without a value, or one out of its range.
    #[error(
        "{parameter}: give finite values, spreads above 0, guess and lapse from 0 and together below 1"
    )]
    Values {
        /// Its name.
        parameter: &'static str,
    },
    /// Weights that are not as many as the values, negative, or all 0.
    #[error("{parameter}: give a weight from 0 for each value, one of them above 0")]
    Prior {
        /// Its name.
        parameter: &'static str,
    },
    /// More cells than are weighed in time.
    #[error("the grid has {cells} cells, at most {MOST_CELLS} are weighed in time")]
    TooManyCells {
        /// How many it has.
        cells: usize,
    },
}

impl Grid {
    fn sizes(&self) -> [usize; 4] {
        [0, 1, 2, 3].map(|parameter| self.values[parameter].len())
    }

    /// Cells: the product of the numbers of values.
    pub fn cells(&self) -> usize {
        self.sizes().iter().fold(1, |cells, size| cells.saturating_mul(*size))
    }

    /// The place of each parameter's value in a cell; lapse changes first.
    pub(super) fn places(&self, cell: usize) -> [usize; 4] {
        let [_, spreads, guesses, lapses] = self.sizes();
        let (rest, lapse) = (cell / lapses, cell % lapses);
        let (rest, guess) = (rest / guesses, rest % guesses);
        [rest / spreads, rest % spreads, guess, lapse]
    }

    pub(super) fn function(&self, cell: usize) -> Psychometric {
        let [location, spread, guess, lapse] = self.places(cell);
        Psychometric {
            shape: self.shape,
            location: self.values[0][location],
            spread: self.values[1][spread],
            guess: self.values[2][guess],
            lapse: self.values[3][lapse],
        }
    }

    /// Adds the probability of a right answer at a level in every cell. F is the same for all values of guess
    /// and lapse.
    pub(super) fn rights_at(&self, level: f64, all: &mut Vec<f64>) {
        let shared = self.values[2].len() * self.values[3].len();
        for first in (0..self.cells()).step_by(shared) {
            let Psychometric { shape, location, spread, .. } = self.function(first);
            let seen = shape.at(level, location, spread);
            for guess in &self.values[2] {
                all.extend(self.values[3].iter().map(|lapse| guess + (1.0 - guess - lapse) * seen));
            }
        }
    }

    pub(super) fn check(&self) -> Result<(), GridError> {
        let rises = |levels: &[f64]| levels.windows(2).all(|pair| pair[0] < pair[1]);
        if self.levels.is_empty()
            || !self.levels.iter().all(|level| level.is_finite())
            || !rises(&self.levels)
        {
            return Err(GridError::Levels);
        }
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(*value));
        let certain = most(&self.values[2]) + most(&self.values[3]);
        for (at, values) in self.values.iter().enumerate() {
            let parameter = PARAMETERS[at];
            let allowed = |value: f64| match at {
                0 => self.shape != Shape::Weibull || value > 0.0,
                1 => value > 0.0,
                _ => (0.0..1.0).contains(&value) && certain < 1.0,
            };
            if values.is_empty() || !values.iter().all(|v| v.is_finite() && allowed(*v)) {
                return Err(GridError::Values { parameter });
            }
            if let Some(prior) = &self.prior[at]
                && (prior.len() != values.len()
                    || !prior.iter().all(|weight| weight.is_finite() && *weight >= 0.0)
                    || prior.iter().all(|weight| *weight == 0.0))
            {
                return Err(GridError::Prior { parameter });
            }
        }
        let cells = self.cells();
        if cells > MOST_CELLS {
            return Err(GridError::TooManyCells { cells });
        }
        Ok(())
    }

    pub(super) fn before_answers(&self) -> Vec<f64> {
        let weight = |cell: usize| {
            let places = self.places(cell);
            let own = |at: usize| self.prior[at].as_ref().map_or(1.0, |prior| prior[places[at]]);
            own(0) * own(1) * own(2) * own(3)
        };
        let mut weights: Vec<f64> = (0..self.cells()).map(weight).collect();
        let all: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= all);
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::super::QuestPlus;
    use super::*;

    fn grid() -> Grid {
        Grid {
            shape: Shape::Normal,
            levels: vec![0.0, 0.5, 1.0],
            values: [vec![0.2, 0.6], vec![0.05, 0.1, 0.3], vec![0.5], vec![0.0, 0.02]],
            prior: [const { None }; 4],
        }
    }

    #[test]
    fn grids_that_cannot_be_are_refused() {
        let with = |change: &dyn Fn(&mut Grid)| {
            let mut grid = grid();
            change(&mut grid);
            QuestPlus::new(grid).unwrap_err()
        };
        assert_eq!(with(&|g| g.levels.clear()), GridError::Levels);
        assert_eq!(with(&|g| g.levels = vec![0.2, 0.1]), GridError::Levels);
        assert_eq!(with(&|g| g.levels = vec![f64::NAN]), GridError::Levels);
        for (at, wrong) in [(0, f64::NAN), (1, 0.0), (2, -0.1), (3, 0.6)] {
            let parameter = PARAMETERS[at];
            let error = with(&|g| g.values[at] = vec![wrong]);
            // Guess 0.5 and lapse 0.6 do not go together; the first of them is named.
            let named = if at == 3 { "guess" } else { parameter };
            assert_eq!(error, GridError::Values { parameter: named });
        }
        assert_eq!(with(&|g| g.values[1].clear()), GridError::Values { parameter: "spread" });
        let weibull = with(&|g| (g.shape, g.values[0]) = (Shape::Weibull, vec![0.0]));
        assert_eq!(weibull, GridError::Values { parameter: "location" });
        for prior in [vec![1.0], vec![0.0; 3], vec![1.0, -1.0, 1.0]] {
            let error = with(&|g| g.prior[1] = Some(prior.clone()));
            assert_eq!(error, GridError::Prior { parameter: "spread" });
        }
        let many: Vec<f64> = (0..4000).map(f64::from).collect();
        let error = with(&|g| g.values[0] = many.clone());
        assert_eq!(error, GridError::TooManyCells { cells: 24_000 });
    }
}
