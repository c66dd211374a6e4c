//! Mixed models of ratings: P(y <= j) = logistic(θ_j - xβ - u), with independent normal effects u of people, of
//! people with each method, of segments and of clips (or of any other groupings), by Laplace's approximation, as
//! R's `ordinal::clmm` (Christensen 2022). Of two categories it is the binomial model of `lme4::glmer` with nAGQ = 1.
//!
//! A clip is a segment by a method. Without effects of clips nothing is said of other clips; without effects of
//! people with each method their taste counts as evidence (PSYCHOPHYSICS.md, f).

mod cumulative;
mod design;
mod effects;
mod laplace;
pub(crate) mod linear;
mod procedure;
mod result;
mod search;
mod shares;
#[cfg(test)]
mod tests;

use nalgebra::DMatrix;

use crate::adjust::Adjustment;
use crate::distributions::tail::{
    Alternative, Tail, chi_square_upper, normal_quantile_upper, normal_tail,
};
use crate::outcome::{Labelled, Outcome};
use crate::refusal::{Refusal, Unfit};
use crate::table::Numbers;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::test::bradley_terry::LikelihoodRatio;
use crate::undefined::{NoEstimate, Undefined};
use design::{Fixed, FixedTerm, Layout, is_part};
use laplace::Data;
pub(crate) use procedure::PROCEDURE;
pub use result::{
    MixedCoefficient, MixedEffectRatio, MixedGroupingRatio, MixedModel, MixedPair, MixedShares,
};
use search::{Fit, covariance, fit};

/// Levels that a grouping needs: of fewer the spread is not estimated.
pub const MIXED_MODEL_LEVELS: usize = 5;
/// Most different ratings: a threshold is estimated between every two.
pub const MIXED_MODEL_CATEGORIES: usize = 25;

/// What else is fitted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MixedModelOptions {
    /// With all interactions of the factors.
    pub interactions: bool,
    /// The model without its last grouping beside it.
    pub ratio_of_last: bool,
}

/// A model's columns, rows whole.
struct Columns {
    rating: Vec<f64>,
    factors: Vec<Factor>,
    groupings: Vec<Factor>,
}

