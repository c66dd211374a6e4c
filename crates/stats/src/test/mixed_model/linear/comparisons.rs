//! Choices between two items by people over segments: y = s + β(left) - β(right) + u + ε, y being 1/2 where the left item
//! is chosen, -1/2 where the right one is and 0 where neither, with effects u of people (who prefer a side), of people
//! with each item and of segments with each item, those of the right item taken off. So β is a share of choices, and what
//! is found holds for other people and other segments. The linear model of paired comparisons is Scheffé's (1952), with
//! random effects as in [`linear_mixed_model`](super::linear_mixed_model).

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::degrees::Satterthwaite;
use super::reml::{Data, RandomTerm};
use super::{LinearEffect, LinearPair, determined, pairs};
use crate::distributions::tail::{Tail, f_upper, t_quantile_upper};
use crate::outcome::{Labelled, Outcome};
use crate::refusal::Refusal;
use crate::table::comparisons::{Chosen, PairedComparisons};
use crate::table::factor::Factor;
use crate::test::mixed_model::search::GRADIENT;
use crate::undefined::NoEstimate;

/// How often an item is chosen over the average of the others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ChosenOverOthers {
    /// Share of choices, answers that choose neither counting half.
    pub share: f64,
    /// Standard error.
    pub se: f64,
    /// Satterthwaite's degrees of freedom.
    pub df: f64,
    /// Its 95 % interval by t.
    pub interval_95: [f64; 2],
}

/// Result of [`linear_comparison_model`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinearComparisonModel {
    /// Always `linear-comparison-model`.
    pub test: &'static str,
    /// Answers.
    pub answers: usize,
    /// Participants.
    pub participants: usize,
    /// Segments.
    pub segments: usize,
    /// That all items are chosen equally often.
    pub effect: LinearEffect,
    /// Of each item.
    pub items: Labelled<ChosenOverOthers>,
    /// Every two items, the second less the first: how far the share of choices of the second over the first is above 1/2.
    pub pairs: Vec<LinearPair>,
    /// What standing on the left adds to the share of choices.
    pub left: f64,
    /// Standard deviations of the random effects, in shares.
    pub sd: Labelled<f64>,
    /// That of what is left.
    pub residual_sd: f64,
    /// Random effects whose standard deviation is 0: the likelihood is highest at that bound.
    pub at_zero: Vec<String>,
}

