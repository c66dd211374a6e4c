//! Linear mixed models of numbers with crossed random effects: y = xβ + u + ε with independent normal effects u of
//! people, of people with each method, of segments and of clips (or of any other groupings) by restricted maximum
//! likelihood, and tests by t and F with Satterthwaite's degrees of freedom, as R's `lmerTest::lmer`.
//!
//! For people and stimuli both drawn at random see Baayen, Davidson and Bates 2008 and Judd, Westfall and Kenny 2012.

mod comparisons;
mod degrees;
mod procedure;
mod reml;
mod result;
#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, DVector};

use super::design::{Fixed, FixedTerm, is_part};
use super::search::GRADIENT;
use super::{apart, determined, formula, terms};
use crate::adjust::Adjustment;
use crate::distributions::tail::{Tail, f_upper, t_quantile_upper, t_two_sided};
use crate::outcome::{Labelled, Outcome};
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::{NoEstimate, Undefined};
pub use comparisons::{ChosenOverOthers, LinearComparisonModel, linear_comparison_model};
use degrees::Satterthwaite;
pub(crate) use procedure::PROCEDURE;
use reml::{Data, RandomTerm};
pub use result::{LinearCoefficient, LinearEffect, LinearMean, LinearMixedModel, LinearPair};

/// What is fitted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LinearMixedModelOptions {
    /// With all interactions of the factors.
    pub interactions: bool,
}

/// Fits numbers to factors (all seen by their first level) with independent effects of groupings. The effect that is
/// tested is the first factor, or with interactions that of all factors.
///
/// Groupings that part the responses as one before them does, or each response from all others, are left out.
/// Refuses factors and groupings with one level. Undefined where all responses are equal, where the responses do not
/// determine the estimates (as where each level of the factor has one segment only), and where the search did not
/// converge.
pub fn linear_mixed_model(
    response: &Numbers,
    factors: &[&Factor],
    groupings: &[&Factor],
    options: LinearMixedModelOptions,
) -> Result<Outcome<LinearMixedModel>, Refusal> {
    let all: Vec<&Factor> = factors.iter().chain(groupings).copied().collect();
    let complete = complete_rows(&[response], &all)?;
    let rows = complete.to_vec();
    let of = |factors: &[&Factor]| -> Vec<Factor> {
        factors.iter().map(|factor| factor.rows(&rows)).collect()
    };
    let (factors, groupings) = (of(factors), of(groupings));
    if factors.is_empty() {
        return Err(Refusal::NoColumns);
    }
    factors.iter().chain(&groupings).try_for_each(|factor| factor.require_levels(2))?;
    let values = complete.numbers(response);
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let spread = (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n as f64).sqrt();
    if values.iter().all(|value| *value == values[0]) {
        let column = response.name.clone();
        return Ok(Outcome::undefined(Undefined::EqualValues { column, n, value: values[0] }));
    }
    let (mut kept, mut left_out) = apart(&groupings);
    kept.retain(|grouping| {
        let is_residual = grouping.levels.len() == n;
        left_out.extend(is_residual.then(|| grouping.name.clone()));
        !is_residual
    });
    let terms = terms(&factors, options.interactions);
    let tested = if options.interactions { terms.len() - 1 } else { 0 };
    let fixed = Fixed::of(&factors, &terms, n);
    let columns = fixed.columns();
    if !determined(&fixed.values, columns) {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    }
    if let Some(grouping) = of_one_unit(&factors, &terms[tested], &kept, n) {
        return Ok(Outcome::undefined(NoEstimate::OneUnitPerLevel { grouping }));
    }
    // In units of their spread, so that the search does not depend on the unit.
    let standard: Vec<f64> = values.iter().map(|y| (y - mean) / spread).collect();
    let random: Vec<RandomTerm<'_>> = (kept.iter().enumerate())
        .map(|(deviation, grouping)| RandomTerm { grouping, deviation, sign: 1.0 })
        .collect();
    let data = Data::new(&random, &fixed.values, columns, &standard);
    let least = data.fit();
    if least.gradient.is_nan() || least.gradient >= GRADIENT {
        return Ok(Outcome::undefined(NoEstimate::NotConverged { gradient: least.gradient }));
    }
    let Some(solved) = data.solved(&least.at) else {
        return Ok(Outcome::undefined(NoEstimate::NoVariance));
    };
    let Some(degrees) = Satterthwaite::new(&data, &solved, &least.at) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let contrasts = of_term(&factors, &terms, tested);
    let Some((f, df_denominator)) = degrees.together(&contrasts) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let df = contrasts.nrows();
    let Tail { p, ln_p } = f_upper(f, df as f64, df_denominator);
    let estimate = |contrast: DVector<f64>| {
        let (variance, df) = degrees.of(&contrast);
        (spread * contrast.dot(&solved.coefficients), spread * variance.sqrt(), df)
    };
    let unit = |place: usize| DVector::from_fn(columns + 1, |i, _| f64::from(u8::from(i == place)));
    let names: Vec<String> =
        std::iter::once("(Intercept)".to_owned()).chain(fixed.names.iter().cloned()).collect();
    let coefficients = (0..=columns).map(|place| {
        let (own, se, df) = estimate(unit(place));
        let own = if place == 0 { own + mean } else { own };
        let t = own / se;
        LinearCoefficient { estimate: own, se, df, t, p: t_two_sided(t, df).p }
    });
    let coefficients: Vec<LinearCoefficient> = coefficients.collect();
    let (means, pairs) = match factors.as_slice() {
        [factor] => (means(factor, mean, &estimate), pairs(&factor.levels, &estimate)),
        _ => (Labelled(Vec::new()), Vec::new()),
    };
    let residual_sd = spread * (solved.squares / data.residual_df() as f64).sqrt();
    let sds: Vec<f64> = least.at.iter().map(|sd| sd.abs()).collect();
    let at_zero = kept.iter().zip(&sds).filter(|(_, sd)| **sd == 0.0);
    let at_zero = at_zero.map(|(grouping, _)| grouping.name.clone()).collect();
    let kept_names: Vec<String> = kept.iter().map(|grouping| grouping.name.clone()).collect();
    let groups: String = kept.iter().map(|own| format!(" + (1 | {})", own.name)).collect();
    let scale = 2.0 * data.residual_df() as f64 * libm::log(spread);
    Ok(Outcome::Ok(LinearMixedModel {
        test: "linear-mixed-model",
        formula: format!("{} ~ {}{groups}", response.name, formula(&factors, &terms)),
        observations: n,
        dropped: complete.dropped(),
        effect: LinearEffect { f, df, df_denominator, p, ln_p },
        coefficients: Labelled::zip(&names, coefficients),
        means,
        pairs,
        sd: Labelled::zip(&kept_names, sds.iter().map(|sd| sd * residual_sd)),
        residual_sd,
        levels: Labelled::zip(&kept_names, kept.iter().map(|grouping| grouping.levels.len())),
        at_zero,
        left_out,
        reml_deviance: data.deviance(least.value) + scale,
        gradient: least.gradient,
    }))
}

