//! The restricted likelihood of y = Xβ + Zu + ε, its gradient, and its maximum.
//!
//! Standard deviations of random effects are in units of the residual one: V = I + Z Λ Λ' Z', u = Λ b. With
//! M = I + Λ Z'Z Λ, V^-1 = I - Z Λ M^-1 Λ Z' and Λ Z' V^-1 = M^-1 Λ Z', so that all that is needed are solutions of the
//! system of random effects (Bates, Mächler, Bolker and Walker 2015).
//!
//! Of people who answered the same clips the likelihood needs only their sums and the products of their differences from
//! the mean, so that its cost grows with the number of designs, not of people.

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
    /// Blocks of one design merged into one.
    layout: Layout,
    /// How many columns: fixed effects, the constant first, and the responses last.
    columns: usize,
    /// Z' of each.
    sums: Vec<Vec<f64>>,
    /// Of the blocks that were merged, by the block's number.
    differences: Vec<Differences>,
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

/// Of blocks that were merged into one: for two columns i ≤ j, Σ (s_i - mean)(s_j - mean)' of their Z'. Pairs of columns that
/// do not differ between the blocks are left out.
struct Differences {
    block: usize,
    products: Vec<([usize; 2], DMatrix<f64>)>,
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
    /// Λ: the standard deviation of each effect.
    scale: Vec<f64>,
    system: Factored,
    /// B^-1 of each merged block, as in [`Data::differences`].
    of_differences: Vec<DMatrix<f64>>,
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
        let each = Layout::of_effects(&groupings, &deviations, response.len());
        let of = |value: &dyn Fn(usize) -> f64| each.rows.iter().map(|row| value(*row)).collect();
        let mut all: Vec<Vec<f64>> = vec![vec![1.0; response.len()]];
        all.extend((0..columns).map(|column| of(&|row| fixed[row * columns + column])));
        all.push(of(&|row| response[row]));
        let slots: Vec<(usize, f64)> =
            each.terms.iter().map(|term| (random[*term].deviation, random[*term].sign)).collect();
        let mut of_each = vec![vec![0.0; each.size()]; all.len()];
        for place in 0..response.len() {
            for (effect, (_, sign)) in each.effects(place).iter().zip(&slots) {
                for (sums, column) in of_each.iter_mut().zip(&all) {
                    sums[*effect as usize] += sign * column[place];
                }
            }
        }
        let (layout, members) = each.merged();
        let mut deviation_of = vec![0; layout.size()];
        for place in 0..layout.rows.len() {
            for (effect, (deviation, _)) in layout.effects(place).iter().zip(&slots) {
                deviation_of[*effect as usize] = *deviation;
            }
        }
        let sums = of_each.iter().map(|own| merged_sums(own, &each, &layout, &members)).collect();
        let differences = (members.iter().enumerate())
            .filter(|(_, same)| same.len() > 1)
            .map(|(block, same)| Differences::of(block, same, &each, &of_each))
            .collect();
        let products = DMatrix::from_fn(all.len(), all.len(), |i, j| dot(&all[i], &all[j]));
        Self {
            layout,
            columns: all.len(),
            sums,
            differences,
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
        let mut system = Factored::new(&self.layout);
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
        let mut whole = DMatrix::from_fn(size, size, |i, j| {
            self.products[(i, j)] - dot(&scaled[i], &solved[j])
        });
        let of_differences: Vec<DMatrix<f64>> = (self.differences.iter())
            .map(|own| {
                let size = self.layout.blocks[own.block].size;
                DMatrix::from_vec(size, size, system.block_inverse(&self.layout, own.block))
            })
            .collect();
        for (own, inverse) in self.differences.iter().zip(&of_differences) {
            let first = self.layout.blocks[own.block].first;
            let scale = DVector::from_column_slice(&scale[first..][..inverse.nrows()]);
            for ([i, j], products) in &own.products {
                let trace = scale.dot(&(products.component_mul(inverse) * &scale));
                whole[(*i, *j)] -= trace;
                if i != j {
                    whole[(*j, *i)] -= trace;
                }
            }
        }
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
            scale,
            system,
            of_differences,
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
        let fixed = self.fixed();
        // y - Xβ as weights of all columns.
        let residual = |i: usize| if i == fixed { 1.0 } else { -solved.coefficients[i] };
        let of_fixed = |i: usize, j: usize| if j < fixed { covariance[(i, j)] } else { 0.0 };
        for (own, inverse) in self.differences.iter().zip(&solved.of_differences) {
            let block = &self.layout.blocks[own.block];
            let others = block.count as f64 - 1.0;
            let squares = self.squares(own, inverse, solved, &|i, j| residual(i) * residual(j));
            let traces = self.squares(own, inverse, solved, &of_fixed);
            for i in 0..block.size {
                let term = terms[block.first + i];
                found[term][0] += others * (1.0 - inverse[(i, i)]) - traces[i];
                found[term][1] += squares[i];
            }
        }
        found
    }

