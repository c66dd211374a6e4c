//! Agreement with R, planted parameters, false positives, invariance, and what is undefined.

use super::*;
use crate::test::equivalence::{EquivalenceOptions, EquivalenceT};
use mimique_test_support::Random;

fn factor(name: &str, codes: &[u32]) -> Factor {
    let levels = (0..4000).map(|level: u32| level.to_string()).collect();
    Factor { name: name.to_owned(), levels, codes: codes.to_vec() }.used()
}

/// Standard deviations of people, people with each method, segments, clips, and the rest.
type Sds = [f64; 5];

/// Numbers of so many people over segments by methods of these means. Some answers are missing where `kept` is below 1.
fn planted(
    [people, segments]: [u32; 2],
    methods: &[f64],
    sds: Sds,
    kept: f64,
    random: &mut Random,
) -> (Numbers, [Factor; 5]) {
    let count = methods.len() as u32;
    let mut draw =
        |count: u32, sd: f64| -> Vec<f64> { (0..count).map(|_| sd * random.normal()).collect() };
    let of_people = draw(people, sds[0]);
    let tastes = draw(people * count, sds[1]);
    let of_segments = draw(segments, sds[2]);
    let of_clips = draw(segments * count, sds[3]);
    let (mut y, mut codes) = (Vec::new(), [const { Vec::new() }; 5]);
    for person in 0..people {
        for segment in 0..segments {
            for method in 0..count {
                if random.uniform() >= kept {
                    continue;
                }
                let [taste, clip] = [person * count + method, segment * count + method];
                y.push(
                    50.0 + methods[method as usize]
                        + of_people[person as usize]
                        + tastes[taste as usize]
                        + of_segments[segment as usize]
                        + of_clips[clip as usize]
                        + sds[4] * random.normal(),
                );
                let own = [method, person, taste, segment, clip];
                codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
            }
        }
    }
    let names = ["method", "person", "person:method", "segment", "segment:method"];
    let mut factors = names.iter().zip(&codes).map(|(name, codes)| factor(name, codes));
    let factors = [(); 5].map(|()| factors.next().unwrap());
    (Numbers { name: "y".to_owned(), values: y }, factors)
}

fn fitted(data: &(Numbers, [Factor; 5])) -> LinearMixedModel {
    let (y, [method, groupings @ ..]) = data;
    let options = LinearMixedModelOptions::default();
    linear_mixed_model(y, &[method], &groupings.each_ref(), options).unwrap().ok().unwrap()
}

#[test]
fn what_was_planted_is_found() {
    let sds = [9.0, 5.0, 7.0, 4.0, 10.0];
    let data = planted([80, 40], &[0.0, 8.0, -4.0], sds, 0.8, &mut Random::new(11));
    let found = fitted(&data);
    for (pair, planted) in found.pairs.iter().zip([8.0, -4.0, -12.0]) {
        assert!((pair.difference - planted).abs() < 3.0 * pair.se, "{pair:?}");
        let [low, high] = pair.interval_95;
        assert!(low < pair.difference && pair.difference < high);
    }
    // The standard error knows that clips and tastes differ: by these alone it is this large.
    let least = (2.0_f64 * (25.0 / 80.0 + 16.0 / 40.0)).sqrt();
    let pair = &found.pairs[0];
    assert!(pair.se > 0.8 * least && pair.se < 1.5 * least, "{pair:?}, {least}");
    for ((name, own), planted) in found.sd.iter().zip(sds) {
        assert!((own / planted - 1.0).abs() < 0.35, "{name}: {own}, planted {planted}");
    }
    assert!((found.residual_sd / 10.0 - 1.0).abs() < 0.05);
    assert!(found.effect.p < 1e-6 && found.effect.df == 2);
    let means: Vec<f64> = found.means.iter().map(|(_, mean)| mean.mean).collect();
    assert!((means[1] - means[0] - found.pairs[0].difference).abs() < 1e-9);
}

