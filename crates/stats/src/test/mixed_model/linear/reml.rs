//! The restricted likelihood of y = Xβ + Zu + ε, its gradient, and its maximum.
//!
//! Standard deviations of random effects are in units of the residual one: V = I + Z Λ Λ' Z', u = Λ b. With
//! M = I + Λ Z'Z Λ, V^-1 = I - Z Λ M^-1 Λ Z' and Λ Z' V^-1 = M^-1 Λ Z', so that all that is needed are solutions of the
//! system of random effects (Bates, Mächler, Bolker and Walker 2015).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::numerics::dot;
use crate::table::factor::Factor;
use crate::test::mixed_model::design::Layout;
use crate::test::mixed_model::effects::{Factored, Weights};
use crate::test::mixed_model::search::{Least, least};

/// Standard deviations below this are 0: their gradient is a difference of equal numbers.
const ZERO: f64 = 1e-7;
/// Where the search begins, in residual standard deviations.
const START: f64 = 0.5;

/// Responses and their columns, in the order in which the effects are solved.
pub(super) struct Data {
    layout: Layout,
    /// How many columns: fixed effects, the constant first, and the responses last.
    columns: usize,
    /// Z' of each.
    sums: Vec<Vec<f64>>,
    /// Inner products of all columns.
    products: DMatrix<f64>,
    rows: usize,
    /// The standard deviation and the sign of each term, in the order of the layout.
    slots: Vec<(usize, f64)>,
    /// How many standard deviations there are.
    deviations: usize,
    /// The standard deviation of each effect.
    deviation_of: Vec<usize>,
}

/// What the likelihood is made of at some standard deviations.
pub(super) struct Solved {
    /// Cholesky factor of X' V^-1 X.
    pub information: Cholesky<f64, Dyn>,
    pub coefficients: DVector<f64>,
    /// (y - Xβ)' V^-1 (y - Xβ).
    pub squares: f64,
    /// ln det V + ln det X' V^-1 X.
    ln_dets: f64,
    /// Λ Z' V^-1 of each column of X, and of y - Xβ.
    pub of_columns: Vec<Vec<f64>>,
    pub of_residuals: Vec<f64>,
    system: Factored,
}

/// A grouping of the answers with its random effects.
pub(super) struct RandomTerm<'g> {
    pub grouping: &'g Factor,
    /// Which standard deviation the effects have; groupings of the same one have effects in common.
    pub deviation: usize,
    /// What an effect adds to an answer: 1, or -1 of the second of two items.
    pub sign: f64,
}

