//! Bradley and Terry's model with Davidson's ties and a side bias: likelihood, derivatives, maximum.
//!
//! | symbol | code | what |
//! |---|---|---|
//! | w_i, sum 0 | `worth` | log worth of item i, k of them |
//! | s | `side` | how much more the left item is worth for being left |
//! | t | `tie` | log of Davidson's ν |
//! | θ | `Parameters` | w_1 ... w_(k-1), then s and t where they are fitted |
//!
//! P(left) : P(same) : P(right) = exp(w_l + s/2) : exp(t + (w_l + w_r)/2) : exp(w_r - s/2) (Bradley and Terry
//! 1952; Davidson 1970; Davidson and Beaver 1977). The last worth is minus the sum of the others.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::table::comparisons::Presentation;

/// Which parameters there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Model {
    /// Items.
    pub items: usize,
    /// Whether worths are fitted; without, all are 0.
    pub worths: bool,
    /// Whether a side bias is fitted.
    pub side: bool,
    /// Whether ties are possible answers.
    pub ties: bool,
}

/// Newton's steps, at most. The likelihood is concave, and halving keeps each a step up.
const STEPS: usize = 100;
/// A step below this, relative to the parameters, is rounding.
const SETTLED: f64 = 1e-12;

/// The parameters of a [`Model`] in the coordinates that are fitted.
pub(crate) type Parameters = DVector<f64>;

/// A presentation's probabilities and the four coordinates that it touches: the two items, side, tie.
struct Cell {
    /// P(left), P(same), P(right).
    p: [f64; 3],
    total: f64,
}

/// How an answer depends on w_left, w_right, s, t.
const SLOPES: [[f64; 4]; 3] = [[1.0, 0.0, 0.5, 0.0], [0.5, 0.5, 0.0, 1.0], [0.0, 1.0, -0.5, 0.0]];

impl Model {
    /// How many parameters are fitted.
    pub fn parameters(self) -> usize {
        self.fitted_worths() + usize::from(self.side) + usize::from(self.ties)
    }

    fn fitted_worths(self) -> usize {
        if self.worths { self.items - 1 } else { 0 }
    }

    /// Possible answers of a presentation.
    pub fn answers(self) -> usize {
        if self.ties { 3 } else { 2 }
    }

    /// All worths.
    pub fn worth(self, parameters: &Parameters) -> Vec<f64> {
        if !self.worths {
            return vec![0.0; self.items];
        }
        let fitted = &parameters.as_slice()[..self.items - 1];
        let mut worth = fitted.to_vec();
        worth.push(-fitted.iter().sum::<f64>());
        worth
    }

    /// The side bias; 0 where none is fitted.
    pub fn side_bias(self, parameters: &Parameters) -> f64 {
        if self.side { parameters[self.fitted_worths()] } else { 0.0 }
    }

    /// t; minus infinity where ties are not possible.
    pub fn tie(self, parameters: &Parameters) -> f64 {
        if self.ties { parameters[self.parameters() - 1] } else { f64::NEG_INFINITY }
    }

    /// The fitted parameters of the four coordinates of a presentation: places and factors. An item is
    /// one parameter, the last one minus all.
    pub fn places(self, left: usize, right: usize) -> [Place; 4] {
        let item = |item: usize| match self.worths {
            false => Place::None,
            true if item + 1 == self.items => Place::MinusAllWorths,
            true => Place::One(item),
        };
        let at = |fitted: bool, place: usize| if fitted { Place::One(place) } else { Place::None };
        let worths = self.fitted_worths();
        let (side, tie) = (at(self.side, worths), worths + usize::from(self.side));
        [item(left), item(right), side, at(self.ties, tie)]
    }

    /// The logarithms of P(left), P(same), P(right).
    pub fn ln_p(self, parameters: &Parameters, worth: &[f64], shown: (usize, usize)) -> [f64; 3] {
        let (left, right) = (worth[shown.0], worth[shown.1]);
        let (side, tie) = (self.side_bias(parameters), self.tie(parameters));
        let heights = [left + side / 2.0, tie + (left + right) / 2.0, right - side / 2.0];
        let most = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = heights.iter().map(|height| libm::exp(height - most)).sum();
        heights.map(|height| height - most - libm::log(sum))
    }

