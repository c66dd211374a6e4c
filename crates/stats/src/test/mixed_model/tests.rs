//! Planted parameters, bounds, symmetry, and what is refused.

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
    let mut draw =
        |count: u32, sd: f64| -> Vec<f64> { (0..count).map(|_| sd * random.normal()).collect() };
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
                y.push(1.0 + [-2.0, -0.5, 1.0, 2.5].iter().filter(|t| latent > **t).count() as f64);
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
    assert_eq!(found.ratings, [1.0, 2.0, 3.0, 4.0, 5.0]);
    for ((level, shares), log_odds) in found.shares.iter().zip([0.0, 0.8, -0.4]) {
        let below = |t: f64| 1.0 / (1.0 + (log_odds - t).exp());
        let [a, b, c, d] = [-2.0, -0.5, 1.0, 2.5].map(below);
        for (own, planted) in shares.model.iter().zip([a, b - a, c - b, d - c, 1.0 - d]) {
            assert!((own - planted).abs() < 0.06, "{level}: {own}, planted {planted}");
        }
        for all in [&shares.model, &shares.observed] {
            assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
        let (extreme, observed) = (shares.model[2], shares.observed[2]);
        assert!(extreme > observed, "who differ give fewer answers in the middle: {level}");
    }
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
    let found = fit(&y, &[&method], &[&person, &taste, &confounded, &clip]).unwrap().ok().unwrap();
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

/// The model without its last grouping has a standard deviation of nearly 0 here.
#[test]
fn a_case_of_r_converges_in_all_its_models() {
    let name = "a_case_of_r_converges_in_all_its_models";
    let file = "psychophysics/open/clmm_segments_clips.csv";
    let Some(path) = mimique_test_support::real_file(name, file) else { return };
    let table = crate::table::Table::parse(std::fs::read(path).unwrap()).unwrap();
    let column = |name: &str| table.factor(name).unwrap();
    let (method, person, segment) = (column("method"), column("participant"), column("segment"));
    let groupings = [&person, &person.crossed(&method), &segment, &segment.crossed(&method)];
    let options = MixedModelOptions { ratio_of_last: true, ..MixedModelOptions::default() };
    let rating = table.numbers("rating").unwrap();
    let found = mixed_model(&rating, &[&method], &groupings, options).unwrap();
    let Outcome::Ok(found) = found else { panic!("{found:?}") };
    // R's ordinal::clmm, which stops at a gradient of 3.5e-4.
    let near = |own: f64, r: f64| assert!((own - r).abs() < 1e-3, "{own}, R has {r}");
    near(found.loglik, -877.715060547858);
    near(found.lr_effect.loglik, -883.635618854474);
    near(found.coefficients.get("methodlsts").unwrap().estimate, 0.767752698063618);
    near(found.coefficients.get("methodlsts").unwrap().se, 0.254307177684797);
    near(*found.sd.get("participant:method").unwrap(), 0.145568683122581);
    near(*found.sd.get("segment:method").unwrap(), 0.351982945391268);
    near(*found.thresholds.get("1|2").unwrap(), -1.98750663851072);
}
