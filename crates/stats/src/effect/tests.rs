//! Effect sizes against R, and the coverage of their intervals where the truth is planted.

use super::*;
use crate::numerics::random::Stream;
use crate::outcome::Outcome;
use crate::table::blocks::Blocks;
use crate::test::friedman::friedman;

/// Simulated studies per condition.
const STUDIES: usize = 400;

/// Covered studies of 400 with a true coverage of 95 %: the 0.05 % quantile of the binomial is 364.
const FEWEST_COVERED: usize = 364;

fn normal(stream: &mut Stream) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - stream.unit())).sqrt();
    radius * libm::cos(2.0 * std::f64::consts::PI * stream.unit())
}

/// How many of the simulated studies have the truth in their interval.
fn covered(truth: f64, seed: u64, study: impl Fn(&mut Stream) -> Option<EffectSize>) -> usize {
    (0..STUDIES)
        .filter(|round| {
            let found = study(&mut Stream::new(seed, *round as u64));
            found
                .and_then(|found| found.interval_95)
                .is_some_and(|[low, high]| low <= truth && truth <= high)
        })
        .count()
}

/// R 4.2: `uniroot` on `pt(t, n - 1, ncp)` divided by sqrt(n), which `MBESS::ci.sm` and `effectsize::cohens_d` print.
#[test]
fn d_z_and_its_interval_are_those_of_r() {
    // Ten differences with mean 2.5 / sqrt(10) standard deviations.
    let shape = [-1.5, -1.0, -0.7, -0.3, -0.1, 0.2, 0.4, 0.6, 1.0, 1.4];
    let sd = (shape.iter().map(|x: &f64| x * x).sum::<f64>() / 9.0).sqrt();
    let wanted = 2.5 / 10.0_f64.sqrt();
    let differences = shape.map(|x| 3.0 * (x / sd + wanted));
    let found = standardised_difference(&differences).unwrap();
    assert!((found.estimate - wanted).abs() < 1e-12, "{found:?}");
    let [low, high] = found.interval_95.unwrap();
    assert!((low - 0.057_851_960_740).abs() < 1e-8, "{found:?}");
    assert!((high - 1.491_144_294_698).abs() < 1e-8, "{found:?}");
}

#[test]
fn equal_differences_have_no_d_z() {
    assert_eq!(standardised_difference(&[0.5; 8]), None);
    assert_eq!(standardised_difference(&[0.1 + 0.2, 0.3, 0.3]), None);
    assert_eq!(standardised_difference(&[1.0]), None);
}

/// Where 65 % have no difference and all others rise, zeros count.
#[test]
fn zeros_count_in_the_dominance_within_pairs() {
    let differences: Vec<f64> = (0..20).map(|i| if i < 7 { 1.0 } else { 0.0 }).collect();
    let found = paired_dominance(&differences).unwrap();
    assert!((found.estimate - 0.35).abs() < 1e-12);
    // By hand: p+ = 8/22, p- = 1/22, z = 1.959964.
    let (plus, minus): (f64, f64) = (8.0 / 22.0, 1.0 / 22.0);
    let error = ((plus + minus - (plus - minus).powi(2)) / 22.0).sqrt();
    let [low, high] = found.interval_95.unwrap();
    assert!((low - (plus - minus - 1.959_963_984_54 * error)).abs() < 1e-10);
    assert!((high - (plus - minus + 1.959_963_984_54 * error)).abs() < 1e-10);
}

/// R 4.2, from the formulas of Feng and Cliff, with every pair enumerated.
#[test]
fn cliffs_delta_is_that_of_all_pairs() {
    let (a, b) = ([3.0, 5.0, 6.0, 6.0, 7.0, 4.0, 5.0], [2.0, 3.0, 5.0, 4.0, 4.0, 1.0]);
    let found = cliff_delta(&a, &b).unwrap();
    assert!((found.estimate - 0.690_476_190_476).abs() < 1e-11);
    let pair = |x: f64, y: f64| (x - y).partial_cmp(&0.0).map_or(0.0, |sign| sign as i8 as f64);
    let (m, n, delta) = (7.0, 6.0, found.estimate);
    let rows = a.map(|x| b.iter().map(|y| pair(x, *y)).sum::<f64>() / n - delta);
    let columns = b.map(|y| a.iter().map(|x| pair(*x, y)).sum::<f64>() / m - delta);
    let all: f64 = a.iter().flat_map(|x| b.iter().map(|y| (pair(*x, *y) - delta).powi(2))).sum();
    let squares = |own: &[f64]| own.iter().map(|d| d * d).sum::<f64>();
    let variance = (n * n * squares(&rows) + m * m * squares(&columns) - all)
        / (m * n * (m - 1.0) * (n - 1.0));
    let z = 1.959_963_984_54;
    let rest: f64 = 1.0 - delta * delta;
    let reach = z * variance.sqrt() * (rest * rest + z * z * variance).sqrt();
    let [low, high] = found.interval_95.unwrap();
    let scale = rest + z * z * variance;
    assert!((low - (delta - delta.powi(3) - reach) / scale).abs() < 1e-9, "{found:?}");
    assert!((high - (delta - delta.powi(3) + reach) / scale).abs() < 1e-9, "{found:?}");
    let parted = cliff_delta(&[4.0, 5.0, 6.0, 7.0, 8.0, 9.0], &[1.0, 2.0, 3.0, 0.0, 1.0]).unwrap();
    assert_eq!((parted.estimate, parted.interval_95.unwrap()[1]), (1.0, 1.0));
}