impl Data {
    /// Of rows x columns of fixed effects (without the constant) and responses, in the order of the data.
    pub(super) fn new(
        random: &[RandomTerm<'_>],
        fixed: &[f64],
        columns: usize,
        response: &[f64],
    ) -> Self {
        let groupings: Vec<&Factor> = random.iter().map(|term| term.grouping).collect();
        let deviations: Vec<usize> = random.iter().map(|term| term.deviation).collect();
        let layout = Layout::of_effects(&groupings, &deviations, response.len());
        let of = |value: &dyn Fn(usize) -> f64| layout.rows.iter().map(|row| value(*row)).collect();
        let mut all: Vec<Vec<f64>> = vec![vec![1.0; response.len()]];
        all.extend((0..columns).map(|column| of(&|row| fixed[row * columns + column])));
        all.push(of(&|row| response[row]));
        let slots: Vec<(usize, f64)> =
            layout.terms.iter().map(|term| (random[*term].deviation, random[*term].sign)).collect();
        let mut deviation_of = vec![0; layout.size()];
        let mut sums = vec![vec![0.0; layout.size()]; all.len()];
        for place in 0..response.len() {
            for (effect, (deviation, sign)) in layout.effects(place).iter().zip(&slots) {
                deviation_of[*effect as usize] = *deviation;
                for (sums, column) in sums.iter_mut().zip(&all) {
                    sums[*effect as usize] += sign * column[place];
                }
            }
        }
        let products = DMatrix::from_fn(all.len(), all.len(), |i, j| dot(&all[i], &all[j]));
        Self {
            layout,
            columns: all.len(),
            sums,
            products,
            rows: response.len(),
            slots,
            deviations: deviations.iter().max().map_or(0, |most| most + 1),
            deviation_of,
        }
    }

    /// Columns of X.
    pub(super) fn fixed(&self) -> usize {
        self.columns - 1
    }

    /// Responses less columns.
    pub(super) fn residual_df(&self) -> usize {
        self.rows - self.fixed()
    }

    /// The parts of the likelihood; none where they cannot be computed.
    pub(super) fn solved(&self, sds: &[f64]) -> Option<Solved> {
        let mut system = Factored::of_equal_weights(&self.layout);
        let by_slot: Vec<f64> =
            self.slots.iter().map(|(deviation, sign)| sign * sds[*deviation]).collect();
        if !system.factor(&self.layout, &by_slot, Weights::One) {
            return None;
        }
        let scale: Vec<f64> = self.deviation_of.iter().map(|own| sds[*own]).collect();
        let scaled: Vec<Vec<f64>> = (self.sums.iter())
            .map(|sums| sums.iter().zip(&scale).map(|(sum, sd)| sum * sd).collect())
            .collect();
        let mut solved = scaled.clone();
        solved.iter_mut().for_each(|own| system.solve(&self.layout, own));
        let size = self.columns;
        let whole = DMatrix::from_fn(size, size, |i, j| {
            self.products[(i, j)] - dot(&scaled[i], &solved[j])
        });
        let fixed = self.fixed();
        let information = Cholesky::new(whole.view((0, 0), (fixed, fixed)).into_owned())?;
        let with_response = whole.view((0, fixed), (fixed, 1)).column(0).into_owned();
        let coefficients = information.solve(&with_response);
        let squares = whole[(fixed, fixed)] - coefficients.dot(&with_response);
        let mut of_residuals = solved.pop()?;
        for (own, coefficient) in solved.iter().zip(&coefficients) {
            of_residuals.iter_mut().zip(own).for_each(|(r, s)| *r -= coefficient * s);
        }
        let ln_dets = system.ln_det + information.ln_determinant();
        let of_columns = solved;
        let found = Solved {
            information,
            coefficients,
            squares,
            ln_dets,
            of_columns,
            of_residuals,
            system,
        };
        (found.squares > 0.0 && found.ln_dets.is_finite()).then_some(found)
    }

    /// For each standard deviation σ, the trace of P Z Z' σ² and the sum of squares of Λ Z' P y: its slope is made of these.
    /// P = V^-1 - V^-1 X (X' V^-1 X)^-1 X' V^-1.
    fn traces(&self, solved: &Solved) -> Vec<[f64; 2]> {
        let terms = &self.deviation_of;
        let mut found = vec![[0.0; 2]; self.deviations];
        let diagonal = solved.system.inverse_diagonal(&self.layout);
        for (effect, term) in terms.iter().enumerate() {
            found[*term][0] += 1.0 - diagonal[effect];
            found[*term][1] += solved.of_residuals[effect].powi(2);
        }
        let covariance = solved.information.inverse();
        let own = &solved.of_columns;
        for i in 0..own.len() {
            for j in 0..own.len() {
                let by = covariance[(i, j)];
                for (effect, term) in terms.iter().enumerate() {
                    found[*term][0] -= by * own[i][effect] * own[j][effect];
                }
            }
        }
        found
    }

    /// Half the restricted deviance at its best residual standard deviation, without constants, and its slopes.
    fn value(&self, sds: &[f64], gradient: &mut [f64]) -> f64 {
        let Some(solved) = self.solved(sds) else {
            gradient.fill(f64::NAN);
            return f64::INFINITY;
        };
        let df = self.residual_df() as f64;
        let slopes = self.slopes(sds, &solved, solved.squares / df);
        gradient.copy_from_slice(&slopes);
        0.5 * (solved.ln_dets + df * libm::log(solved.squares))
    }

    /// Slopes of half the restricted deviance by the standard deviations where the residual variance is `variance`.
    pub(super) fn slopes(&self, sds: &[f64], solved: &Solved, variance: f64) -> Vec<f64> {
        let traces = self.traces(solved);
        let slope = |([trace, squares], sd): (&[f64; 2], &f64)| match sd.abs() < ZERO {
            true => 0.0,
            false => (trace - squares / variance) / sd,
        };
        traces.iter().zip(sds).map(slope).collect()
    }

    /// Sums of squares by standard deviation of Λ Z' V^-1 X w for weights w of the coefficients.
    pub(super) fn squares_by_deviation(&self, solved: &Solved, weights: &DVector<f64>) -> Vec<f64> {
        let mut found = vec![0.0; self.deviations];
        for (effect, term) in self.deviation_of.iter().enumerate() {
            let own = solved.of_columns.iter().zip(weights);
            let own: f64 = own.map(|(column, weight)| weight * column[effect]).sum();
            found[*term] += own * own;
        }
        found
    }

    /// Where the restricted likelihood is highest.
    pub(super) fn fit(&self) -> Least {
        let start = vec![START; self.deviations];
        least(start, 0, |sds, gradient| self.value(sds, gradient))
    }

    /// The restricted deviance, -2 ln L, at a value of the search.
    pub(super) fn deviance(&self, value: f64) -> f64 {
        let df = self.residual_df() as f64;
        2.0 * value + df * (1.0 + libm::log(2.0 * std::f64::consts::PI / df))
    }
}