/// Fits ratings to factors (all seen by their first level) with independent effects of groupings. The effect that is
/// tested is the first factor, or with interactions that of all factors.
///
/// Refuses factors with one level, groupings with fewer than [`MIXED_MODEL_LEVELS`], more than
/// [`MIXED_MODEL_CATEGORIES`] different ratings. Undefined where all ratings are equal, where the answers do not
/// determine the estimates, and where the search for the maximum did not converge: then there is no p.
pub fn mixed_model(
    rating: &Numbers,
    factors: &[&Factor],
    groupings: &[&Factor],
    options: MixedModelOptions,
) -> Result<Outcome<MixedModel>, Refusal> {
    let all: Vec<&Factor> = factors.iter().chain(groupings).copied().collect();
    let complete = complete_rows(&[rating], &all)?;
    let rows = complete.to_vec();
    let of = |factors: &[&Factor]| factors.iter().map(|factor| factor.rows(&rows)).collect();
    let rating_name = &rating.name;
    let columns = Columns {
        rating: complete.numbers(rating).into_owned(),
        factors: of(factors),
        groupings: of(groupings),
    };
    if columns.factors.is_empty() {
        return Err(Refusal::NoColumns);
    }
    columns.factors.iter().try_for_each(|factor| factor.require_levels(2))?;
    columns.groupings.iter().try_for_each(|factor| factor.require_levels(MIXED_MODEL_LEVELS))?;
    let steps = distinct(&columns.rating);
    if let [value] = steps[..] {
        let column = rating_name.clone();
        return Ok(Outcome::undefined(Undefined::EqualValues { column, n: rows.len(), value }));
    }
    if steps.len() > MIXED_MODEL_CATEGORIES {
        return Err(Unfit::TooManyRatings {
            column: rating_name.clone(),
            ratings: steps.len(),
            most: MIXED_MODEL_CATEGORIES,
        }
        .into());
    }
    let (kept, left_out) = apart(&columns.groupings);
    let terms = terms(&columns.factors, options.interactions);
    let tested = if options.interactions { terms.len() - 1 } else { 0 };
    let without: Vec<FixedTerm> =
        (0..terms.len()).filter(|term| *term != tested).map(|term| terms[term].clone()).collect();
    let data = |terms: &[FixedTerm], groupings: &[&Factor]| {
        columns.data(&steps, &Fixed::of(&columns.factors, terms, rows.len()), groupings)
    };
    let whole = data(&terms, &kept);
    if !determined(&whole.fixed, whole.columns) {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    }
    let found = match converged(&whole) {
        Ok(found) => found,
        Err(why) => return Ok(Outcome::undefined(why)),
    };
    let Some(covariance) = covariance(&whole, &found) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let names = Fixed::of(&columns.factors, &terms, 0).names;
    // Where the likelihood rises for ever, the search ends far out, where it hardly rises any more.
    let far = |place: &usize| {
        let size = found.coefficients[*place].abs();
        size > 10.0 && covariance[(*place, *place)].sqrt() > size
    };
    if let Some(place) = (0..names.len()).find(far) {
        let name = names[place].clone();
        return Ok(Outcome::undefined(NoEstimate::NoFiniteCoefficient { name }));
    }
    let reduced = match converged(&data(&without, &kept)) {
        Ok(reduced) => reduced,
        Err(why) => return Ok(Outcome::undefined(why)),
    };
    let lr_last = match kept.split_last() {
        Some((last, others)) if options.ratio_of_last => match converged(&data(&terms, others)) {
            Ok(fit) => Some(ratio_of(&last.name, &found, &fit)),
            Err(why) => return Ok(Outcome::undefined(why)),
        },
        _ => None,
    };
    let words = |terms: &[FixedTerm]| formula(&columns.factors, terms);
    let groups = kept.iter().map(|grouping| format!(" + (1 | {})", grouping.name));
    let formula = format!("{rating_name} ~ {}{}", words(&terms), groups.collect::<String>());
    let df = found.coefficients.len() - reduced.coefficients.len();
    let pairs = match columns.factors.as_slice() {
        [factor] => pairs(factor, &found.coefficients, &covariance),
        _ => Vec::new(),
    };
    let shares = match columns.factors.as_slice() {
        [factor] => shares::of_levels(factor, &columns.rating, &steps, &found),
        _ => Labelled(Vec::new()),
    };
    let sds = kept.iter().zip(&found.sds);
    let at_zero = sds.filter(|(_, sd)| **sd == 0.0).map(|(of, _)| of.name.clone()).collect();
    let kept_names: Vec<String> = kept.iter().map(|grouping| grouping.name.clone()).collect();
    let thresholds: Vec<String> =
        steps.windows(2).map(|pair| format!("{}|{}", pair[0], pair[1])).collect();
    Ok(Outcome::Ok(MixedModel {
        test: "mixed-model",
        variant: if steps.len() == 2 { "binomial" } else { "cumulative logit" },
        formula,
        observations: rows.len(),
        dropped: complete.dropped(),
        thresholds: Labelled::zip(&thresholds, found.thresholds.iter().copied()),
        shares,
        coefficients: Labelled::zip(
            &names,
            found.coefficients.iter().enumerate().map(|(place, estimate)| {
                let se = covariance[(place, place)].sqrt();
                let z = estimate / se;
                let p = normal_tail(z, Alternative::TwoSided).p;
                MixedCoefficient { estimate: *estimate, se, z, p }
            }),
        ),
        pairs,
        sd: Labelled::zip(&kept_names, found.sds.iter().copied()),
        levels: Labelled::zip(&kept_names, kept.iter().map(|grouping| grouping.levels.len())),
        at_zero,
        left_out,
        ratings: steps,
        loglik: found.log_likelihood,
        gradient: found.gradient,
        lr_effect: MixedEffectRatio {
            reduced: words(&without),
            loglik: reduced.log_likelihood,
            ratio: LikelihoodRatio::of(found.log_likelihood, reduced.log_likelihood, df),
        },
        lr_last,
    }))
}

impl Columns {
    /// Answers in the order in which the effects are solved.
    fn data(&self, steps: &[f64], fixed: &Fixed, groupings: &[&Factor]) -> Data {
        let layout = Layout::of(groupings, self.rating.len());
        let place = |value: f64| steps.partition_point(|step| *step < value) as u32;
        let columns = fixed.columns();
        let row = |row: &usize| &fixed.values[row * columns..][..columns];
        Data {
            category: layout.rows.iter().map(|row| place(self.rating[*row])).collect(),
            categories: steps.len(),
            fixed: layout.rows.iter().flat_map(row).copied().collect(),
            columns,
            layout,
        }
    }
}

/// The maximum, or that there is none.
fn converged(data: &Data) -> Result<Fit, NoEstimate> {
    let found = fit(data);
    match found.converged() {
        true => Ok(found),
        false => Err(NoEstimate::NotConverged { gradient: found.gradient }),
    }
}

/// The values that occur, ascending.
fn distinct(values: &[f64]) -> Vec<f64> {
    let mut steps = values.to_vec();
    steps.sort_by(f64::total_cmp);
    steps.dedup();
    steps
}