/// R 4.2: `uniroot` on `pchisq(n (k - 1) W, k - 1, ncp)`, divided by n (k - 1).
#[test]
fn the_interval_of_kendalls_w_is_that_of_the_noncentral_chi_square() {
    for (n, k, w, ends) in [
        (20, 3, 0.42, [0.096_338_352_5, 0.887_269_844_7]),
        (27, 4, 0.08, [0.0, 0.217_499_207_2]),
        (12, 5, 0.9, [0.391_010_674_1, 1.0]),
    ] {
        let own = kendall_w_interval(w, n, k).unwrap();
        for (own, known) in own.into_iter().zip(ends) {
            assert!((own - known).abs() < 1e-7, "{n} {k} {w}: {own} {known}");
        }
    }
    assert_eq!(kendall_w_interval(0.5, 1, 3), None);
}

#[test]
fn the_interval_of_d_z_covers_the_truth() {
    for (seed, truth, n) in [(1, 0.0, 10), (2, 0.5, 20), (3, 1.5, 12)] {
        let hits = covered(truth, seed, |stream| {
            let differences: Vec<f64> = (0..n).map(|_| truth + normal(stream)).collect();
            standardised_difference(&differences)
        });
        assert!((FEWEST_COVERED..=396).contains(&hits), "{truth} {n}: {hits} of {STUDIES}");
    }
}

/// Most differences are zero, as where ratings agree.
#[test]
fn the_interval_of_the_paired_dominance_covers_the_truth() {
    for (seed, up, down, n) in [(4, 0.3, 0.05, 20), (5, 0.15, 0.15, 40), (6, 0.8, 0.1, 16)] {
        let hits = covered(up - down, seed, |stream| {
            let difference =
                |at: f64| if at < up { 1.0 } else { -f64::from(u8::from(at < up + down)) };
            let differences: Vec<f64> = (0..n).map(|_| difference(stream.unit())).collect();
            paired_dominance(&differences)
        });
        assert!(hits >= FEWEST_COVERED, "{up} {down} {n}: {hits} of {STUDIES}");
    }
}

/// Normal groups a distance apart: delta = 2 Φ(distance / sqrt 2) - 1.
#[test]
fn the_interval_of_cliffs_delta_covers_the_truth() {
    for (seed, distance, m, n) in [(7, 0.0, 15, 15), (8, 0.8, 20, 12), (9, 1.6, 20, 20)] {
        let truth = 1.0 - libm::erfc(distance / 2.0);
        let hits = covered(truth, seed, |stream| {
            let mut group = |shift: f64, people: usize| -> Vec<f64> {
                (0..people).map(|_| shift + normal(stream)).collect()
            };
            let (a, b) = (group(distance, m), group(0.0, n));
            cliff_delta(&a, &b)
        });
        assert!(hits >= 355, "{distance}: {hits} of {STUDIES}");
    }
}

/// W of the population, from a study of 20,000 people; means a distance apart, noise with a standard deviation of
/// 1 / sqrt 3, people differing by 0.6 in how they respond to each level.
#[test]
fn the_interval_of_kendalls_w_covers_the_truth() {
    for (seed, distance, spread, n) in [(10, 0.0, 0.0, 12), (11, 0.5, 0.6, 20), (12, 1.0, 0.0, 20)]
    {
        let study = |stream: &mut Stream, people: usize| {
            let sd = (spread * spread + 1.0 / 3.0_f64).sqrt();
            let row = |stream: &mut Stream| {
                [-0.5, 0.0, 0.5].map(|at| at * distance + sd * normal(stream)).to_vec()
            };
            let blocks = Blocks {
                groups: ["a", "b", "c"].map(str::to_owned).to_vec(),
                blocks: vec![String::new(); people],
                responses: (0..people).map(|_| row(stream)).collect(),
                incomplete: 0,
                dropped: 0,
            };
            match friedman(&blocks) {
                Outcome::Ok(found) => found.kendalls_w,
                Outcome::Undefined { .. } => 0.0,
            }
        };
        let large = 20_000;
        let found = study(&mut Stream::new(seed, u64::MAX), large);
        let truth = ((large as f64 * found - 1.0) / (large as f64 - 1.0)).max(0.0);
        let hits =
            covered(truth, seed, |stream| Some(EffectSize::kendall_w(study(stream, n), n, 3)));
        assert!(hits >= FEWEST_COVERED, "{distance} {spread}: {hits} of {STUDIES}, W = {truth}");
    }
}

/// Two normal variables with a correlation of .6.
#[test]
fn intervals_of_correlations_cover_the_truth() {
    let truth: f64 = 0.6;
    // Pearson 1907: rho = 6 / π asin(r / 2) of normal variables.
    let of_ranks = 6.0 / std::f64::consts::PI * (truth / 2.0).asin();
    let pairs = |stream: &mut Stream| -> (Vec<f64>, Vec<f64>) {
        let pair = |stream: &mut Stream| {
            let x = normal(stream);
            (x, truth * x + (1.0 - truth * truth).sqrt() * normal(stream))
        };
        (0..30).map(|_| pair(stream)).unzip()
    };
    let number = |values: Vec<f64>| crate::table::Numbers { name: String::new(), values };
    let spearmans = covered(of_ranks, 13, |stream| {
        let (x, y) = pairs(stream);
        let rho = crate::test::spearman::spearman(&number(x), &number(y)).ok()?.ok()?.rho;
        Some(EffectSize::spearman(rho, 30))
    });
    let pearsons = covered(truth, 14, |stream| {
        let (x, y) = pairs(stream);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / 30.0;
        let (mx, my) = (mean(&x), mean(&y));
        let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            x.iter().zip(&y).map(|(x, y)| f(x - mx, y - my)).sum()
        };
        let r = sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt();
        Some(EffectSize::pearson(r, 30))
    });
    for hits in [spearmans, pearsons] {
        assert!(hits >= FEWEST_COVERED, "{hits} of {STUDIES}");
    }
}