    /// Log likelihood of counts of answers.
    pub fn log_likelihood(self, parameters: &Parameters, shown: &[Presentation]) -> f64 {
        let worth = self.worth(parameters);
        let of = |shown: &Presentation| {
            let ln_p = self.ln_p(parameters, &worth, (shown.left, shown.right));
            let each = shown.counts.iter().zip(ln_p).filter(|(count, _)| **count > 0);
            each.map(|(count, ln_p)| *count as f64 * ln_p).sum::<f64>()
        };
        shown.iter().map(of).sum()
    }

    fn cell(self, parameters: &Parameters, worth: &[f64], shown: &Presentation) -> Cell {
        let p = self.ln_p(parameters, worth, (shown.left, shown.right)).map(libm::exp);
        Cell { p, total: shown.counts.iter().sum::<u64>() as f64 }
    }

    /// Score and Fisher information, which is minus the second derivatives.
    pub fn derivatives(
        self,
        parameters: &Parameters,
        shown: &[Presentation],
    ) -> (DVector<f64>, DMatrix<f64>) {
        let size = self.parameters();
        let worth = self.worth(parameters);
        let mut wide = Wide::new(self.items);
        for shown in shown {
            let cell = self.cell(parameters, &worth, shown);
            wide.add(self.items, shown, &cell);
        }
        let mut score = DVector::zeros(size);
        let mut information = DMatrix::zeros(size, size);
        let rows = self.wide_rows();
        for (i, row) in rows.iter().enumerate() {
            for &(a, x) in row {
                score[i] += x * wide.score[a];
            }
            for (j, column) in rows.iter().enumerate() {
                let mut sum = 0.0;
                for &(a, x) in row {
                    for &(b, y) in column {
                        sum += x * y * wide.information[a * wide.size + b];
                    }
                }
                information[(i, j)] = sum;
            }
        }
        (score, information)
    }

    /// Each fitted parameter as a sum of wide coordinates: items, then side, then tie.
    fn wide_rows(self) -> Vec<Vec<(usize, f64)>> {
        let last = self.items - 1;
        let mut rows: Vec<Vec<(usize, f64)>> =
            (0..self.fitted_worths()).map(|item| vec![(item, 1.0), (last, -1.0)]).collect();
        if self.side {
            rows.push(vec![(self.items, 1.0)]);
        }
        if self.ties {
            rows.push(vec![(self.items + 1, 1.0)]);
        }
        rows
    }

    /// The score of one answer: how its log probability depends on the parameters.
    pub fn score_of(
        self,
        parameters: &Parameters,
        worth: &[f64],
        shown: (usize, usize),
        answer: usize,
    ) -> [f64; 4] {
        let p = self.ln_p(parameters, worth, shown).map(libm::exp);
        let mean = mean_slope(&p);
        [0, 1, 2, 3].map(|c| SLOPES[answer][c] - mean[c])
    }

    /// Adds a vector in the four coordinates of a presentation to the fitted ones.
    pub fn scatter(self, shown: (usize, usize), values: [f64; 4], into: &mut [f64]) {
        for (place, value) in self.places(shown.0, shown.1).into_iter().zip(values) {
            match place {
                Place::None => {}
                Place::One(at) => into[at] += value,
                Place::MinusAllWorths => {
                    into[..self.items - 1].iter_mut().for_each(|own| *own -= value);
                }
            }
        }
    }

    /// Adds the penalty's share of the score (Firth 1993) and gives ln det of the information over 2, with
    /// `inverse` the inverse of the information: for each presentation, with x the slopes about their mean
    /// and q = x' I^-1 x, the sum of p x q, over 2.
    pub fn firth_score(
        self,
        parameters: &Parameters,
        shown: &[Presentation],
        inverse: &DMatrix<f64>,
    ) -> DVector<f64> {
        let worth = self.worth(parameters);
        let mut score = DVector::zeros(self.parameters());
        for shown in shown {
            let cell = self.cell(parameters, &worth, shown);
            let pair = (shown.left, shown.right);
            let mean = mean_slope(&cell.p);
            let mut sum = [0.0; 4];
            for (slopes, p) in SLOPES.iter().zip(cell.p) {
                let x: [f64; 4] = [0, 1, 2, 3].map(|c| slopes[c] - mean[c]);
                let mut own = DVector::zeros(self.parameters());
                self.scatter(pair, x, own.as_mut_slice());
                let q = (inverse * &own).dot(&own);
                for c in 0..4 {
                    sum[c] += 0.5 * cell.total * p * q * x[c];
                }
            }
            self.scatter(pair, sum, score.as_mut_slice());
        }
        score
    }