/// The groupings that part the answers differently, and the names of those that repeat one before them.
fn apart(groupings: &[Factor]) -> (Vec<&Factor>, Vec<String>) {
    let (mut kept, mut left_out): (Vec<&Factor>, _) = (Vec::new(), Vec::new());
    for grouping in groupings {
        let same = |other: &&&Factor| is_part(grouping, other) && is_part(other, grouping);
        match kept.iter().find(same) {
            Some(_) => left_out.push(grouping.name.clone()),
            None => kept.push(grouping),
        }
    }
    (kept, left_out)
}

/// The effects of the factors, and with interactions those of every several, fewest first.
fn terms(factors: &[Factor], interactions: bool) -> Vec<FixedTerm> {
    let singles = (0..factors.len()).map(|factor| vec![factor]);
    if !interactions {
        return singles.collect();
    }
    let subsets = 1_u32..1 << factors.len();
    let members = |subset: u32| (0..factors.len()).filter(move |f| subset >> f & 1 == 1).collect();
    let mut terms: Vec<FixedTerm> = subsets.map(members).collect();
    terms.sort_by_key(|term: &FixedTerm| (term.len(), term.clone()));
    terms
}

/// Fixed effects as R writes them.
fn formula(factors: &[Factor], terms: &[FixedTerm]) -> String {
    let name = |term: &FixedTerm| {
        term.iter().map(|factor| factors[*factor].name.as_str()).collect::<Vec<_>>().join(":")
    };
    match terms {
        [] => "1".to_owned(),
        terms => terms.iter().map(name).collect::<Vec<_>>().join(" + "),
    }
}

/// Whether the columns, a row after the other, and a constant are linearly independent.
fn determined(fixed: &[f64], columns: usize) -> bool {
    let size = columns + 1;
    let mut products = vec![0.0; size * size];
    let rows = fixed.len() / columns;
    for row in fixed.chunks_exact(columns) {
        let value = |i: usize| if i == 0 { 1.0 } else { row[i - 1] };
        for i in 0..size {
            for j in 0..=i {
                products[i * size + j] += value(i) * value(j) / rows as f64;
            }
        }
    }
    // Columns of 0 and 1: a determinant of a real design is far above rounding.
    effects::cholesky(&mut products, size).is_some()
        && (0..size).all(|i| products[i * size + i] > 1e-7)
}

/// Of a fit and the one without its last grouping.
fn ratio_of(name: &str, with: &Fit, without: &Fit) -> MixedGroupingRatio {
    let statistic = (2.0 * (with.log_likelihood - without.log_likelihood)).max(0.0);
    let Tail { p, .. } = chi_square_upper(statistic, 1.0);
    // Of a statistic of 0 all is as far or farther.
    let p_half_chi_square = if statistic > 0.0 { p / 2.0 } else { 1.0 };
    let loglik = without.log_likelihood;
    MixedGroupingRatio { grouping: name.to_owned(), loglik, statistic, p_half_chi_square }
}

/// Every two levels of the only factor.
fn pairs(factor: &Factor, coefficients: &[f64], covariance: &DMatrix<f64>) -> Vec<MixedPair> {
    // The first level is 0 by definition.
    let at = |level: usize| level.checked_sub(1).map_or(0.0, |place| coefficients[place]);
    let between = |a: usize, b: usize| match (a.checked_sub(1), b.checked_sub(1)) {
        (Some(a), Some(b)) => covariance[(a, b)],
        _ => 0.0,
    };
    let mut pairs = Vec::new();
    for a in 0..factor.levels.len() {
        for b in a + 1..factor.levels.len() {
            let estimate = at(b) - at(a);
            let se = (between(a, a) + between(b, b) - 2.0 * between(a, b)).sqrt();
            let Tail { p, ln_p } = normal_tail(estimate / se, Alternative::TwoSided);
            let reach = normal_quantile_upper(0.025) * se;
            pairs.push(MixedPair {
                a: factor.levels[a].clone(),
                b: factor.levels[b].clone(),
                estimate,
                se,
                p,
                ln_p,
                p_holm: p,
                odds_ratio: libm::exp(estimate),
                interval_95: [estimate - reach, estimate + reach].map(libm::exp),
                higher: share_higher(estimate),
            });
        }
    }
    let p: Vec<Option<f64>> = pairs.iter().map(|pair| Some(pair.p)).collect();
    for (pair, corrected) in pairs.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        pair.p_holm = corrected.unwrap_or(pair.p);
    }
    pairs
}

/// How often X + d stands above Y, both of the standard logistic distribution:
/// e^d (e^d - d - 1) / (e^d - 1)^2.
fn share_higher(d: f64) -> f64 {
    if d.abs() < 1e-3 {
        return 0.5 + d / 6.0;
    }
    if d > 0.0 {
        return 1.0 - share_higher(-d);
    }
    let (e, less) = (libm::exp(d), libm::expm1(d));
    e * (less - d) / (less * less)
}
