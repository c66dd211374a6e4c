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
mod procedure;

use nalgebra::DMatrix;
use serde::Serialize;

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
use laplace::{Data, Fit, covariance, fit};
pub(crate) use procedure::PROCEDURE;

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

/// A coefficient of the fixed effects, a level against the first one of its factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MixedCoefficient {
    /// In log odds of a higher rating.
    pub estimate: f64,
    /// Standard error.
    pub se: f64,
    /// Estimate by standard error.
    pub z: f64,
    /// Of z, two-sided.
    pub p: f64,
}

/// Two levels of the factor, the second against the first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedPair {
    /// First level.
    pub a: String,
    /// Second level.
    pub b: String,
    /// b - a in log odds of a higher rating, with its standard error.
    pub estimate: f64,
    /// Standard error.
    pub se: f64,
    /// Of z, two-sided.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// After Holm's correction over the pairs.
    pub p_holm: f64,
    /// exp of the estimate: how many times the odds of a higher rating are those at a.
    pub odds_ratio: f64,
    /// Its 95 % interval.
    pub interval_95: [f64; 2],
    /// Of two answers of one person to clips that are equal but for the level, how often b stands higher (on the
    /// latent scale, where none are alike).
    pub higher: f64,
}

/// The effect held against the model without it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedEffectRatio {
    /// The fixed effects that remain, `1` for none.
    pub reduced: String,
    /// Log likelihood without the effect.
    pub loglik: f64,
    /// The ratio.
    #[serde(flatten)]
    pub ratio: LikelihoodRatio,
}

/// The last grouping held against the model without it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedGroupingRatio {
    /// The grouping.
    pub grouping: String,
    /// Log likelihood without it.
    pub loglik: f64,
    /// Twice the difference of the log likelihoods.
    pub statistic: f64,
    /// Half of the upper tail of chi-square with 1 degree of freedom: a standard deviation of 0 is a bound
    /// (Self and Liang 1987).
    pub p_half_chi_square: f64,
}