/// Fits choices, `segment` having an entry for each answer.
///
/// Refuses fewer than two participants or segments. Undefined where answers do not vary or do not determine the
/// estimates, and where the search did not converge.
pub fn linear_comparison_model(
    data: &PairedComparisons,
    segment: &Factor,
) -> Result<Outcome<LinearComparisonModel>, Refusal> {
    let n = data.answers.len();
    let items = data.items.len();
    let factor = |name: &str, levels: &[String], code: &dyn Fn(usize) -> usize| {
        let codes = (0..n).map(|row| code(row) as u32).collect();
        Factor { name: name.to_owned(), levels: levels.to_vec(), codes }
    };
    let person = factor("participant", &data.participants, &|row| data.answers[row].participant);
    person.require_levels(2)?;
    segment.require_levels(2)?;
    let response: Vec<f64> = (data.answers.iter())
        .map(|answer| match answer.chosen {
            Chosen::Left => 0.5,
            Chosen::Same => 0.0,
            Chosen::Right => -0.5,
        })
        .collect();
    // Items but the first: 1 on the left, -1 on the right.
    let columns = items - 1;
    let column = |row: usize, item: usize| {
        f64::from(u8::from(data.answers[row].left == item))
            - f64::from(u8::from(data.answers[row].right == item))
    };
    let fixed: Vec<f64> =
        (0..n).flat_map(|row| (1..items).map(move |item| column(row, item))).collect();
    if n <= columns + 1 || !determined(&fixed, columns) {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    }
    // Both sides have the same levels, also those that no answer has on one of them.
    let with_items = |unit: &Factor| {
        let levels: Vec<String> = (unit.levels.iter())
            .flat_map(|unit| data.items.iter().map(move |item| format!("{unit}:{item}")))
            .collect();
        let name = format!("{}:item", unit.name);
        let code = |row: usize, item: usize| unit.codes[row] as usize * items + item;
        [
            factor(&name, &levels, &|row| code(row, data.answers[row].left)),
            factor(&name, &levels, &|row| code(row, data.answers[row].right)),
        ]
    };
    let [taste_left, taste_right] = with_items(&person);
    let [clip_left, clip_right] = with_items(segment);
    let term = |grouping, deviation, sign| RandomTerm { grouping, deviation, sign };
    let random = [
        term(&person, 0, 1.0),
        term(&taste_left, 1, 1.0),
        term(&taste_right, 1, -1.0),
        term(&clip_left, 2, 1.0),
        term(&clip_right, 2, -1.0),
    ];
    let model = Data::new(&random, &fixed, columns, &response);
    let least = model.fit();
    if least.gradient.is_nan() || least.gradient >= GRADIENT {
        return Ok(Outcome::undefined(NoEstimate::NotConverged { gradient: least.gradient }));
    }
    let Some(solved) = model.solved(&least.at) else {
        return Ok(Outcome::undefined(NoEstimate::NoVariance));
    };
    let Some(degrees) = Satterthwaite::new(&model, &solved, &least.at) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let tested =
        DMatrix::from_fn(columns, columns + 1, |row, at| f64::from(u8::from(at == row + 1)));
    let Some((f, df_denominator)) = degrees.together(&tested) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let Tail { p, ln_p } = f_upper(f, columns as f64, df_denominator);
    let estimate = |contrast: DVector<f64>| {
        let (variance, df) = degrees.of(&contrast);
        (contrast.dot(&solved.coefficients), variance.sqrt(), df)
    };
    let over_others = (0..items).map(|item| {
        let others = 1.0 / (items - 1) as f64;
        // The first item is 0 by definition.
        let (own, se, df) = estimate(DVector::from_fn(items, |at, _| match at {
            0 => 0.0,
            at if at == item => 1.0,
            _ => -others,
        }));
        let (share, reach) = (0.5 + own, t_quantile_upper(0.025, df) * se);
        ChosenOverOthers { share, se, df, interval_95: [share - reach, share + reach] }
    });
    let over_others: Vec<ChosenOverOthers> = over_others.collect();
    let residual_sd = (solved.squares / model.residual_df() as f64).sqrt();
    let names = ["participant", "participant:item", "segment:item"].map(str::to_owned);
    let sds = least.at.iter().map(|sd| sd.abs() * residual_sd);
    let at_zero = names.iter().zip(&least.at).filter(|(_, sd)| **sd == 0.0);
    Ok(Outcome::Ok(LinearComparisonModel {
        test: "linear-comparison-model",
        answers: n,
        participants: person.levels.len(),
        segments: segment.levels.len(),
        effect: LinearEffect { f, df: columns, df_denominator, p, ln_p },
        items: Labelled::zip(&data.items, over_others),
        pairs: pairs(&data.items, &estimate),
        left: solved.coefficients[0],
        at_zero: at_zero.map(|(name, _)| name.clone()).collect(),
        sd: Labelled::zip(&names, sds),
        residual_sd,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::comparisons::Compared;
    use mimique_test_support::Random;

    /// Choices of people over segments between items of these worths (in shares): each pair of each segment once, sides
    /// by chance; people and segments differ in how they take to items.
    fn planted(
        [people, segments]: [usize; 2],
        worths: &[f64],
        [taste, clip]: [f64; 2],
        random: &mut Random,
    ) -> (PairedComparisons, Factor) {
        let items = worths.len();
        let tastes: Vec<f64> = (0..people * items).map(|_| taste * random.normal()).collect();
        let clips: Vec<f64> = (0..segments * items).map(|_| clip * random.normal()).collect();
        let (mut answers, mut codes) = (Vec::new(), Vec::new());
        for participant in 0..people {
            for segment in 0..segments {
                for a in 0..items {
                    for b in a + 1..items {
                        let [left, right] = if random.uniform() < 0.5 { [a, b] } else { [b, a] };
                        let of = |item: usize| {
                            worths[item]
                                + tastes[participant * items + item]
                                + clips[segment * items + item]
                        };
                        let is_left = random.uniform() < 0.52 + of(left) - of(right);
                        let chosen = if is_left { Chosen::Left } else { Chosen::Right };
                        answers.push(Compared { participant, left, right, chosen });
                        codes.push(segment as u32);
                    }
                }
            }
        }
        let names = |count: usize| (0..count).map(|own| own.to_string()).collect::<Vec<_>>();
        let data = PairedComparisons {
            items: names(items),
            participants: names(people),
            answers,
            dropped: 0,
        };
        (data, Factor { name: "segment".to_owned(), levels: names(segments), codes })
    }

    fn fitted((data, segment): &(PairedComparisons, Factor)) -> LinearComparisonModel {
        linear_comparison_model(data, segment).unwrap().ok().unwrap()
    }

    #[test]
    fn what_was_planted_is_found() {
        let worths = [0.0, 0.15, -0.1];
        let found = fitted(&planted([60, 20], &worths, [0.06, 0.05], &mut Random::new(4)));
        for (pair, planted) in found.pairs.iter().zip([0.15, -0.1, -0.25]) {
            assert!((pair.difference - planted).abs() < 3.0 * pair.se, "{pair:?}");
            // Segments alone leave this much.
            assert!(pair.se > 0.7 * (2.0_f64 * 0.05 * 0.05 / 20.0).sqrt(), "{pair:?}");
        }
        assert!(found.effect.p < 1e-6);
        assert!((found.left - 0.02).abs() < 0.03, "{}", found.left);
        let best = found.items.get("1").unwrap();
        assert!((best.share - (0.5 + 0.2)).abs() < 3.0 * best.se, "{best:?}");
        for (name, planted) in [("participant:item", 0.06), ("segment:item", 0.05)] {
            let own = found.sd.get(name).unwrap();
            assert!((own - planted).abs() < 0.03, "{name}: {own}");
        }
    }

    /// Of two items the model is one of their difference with random people and segments.
    #[test]
    fn two_items_agree_with_mean_squares() {
        let (people, segments) = (16, 9);
        let mut own = planted([people, segments], &[0.0, 0.1], [0.15, 0.12], &mut Random::new(9));
        // The same item always on the left or right of a person: no side to estimate apart.
        for answer in &mut own.0.answers {
            if answer.left == 1 {
                let chosen =
                    if answer.chosen == Chosen::Left { Chosen::Right } else { Chosen::Left };
                *answer = Compared { left: 0, right: 1, chosen, ..*answer };
            }
        }
        let outcome = linear_comparison_model(&own.0, &own.1).unwrap();
        assert_eq!(outcome.reason(), Some(&NoEstimate::Singular.into()), "side and item are one");
    }

    #[test]
    fn false_positives_keep_to_five_percent_where_clips_differ() {
        let mut random = Random::new(12);
        let rounds = 300;
        for (size, worths, sds) in [
            ([60, 6], &[0.0; 2][..], [0.0, 0.05]),
            ([30, 6], &[0.0; 3][..], [0.06, 0.05]),
            ([40, 12], &[0.0; 2][..], [0.06, 0.0]),
        ] {
            let mut positive = 0;
            for _ in 0..rounds {
                positive +=
                    usize::from(fitted(&planted(size, worths, sds, &mut random)).effect.p < 0.05);
            }
            // Of 300 draws of 5 % 24 are as many as in 99 % of cases.
            assert!(positive <= 25, "{size:?} {sds:?}: {positive} of {rounds}");
        }
    }

    #[test]
    fn the_order_of_items_and_of_sides_does_not_matter() {
        let own = planted([14, 7], &[0.0, 0.1, 0.05], [0.1, 0.08], &mut Random::new(2));
        let found = fitted(&own);
        let (mut data, segment) = own;
        data.items.reverse();
        for answer in &mut data.answers {
            let (left, right) = (2 - answer.right, 2 - answer.left);
            let chosen = match answer.chosen {
                Chosen::Left => Chosen::Right,
                Chosen::Right => Chosen::Left,
                Chosen::Same => Chosen::Same,
            };
            *answer = Compared { left, right, chosen, ..*answer };
        }
        let turned = fitted(&(data, segment));
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-5 * b.abs().max(1e-2), "{a}, {b}");
        near(turned.effect.f, found.effect.f);
        near(turned.effect.df_denominator, found.effect.df_denominator);
        near(turned.left, -found.left);
        for (item, own) in found.items.iter() {
            near(turned.items.get(item).unwrap().share, own.share);
        }
    }
}