    /// Of merged blocks, for each effect the sum of squares of B^-1 Λ d over their differences d, with `weight` for each two
    /// columns.
    fn squares(
        &self,
        own: &Differences,
        inverse: &DMatrix<f64>,
        solved: &Solved,
        weight: &dyn Fn(usize, usize) -> f64,
    ) -> Vec<f64> {
        let size = inverse.nrows();
        let scale = &solved.scale[self.layout.blocks[own.block].first..][..size];
        let mut all = DMatrix::zeros(size, size);
        let mut is_zero = true;
        for ([i, j], products) in &own.products {
            let by = if i == j { weight(*i, *j) } else { 2.0 * weight(*i, *j) };
            if by != 0.0 {
                is_zero = false;
                all.zip_apply(products, |sum, own| *sum += by * own);
            }
        }
        if is_zero {
            return vec![0.0; size];
        }
        for (column, by) in scale.iter().enumerate() {
            all.column_mut(column).iter_mut().zip(scale).for_each(|(own, sd)| *own *= by * sd);
        }
        let half = all * inverse;
        (0..size).map(|i| half.column(i).dot(&inverse.column(i))).collect()
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
        let weight = |i: usize| weights.get(i).copied().unwrap_or(0.0);
        for (own, inverse) in self.differences.iter().zip(&solved.of_differences) {
            let first = self.layout.blocks[own.block].first;
            let squares = self.squares(own, inverse, solved, &|i, j| weight(i) * weight(j));
            for (i, square) in squares.into_iter().enumerate() {
                found[self.deviation_of[first + i]] += square;
            }
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

/// Z' of a column in the merged layout: of blocks their sum divided by the root of their number.
fn merged_sums(own: &[f64], each: &Layout, merged: &Layout, members: &[Vec<usize>]) -> Vec<f64> {
    let mut sums = vec![0.0; merged.size()];
    for (block, same) in merged.blocks.iter().zip(members) {
        let sums = &mut sums[block.first..][..block.size];
        for number in same {
            let own = &own[each.blocks[*number].first..];
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        let root = (block.count as f64).sqrt();
        sums.iter_mut().for_each(|sum| *sum /= root);
    }
    sums[merged.in_blocks..].copy_from_slice(&own[each.in_blocks..]);
    sums
}

impl Differences {
    /// Of some blocks of a layout, from Z' of each column in it.
    fn of(block: usize, same: &[usize], each: &Layout, columns: &[Vec<f64>]) -> Self {
        let size = each.blocks[same[0]].size;
        // Effects x blocks.
        let differences: Vec<Option<DMatrix<f64>>> = (columns.iter())
            .map(|own| {
                let first = |number: usize| each.blocks[same[number]].first;
                let mut sums = DMatrix::from_fn(size, same.len(), |i, n| own[first(n) + i]);
                for mut row in sums.row_iter_mut() {
                    let mean = row.sum() / same.len() as f64;
                    row.add_scalar_mut(-mean);
                }
                sums.iter().any(|own| *own != 0.0).then_some(sums)
            })
            .collect();
        let mut products = Vec::new();
        for (j, right) in differences.iter().enumerate() {
            for (i, left) in differences[..=j].iter().enumerate() {
                if let (Some(left), Some(right)) = (left, right) {
                    let own = left * right.transpose();
                    products.push(([i, j], (&own + own.transpose()) / 2.0));
                }
            }
        }
        Self { block, products }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    /// Two groups of people over 3 segments x 2 methods, some of whom miss a clip: columns for method and group, and
    /// effects of people, of people with methods, of segments and of clips.
    fn planted() -> ([Factor; 4], Vec<f64>, Vec<f64>) {
        let mut random = Random::new(11);
        let mut codes = [const { Vec::new() }; 4];
        let (mut fixed, mut response) = (Vec::new(), Vec::new());
        for person in 0..9_u32 {
            for (segment, method) in (0..3).flat_map(|s| (0..2).map(move |m| (s, m))) {
                if person > 5 && (segment + person + method) % 5 == 0 {
                    continue;
                }
                let own = [person, person * 2 + method, segment, segment * 2 + method];
                codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
                fixed.extend([f64::from(method), f64::from(person % 2)]);
                response.push(f64::from(person % 3) + random.normal());
            }
        }
        let factors = codes.map(|codes| {
            let levels = (0..18).map(|level: u32| level.to_string()).collect();
            Factor { name: String::new(), levels, codes }.used()
        });
        (factors, fixed, response)
    }

    #[test]
    fn likelihood_and_slopes_agree_with_those_of_the_dense_covariance() {
        let (factors, fixed, response) = planted();
        let random: Vec<RandomTerm<'_>> = (factors.iter().enumerate())
            .map(|(deviation, grouping)| RandomTerm { grouping, deviation, sign: 1.0 })
            .collect();
        let data = Data::new(&random, &fixed, 2, &response);
        assert!(data.differences.iter().any(|own| own.products.len() > 1), "groups differ");
        let n = response.len();
        let x = DMatrix::from_fn(n, 3, |i, j| if j == 0 { 1.0 } else { fixed[2 * i + j - 1] });
        let y = DVector::from_column_slice(&response);
        let dense = |sds: &[f64]| {
            let v = DMatrix::from_fn(n, n, |i, j| {
                let shared = |(own, sd): (&Factor, &f64)| match own.codes[i] == own.codes[j] {
                    true => sd * sd,
                    false => 0.0,
                };
                let residual = if i == j { 1.0 } else { 0.0 };
                residual + factors.iter().zip(sds).map(shared).sum::<f64>()
            });
            let inverse = v.clone().try_inverse().unwrap();
            let information = x.transpose() * &inverse * &x;
            let coefficients =
                information.clone().try_inverse().unwrap() * x.transpose() * &inverse * &y;
            let left = &y - &x * &coefficients;
            let squares = (left.transpose() * &inverse * &left)[0];
            let ln_dets = v.determinant().ln() + information.determinant().ln();
            (0.5 * (ln_dets + data.residual_df() as f64 * squares.ln()), coefficients, squares)
        };
        let sds = [0.8, 0.4, 0.6, 0.3];
        let mut gradient = [0.0; 4];
        let value = data.value(&sds, &mut gradient);
        let (expected, coefficients, squares) = dense(&sds);
        assert!((value - expected).abs() < 1e-10, "{value}, {expected}");
        let solved = data.solved(&sds).unwrap();
        assert!((&solved.coefficients - coefficients).amax() < 1e-10);
        assert!((solved.squares - squares).abs() < 1e-9);
        for (place, own) in gradient.iter().enumerate() {
            let side = |by: f64| {
                let mut at = sds;
                at[place] += by;
                dense(&at).0
            };
            let slope = (side(1e-5) - side(-1e-5)) / 2e-5;
            assert!((own - slope).abs() < 1e-7 * slope.abs().max(1.0), "{place}: {own}, {slope}");
        }
        // The variance of a contrast changes by the deviations as `squares_by_deviation` says.
        let contrast = DVector::from_column_slice(&[0.3, -1.0, 0.7]);
        let weights = solved.information.solve(&contrast);
        for (place, own) in data.squares_by_deviation(&solved, &weights).into_iter().enumerate() {
            let side = |by: f64| {
                let mut at = sds;
                at[place] += by;
                contrast.dot(&data.solved(&at).unwrap().information.solve(&contrast))
            };
            let slope = (side(1e-5) - side(-1e-5)) / 2e-5;
            assert!((2.0 * own / sds[place] - slope).abs() < 1e-7, "{place}: {own}, {slope}");
        }
    }
}