/// Result of [`mixed_model`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedModel {
    /// Always `mixed-model`.
    pub test: &'static str,
    /// `cumulative logit`, or `binomial`.
    pub variant: &'static str,
    /// As R writes it.
    pub formula: String,
    /// Ratings.
    pub observations: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Between every two ratings, `1|2`, on the logit scale.
    pub thresholds: Labelled<f64>,
    /// Fixed effects.
    pub coefficients: Labelled<MixedCoefficient>,
    /// Every two levels of the one factor; none of several factors.
    pub pairs: Vec<MixedPair>,
    /// Standard deviation of each grouping's effects, in log odds.
    pub sd: Labelled<f64>,
    /// Levels of each grouping.
    pub levels: Labelled<usize>,
    /// Groupings whose standard deviation is 0: the likelihood is highest at that bound.
    pub at_zero: Vec<String>,
    /// Groupings that part the answers as one before them does, and are left out.
    pub left_out: Vec<String>,
    /// Log likelihood.
    pub loglik: f64,
    /// Largest element of its gradient: below 1e-5, or there is no result.
    pub gradient: f64,
    /// The factor, or the interaction of all factors, against the model without it.
    pub lr_effect: MixedEffectRatio,
    /// The last grouping against the model without it, where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lr_last: Option<MixedGroupingRatio>,
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
    if !determined(&whole) {
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

/// Whether the columns and a constant are linearly independent.
fn determined(data: &Data) -> bool {
    let size = data.columns + 1;
    let mut products = vec![0.0; size * size];
    let rows = data.category.len();
    for row in data.fixed.chunks_exact(data.columns) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn factor(name: &str, codes: &[u32]) -> Factor {
        let levels = (0..200).map(|level: u32| level.to_string()).collect();
        Factor { name: name.to_owned(), levels, codes: codes.to_vec() }.used()
    }

    /// Ratings from 1 of so many people over segments by three methods: log odds of the methods, sds.
    fn planted(
        [people, segments]: [u32; 2],
        methods: [f64; 3],
        [person_sd, taste_sd, segment_sd, clip_sd]: [f64; 4],
        random: &mut Random,
    ) -> (Numbers, [Factor; 5]) {
        let mut draw = |count: u32, sd: f64| -> Vec<f64> {
            (0..count).map(|_| sd * random.normal()).collect()
        };
        let of_people = draw(people, person_sd);
        let taste = draw(people * 3, taste_sd);
        let of_segments = draw(segments, segment_sd);
        let of_clips = draw(segments * 3, clip_sd);
        let (mut y, mut codes) = (Vec::new(), [const { Vec::new() }; 5]);
        for person in 0..people {
            for segment in 0..segments {
                for method in 0..3 {
                    let u = random.uniform();
                    let latent = (u / (1.0 - u)).ln()
                        + methods[method as usize]
                        + of_people[person as usize]
                        + taste[(person * 3 + method) as usize]
                        + of_segments[segment as usize]
                        + of_clips[(segment * 3 + method) as usize];
                    y.push(
                        1.0 + [-2.0, -0.5, 1.0, 2.5].iter().filter(|t| latent > **t).count() as f64,
                    );
                    let own = [method, person, person * 3 + method, segment, segment * 3 + method];
                    codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
                }
            }
        }
        let names = ["method", "person", "person:method", "segment", "clip"];
        let mut factors = names.iter().zip(&codes).map(|(name, codes)| factor(name, codes));
        let factors = [(); 5].map(|()| factors.next().unwrap());
        (Numbers { name: "y".to_owned(), values: y }, factors)
    }

    fn fitted(data: &(Numbers, [Factor; 5])) -> MixedModel {
        let (y, [method, groupings @ ..]) = data;
        let options = MixedModelOptions { ratio_of_last: true, ..MixedModelOptions::default() };
        mixed_model(y, &[method], &groupings.each_ref(), options).unwrap().ok().unwrap()
    }

    #[test]
    fn what_was_planted_is_found() {
        let sds = [0.9, 0.5, 0.7, 0.4];
        let data = planted([60, 40], [0.0, 0.8, -0.4], sds, &mut Random::new(11));
        let found = fitted(&data);
        let [one, two] = ["method1", "method2"].map(|name| found.coefficients.get(name).unwrap());
        assert!((one.estimate - 0.8).abs() < 3.0 * one.se, "{one:?}");
        assert!((two.estimate + 0.4).abs() < 3.0 * two.se, "{two:?}");
        // The standard error knows that clips and tastes differ: by these alone it is this large.
        let least = (2.0_f64 * (0.5 * 0.5 / 60.0 + 0.4 * 0.4 / 40.0)).sqrt();
        assert!(one.se > 0.8 * least && one.se < 1.5 * least, "{one:?}, {least}");
        for ((name, own), planted) in found.sd.iter().zip(sds) {
            assert!((own - planted).abs() < 0.2, "{name}: {own}, planted {planted}");
        }
        assert!(found.at_zero.is_empty());
        assert!(found.lr_last.unwrap().p_half_chi_square < 1e-3);
        assert!(found.lr_effect.ratio.p < 1e-6);
        assert_eq!(found.pairs.len(), 3);
        let pair = &found.pairs[0];
        assert!((pair.odds_ratio.ln() - one.estimate).abs() < 1e-12);
    }

    #[test]
    fn effects_that_are_not_there_have_a_deviation_of_zero_or_nearly() {
        let mut zero = 0;
        for seed in 0..8 {
            let data = planted([20, 12], [0.0; 3], [0.8, 0.0, 0.5, 0.0], &mut Random::new(seed));
            let found = fitted(&data);
            assert!(*found.sd.get("clip").unwrap() < 0.4);
            for name in &found.at_zero {
                assert_eq!(found.sd.get(name), Some(&0.0));
                if name == "clip" {
                    zero += 1;
                    assert!(found.lr_last.as_ref().unwrap().statistic < 1e-5);
                }
            }
        }
        // Half of them, by chance.
        assert!((1..8).contains(&zero), "{zero}");
    }

    #[test]
    fn reversing_the_scale_changes_signs_and_nothing_else() {
        let mut data = planted([15, 8], [0.0, 0.6, 0.1], [0.7, 0.3, 0.5, 0.3], &mut Random::new(2));
        let found = fitted(&data);
        data.0.values.iter_mut().for_each(|y| *y = 6.0 - *y);
        let turned = fitted(&data);
        assert!((found.loglik - turned.loglik).abs() < 1e-8);
        for ((_, one), (_, other)) in found.coefficients.iter().zip(turned.coefficients.iter()) {
            assert!((one.estimate + other.estimate).abs() < 1e-5);
            assert!((one.se - other.se).abs() < 1e-5);
        }
    }

    #[test]
    fn what_cannot_be_told_is_refused_or_undefined() {
        let (y, [method, person, taste, segment, clip]) =
            planted([6, 6], [0.0; 3], [0.5; 4], &mut Random::new(1));
        let fit = |y: &Numbers, factors: &[&Factor], groupings: &[&Factor]| {
            mixed_model(y, factors, groupings, MixedModelOptions::default())
        };
        let few = factor("few", &person.codes.iter().map(|code| code % 4).collect::<Vec<_>>());
        let why = fit(&y, &[&method], &[&few]).unwrap_err().to_string();
        assert!(why.contains("\"few\" has 4") || why.contains("few"), "{why}");
        let same = Numbers { values: vec![3.0; y.values.len()], ..y.clone() };
        assert!(fit(&same, &[&method], &[&person]).unwrap().reason().is_some());
        let many = Numbers { values: (0..y.values.len()).map(|i| i as f64).collect(), ..y.clone() };
        let why = fit(&many, &[&method], &[&person]).unwrap_err().to_string();
        assert!(why.contains("108 different"), "{why}");
        let twice = fit(&y, &[&method, &method], &[&person]).unwrap();
        assert_eq!(twice.reason(), Some(&NoEstimate::Singular.into()));
        // Each segment by one method: clips are the segments.
        let confounded = factor(
            "segments",
            &segment.codes.iter().zip(&method.codes).map(|(s, m)| s * 3 + m).collect::<Vec<_>>(),
        );
        let found =
            fit(&y, &[&method], &[&person, &taste, &confounded, &clip]).unwrap().ok().unwrap();
        assert_eq!(found.left_out, ["clip"]);
        // A rating that one method always gets: its odds rise for ever.
        let ends = Numbers {
            values: y
                .values
                .iter()
                .zip(&method.codes)
                .map(|(y, m)| if *m == 1 { 5.0 } else { *y })
                .collect(),
            ..y.clone()
        };
        let outcome = fit(&ends, &[&method], &[&person]).unwrap();
        assert!(outcome.reason().is_some(), "{outcome:?}");
    }

    #[test]
    fn the_share_that_stands_higher_is_the_integral() {
        for d in [-3.0, -0.5, 5e-4, 0.2, 1.7] {
            let steps = 200_000;
            // Mean of P(X > q - d) over quantiles q of Y.
            let mean: f64 = (0..steps)
                .map(|i| {
                    let u = (f64::from(i) + 0.5) / f64::from(steps);
                    let q = (u / (1.0 - u)).ln();
                    1.0 / (1.0 + (q - d).exp())
                })
                .sum::<f64>()
                / f64::from(steps);
            assert!((share_higher(d) - mean).abs() < 1e-6, "{d}");
        }
    }
}