/// With all cells filled and every variance above 0, the difference of two methods has the variance of the quasi F of the
/// analysis of variance: MS(people x method) + MS(segments x method) - MS(rest).
#[test]
fn two_methods_over_filled_cells_agree_with_mean_squares() {
    let (people, segments) = (14, 9);
    let data = planted(
        [people, segments],
        &[0.0, 3.0],
        [8.0, 5.0, 6.0, 4.0, 7.0],
        1.0,
        &mut Random::new(3),
    );
    let found = fitted(&data);
    assert!(found.at_zero.is_empty(), "{:?}", found.at_zero);
    let (p, s) = (people as usize, segments as usize);
    let difference = |i: usize, j: usize| {
        let at = (i * s + j) * 2;
        data.0.values[at + 1] - data.0.values[at]
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let by_person: Vec<f64> =
        (0..p).map(|i| mean(&(0..s).map(|j| difference(i, j)).collect::<Vec<_>>())).collect();
    let by_segment: Vec<f64> =
        (0..s).map(|j| mean(&(0..p).map(|i| difference(i, j)).collect::<Vec<_>>())).collect();
    let all = mean(&by_person);
    let square = |values: &[f64], by: usize| {
        by as f64 * values.iter().map(|v| (v - all).powi(2)).sum::<f64>()
            / (values.len() - 1) as f64
    };
    let (of_people, of_segments) = (square(&by_person, s), square(&by_segment, p));
    let pair = &found.pairs[0];
    assert!((pair.difference - all).abs() < 1e-9);
    let denominator = pair.se * pair.se * (p * s) as f64;
    let expected = of_people + of_segments - 2.0 * found.residual_sd.powi(2);
    assert!((denominator / expected - 1.0).abs() < 1e-5, "{denominator}, {expected}");
}

/// R's lmerTest::lmer on the same numbers.
#[test]
fn numbers_agree_with_r() {
    let data =
        planted([12, 8], &[0.0, 2.0, 5.0], [4.0, 3.0, 2.0, 3.0, 5.0], 0.85, &mut Random::new(29));
    let found = fitted(&data);
    // lmerTest 3.1-3, lme4 1.1-31, bobyqa to 1e-10.
    let near = |own: f64, r: f64| assert!((own / r - 1.0).abs() < 1e-5, "{own}, R has {r}");
    near(found.effect.f, 5.37576499739);
    near(found.effect.df_denominator, 26.5478203007);
    near(found.effect.p, 0.0109599824933);
    near(found.reml_deviance, 1541.3561080458);
    let own = found.coefficients.get("(Intercept)").unwrap();
    near(own.estimate, 48.80659962739);
    near(own.se, 1.79133871119);
    near(own.df, 33.0782038710);
    let pair = &found.pairs[1];
    near(pair.difference, 5.38794251925);
    near(pair.se, 1.80976696495);
    near(pair.df, 26.5637151018);
    near(pair.p, 6.13781428360e-03);
    for (name, sd) in [
        ("person", 3.460536347),
        ("person:method", 3.508970373),
        ("segment", 2.130791992),
        ("segment:method", 1.733184825),
    ] {
        near(*found.sd.get(name).unwrap(), sd);
    }
    near(found.residual_sd, 4.369173191);
}

#[test]
fn false_positives_keep_to_five_percent() {
    let mut random = Random::new(5);
    let rounds = 400;
    for (size, sds) in [
        ([20, 6], [0.5, 0.0, 0.5, 0.3, 1.0]),
        ([30, 6], [0.5, 0.3, 0.5, 0.0, 1.0]),
        ([20, 12], [0.5, 0.3, 0.5, 0.3, 1.0]),
    ] {
        let mut positive = 0;
        for _ in 0..rounds {
            let data = planted(size, &[0.0, 0.0], sds, 0.9, &mut random);
            positive += usize::from(fitted(&data).effect.p < 0.05);
        }
        // Of 400 draws of 5 % 29 are as many as in 99 % of cases.
        assert!(positive <= 31, "{size:?} {sds:?}: {positive} of {rounds}");
    }
}

/// Where two levels differ by exactly the smallest effect that matters, they are called equivalent in at most 5 % of studies.
#[test]
fn equivalence_at_the_smallest_effect_keeps_to_five_percent_where_clips_differ() {
    let mut random = Random::new(17);
    let (rounds, options) = (300, EquivalenceOptions::smallest_effect(0.5));
    let mut equivalent = 0;
    for _ in 0..rounds {
        let data = planted([40, 8], &[0.0, 0.5], [0.5, 0.2, 0.5, 0.2, 0.8], 0.95, &mut random);
        let found = fitted(&data);
        let [pair] = found.pairs.as_slice() else { panic!("one pair") };
        let tests = EquivalenceT::of(pair.difference, pair.se, pair.df, &options);
        equivalent += usize::from(tests.unwrap().ok().unwrap().p < 0.05);
    }
    // Of 300 draws of 5 % 24 are as many as in 99 % of cases.
    assert!((3..=24).contains(&equivalent), "{equivalent} of {rounds}");
}

#[test]
fn another_unit_changes_numbers_by_that_unit_and_nothing_else() {
    let mut data = planted([10, 6], &[0.0, 4.0], [3.0; 5], 0.9, &mut Random::new(2));
    let found = fitted(&data);
    data.0.values.iter_mut().for_each(|y| *y = 7.0 - 1e3 * *y);
    let turned = fitted(&data);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-5 * b.abs().max(1e-3), "{a}, {b}");
    near(turned.effect.f, found.effect.f);
    near(turned.effect.df_denominator, found.effect.df_denominator);
    near(turned.pairs[0].difference, -1e3 * found.pairs[0].difference);
    near(turned.residual_sd, 1e3 * found.residual_sd);
}

#[test]
fn what_cannot_be_told_is_undefined() {
    let (y, [method, person, taste, segment, clip]) =
        planted([6, 6], &[0.0; 3], [0.5; 5], 1.0, &mut Random::new(1));
    let fit = |y: &Numbers, factors: &[&Factor], groupings: &[&Factor]| {
        linear_mixed_model(y, factors, groupings, LinearMixedModelOptions::default())
    };
    let same = Numbers { values: vec![3.0; y.values.len()], ..y.clone() };
    assert!(fit(&same, &[&method], &[&person]).unwrap().reason().is_some());
    let twice = fit(&y, &[&method, &method], &[&person]).unwrap();
    assert_eq!(twice.reason(), Some(&NoEstimate::Singular.into()));
    // Each emotion with one segment: their effects cannot be separated.
    let one = fit(&y, &[&segment], &[&person, &segment]).unwrap();
    let grouping = "segment".to_owned();
    assert_eq!(one.reason(), Some(&NoEstimate::OneUnitPerLevel { grouping }.into()));
    // Each segment by one method: clips are the segments; each answer of its own: that is the residual.
    let code = |(s, m): (&u32, &u32)| s * 3 + m;
    let confounded: Vec<u32> = segment.codes.iter().zip(&method.codes).map(code).collect();
    let confounded = factor("segments", &confounded);
    let each = factor("answer", &(0..y.values.len() as u32).collect::<Vec<_>>());
    let groupings = [&person, &taste, &confounded, &clip, &each];
    let found = fit(&y, &[&method], &groupings).unwrap().ok().unwrap();
    assert_eq!(found.left_out, ["segment:method", "answer"]);
    let alone = factor("person", &vec![0; y.values.len()]);
    assert!(fit(&y, &[&method], &[&alone]).is_err());
}