/// A grouping whose levels each have one level of the tested term, and which has no more levels than the term: where each
/// emotion has one segment, effects of emotion and segment cannot be separated.
fn of_one_unit(
    factors: &[Factor],
    term: &FixedTerm,
    groupings: &[&Factor],
    rows: usize,
) -> Option<String> {
    let (first, others) = term.split_first()?;
    let cell =
        (others.iter()).fold(factors[*first].clone(), |whole, f| whole.crossed(&factors[*f]));
    let cell = cell.rows(&(0..rows).collect::<Vec<_>>());
    let same = |own: &&&Factor| is_part(own, &cell) && own.levels.len() <= cell.levels.len();
    groupings.iter().find(same).map(|own| own.name.clone())
}

/// The columns of a term, each as a contrast of all coefficients, the constant first.
fn of_term(factors: &[Factor], terms: &[FixedTerm], tested: usize) -> DMatrix<f64> {
    let columns = |term: &FixedTerm| -> usize {
        term.iter().map(|factor| factors[*factor].levels.len() - 1).product()
    };
    let before: usize = 1 + terms[..tested].iter().map(columns).sum::<usize>();
    let all: usize = 1 + terms.iter().map(columns).sum::<usize>();
    DMatrix::from_fn(columns(&terms[tested]), all, |row, column| {
        f64::from(u8::from(column == before + row))
    })
}

/// A contrast's estimate, standard error and degrees of freedom.
type Estimate<'e> = dyn Fn(DVector<f64>) -> (f64, f64, f64) + 'e;

fn means(factor: &Factor, mean: f64, estimate: &Estimate<'_>) -> Labelled<LinearMean> {
    let count = factor.levels.len();
    let means = (0..count).map(|level| {
        let at = |i: usize| i == 0 || i == level;
        let (own, se, df) = estimate(DVector::from_fn(count, |i, _| f64::from(u8::from(at(i)))));
        let (own, reach) = (own + mean, t_quantile_upper(0.025, df) * se);
        LinearMean { mean: own, se, df, interval_95: [own - reach, own + reach] }
    });
    Labelled::zip(&factor.levels, means)
}

/// Every two levels, the second less the first, with Holm's correction over them.
fn pairs(levels: &[String], estimate: &Estimate<'_>) -> Vec<LinearPair> {
    let count = levels.len();
    let mut pairs = Vec::new();
    for a in 0..count {
        for b in a + 1..count {
            // The first level is 0 by definition.
            let sign = |i: usize| match i {
                0 => 0.0,
                i if i == b => 1.0,
                i if i == a => -1.0,
                _ => 0.0,
            };
            let (difference, se, df) = estimate(DVector::from_fn(count, |i, _| sign(i)));
            let t = difference / se;
            let Tail { p, ln_p } = t_two_sided(t, df);
            let reach = t_quantile_upper(0.025, df) * se;
            pairs.push(LinearPair {
                a: levels[a].clone(),
                b: levels[b].clone(),
                difference,
                se,
                df,
                t,
                p,
                ln_p,
                p_holm: p,
                interval_95: [difference - reach, difference + reach],
            });
        }
    }
    corrected(pairs)
}

/// With Holm's correction over the pairs.
fn corrected(mut pairs: Vec<LinearPair>) -> Vec<LinearPair> {
    let p: Vec<Option<f64>> = pairs.iter().map(|pair| Some(pair.p)).collect();
    for (pair, corrected) in pairs.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        pair.p_holm = corrected.unwrap_or(pair.p);
    }
    pairs
}