    /// Newton's method from a start; for answers that are not separated. Even where they are, the
    /// likelihood that it ends with is the least upper bound to within [`LEVEL`].
    pub fn maximise(self, start: &Parameters, shown: &[Presentation]) -> Maximum {
        let mut at = start.clone();
        let mut height = self.log_likelihood(&at, shown);
        for _ in 0..STEPS {
            let (score, information) = self.derivatives(&at, shown);
            let Some(factor) = Cholesky::new(information) else { break };
            let step = factor.solve(&score);
            let Some((next, next_height)) = self.uphill(&at, height, &step, shown) else { break };
            let (way, gained) = ((&next - &at).amax(), next_height - height);
            (at, height) = (next, next_height.max(height));
            if way <= SETTLED * (1.0 + at.amax()) || (gained < LEVEL && at.amax() > FAR) {
                break;
            }
        }
        Maximum { at, log_likelihood: height }
    }

    /// The whole step, or the largest of its halves that leads up. Near the maximum a step changes the
    /// likelihood by less than rounding: it is taken all the same.
    fn uphill(
        self,
        at: &Parameters,
        height: f64,
        step: &DVector<f64>,
        shown: &[Presentation],
    ) -> Option<(Parameters, f64)> {
        let mut share = 1.0;
        while share > 1e-6 {
            let next = at + share * step;
            let next_height = self.log_likelihood(&next, shown);
            if next_height >= height - 1e-12 * height.abs() {
                return Some((next, next_height));
            }
            share /= 2.0;
        }
        None
    }

    /// The factor of the information; none where it is not positive definite.
    pub fn factor(
        self,
        parameters: &Parameters,
        shown: &[Presentation],
    ) -> Option<Cholesky<f64, Dyn>> {
        Cholesky::new(self.derivatives(parameters, shown).1)
    }

    /// Standard errors of all worths, of a covariance of the fitted parameters.
    pub fn worth_errors(self, covariance: &DMatrix<f64>) -> Vec<f64> {
        let fitted = self.fitted_worths();
        let own = (0..fitted).map(|item| covariance[(item, item)]);
        let mut variances: Vec<f64> = own.collect();
        let all = covariance.view((0, 0), (fitted, fitted)).sum();
        variances.push(all);
        variances.iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }
}

/// Where the maximum may lie at infinity: beyond these parameters, a step that gains less than this is the
/// last.
const FAR: f64 = 15.0;
const LEVEL: f64 = 1e-9;

/// Where a search ended.
#[derive(Debug, Clone)]
pub(crate) struct Maximum {
    /// The parameters.
    pub at: Parameters,
    /// The log likelihood there.
    pub log_likelihood: f64,
}

/// Where a coordinate of a presentation is among the fitted parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Nowhere: it is fixed.
    None,
    /// A parameter.
    One(usize),
    /// Minus the sum of the fitted worths: the last item.
    MinusAllWorths,
}

fn mean_slope(p: &[f64; 3]) -> [f64; 4] {
    [0, 1, 2, 3].map(|c| (0..3).map(|answer| p[answer] * SLOPES[answer][c]).sum())
}

/// Score and information over all items, side and tie.
struct Wide {
    size: usize,
    score: Vec<f64>,
    information: Vec<f64>,
}

impl Wide {
    fn new(items: usize) -> Self {
        let size = items + 2;
        Self { size, score: vec![0.0; size], information: vec![0.0; size * size] }
    }

    fn add(&mut self, items: usize, shown: &Presentation, cell: &Cell) {
        let places = [shown.left, shown.right, items, items + 1];
        let mean = mean_slope(&cell.p);
        for (answer, slopes) in SLOPES.iter().enumerate() {
            let surprise = shown.counts[answer] as f64 - cell.total * cell.p[answer];
            let weight = cell.total * cell.p[answer];
            for c in 0..4 {
                self.score[places[c]] += surprise * slopes[c];
                let own = weight * (slopes[c] - mean[c]);
                for d in 0..4 {
                    self.information[places[c] * self.size + places[d]] +=
                        own * (slopes[d] - mean[d]);
                }
            }
        }
    }
}
