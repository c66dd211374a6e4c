//! Planted spans, false positives, all draws of few people, and the command.

use mimique_test_support::Random;

use super::*;
use crate::procedure::arguments::Arguments;
use crate::table::Table;

const OPTIONS: ClusterPermutationOptions = ClusterPermutationOptions { permutations: 999, seed: 1 };

/// Courses that stay near themselves from one instant to the next, raised by `effect` in a span.
fn courses(
    people: usize,
    instants: usize,
    effect: f64,
    span: [usize; 2],
    random: &mut Random,
) -> Vec<Vec<f64>> {
    let mut course = || {
        let mut state = random.normal();
        (0..instants)
            .map(|instant| {
                state = 0.8 * state + 0.6 * random.normal();
                state + if (span[0]..=span[1]).contains(&instant) { effect } else { 0.0 }
            })
            .collect()
    };
    (0..people).map(|_| course()).collect()
}

fn tested(differences: &[Vec<f64>], options: ClusterPermutationOptions) -> ClusterPermutation {
    cluster_permutation(differences, options).unwrap().ok().unwrap()
}

#[test]
fn a_planted_span_is_found_and_mirrors() {
    let data = courses(24, 100, 1.5, [30, 60], &mut Random::new(4));
    let found = tested(&data, OPTIONS);
    let own = found.clusters.iter().max_by(|a, b| a.mass.abs().total_cmp(&b.mass.abs())).unwrap();
    assert!(own.p <= 0.001 && own.mass > found.critical_mass, "{own:?}");
    assert!(own.first.abs_diff(30) <= 3 && own.last.abs_diff(60) <= 3, "{own:?}");
    for other in found.clusters.iter().filter(|other| *other != own) {
        assert!(other.p > 0.05, "{other:?}");
    }
    let mirrored: Vec<Vec<f64>> =
        data.iter().map(|own| own.iter().map(|value| -value).collect()).collect();
    let other = tested(&mirrored, OPTIONS);
    assert_eq!(other.critical_mass, found.critical_mass);
    for (a, b) in found.clusters.iter().zip(&other.clusters) {
        assert_eq!((a.first, a.last, a.mass, a.p), (b.first, b.last, -b.mass, b.p));
    }
    // One more course that is shorter shortens all.
    let mut shorter = data;
    shorter[0].truncate(50);
    assert_eq!(tested(&shorter, OPTIONS).instants, 50);
}

#[test]
fn where_nothing_differs_one_in_twenty_is_positive() {
    let mut random = Random::new(8);
    let options = ClusterPermutationOptions { permutations: 199, seed: 3 };
    let runs = 600;
    let positive = (0..runs)
        .filter(|_| {
            let found = tested(&courses(12, 60, 0.0, [0, 0], &mut random), options);
            found.clusters.iter().any(|own| own.p <= 0.05)
        })
        .count();
    // 30 expected, standard deviation 5.3; somewhat fewer, as not every run has a cluster.
    assert!((12..=46).contains(&positive), "{positive} of {runs}");
}

#[test]
fn draws_come_near_all_changes_of_sign() {
    let data = courses(7, 30, 2.0, [5, 20], &mut Random::new(2));
    let options = ClusterPermutationOptions { permutations: 20_000, seed: 5 };
    let found = tested(&data, options);
    let largest = of_all_changes_of_sign(&data, found.threshold_t);
    assert!(!found.clusters.is_empty());
    for own in &found.clusters {
        let exact = share_reached(&largest, own.mass);
        assert!((own.p - exact).abs() < 0.015, "{own:?}, of all {exact}");
    }
}

/// The largest |mass| with each change of the signs of people's differences, that of none among them.
fn of_all_changes_of_sign(data: &[Vec<f64>], threshold: f64) -> Vec<f64> {
    let people = data.len();
    let changed = |signs: u32| {
        let sign = |person: usize| if signs >> person & 1 == 1 { -1.0 } else { 1.0 };
        let t: Vec<f64> = (0..data[0].len())
            .map(|instant| {
                let own: Vec<f64> =
                    (0..people).map(|person| sign(person) * data[person][instant]).collect();
                let (mean, variance) = crate::moments(&own);
                mean / (variance.unwrap() / people as f64).sqrt()
            })
            .collect();
        clusters(&t, threshold).iter().fold(0.0_f64, |most, (_, mass)| most.max(mass.abs()))
    };
    (0..1_u32 << people).map(changed).collect()
}

fn share_reached(largest: &[f64], mass: f64) -> f64 {
    let reached = largest.iter().filter(|own| **own >= mass.abs() - 1e-9).count();
    reached as f64 / largest.len() as f64
}

/// Differences of eight people at 24 instants, in tenths: more from the seventh to the fourteenth instant, less from the
/// nineteenth to the twenty-second.
const TENTHS: [[i32; 24]; 8] = [
    [8, 14, 8, 5, 1, 4, 16, 20, 7, 18, 16, 20, 18, 14, 4, 8, 5, 3, -2, -9, -18, -14, -8, -18],
    [
        -9, -15, -21, -16, -8, -8, 3, 7, 12, 11, 14, 20, 18, 12, 1, 2, 9, -1, -14, -18, -26, -22,
        -7, -10,
    ],
    [16, 17, 16, 18, 7, 9, 24, 11, 14, 12, 17, 13, 13, 15, -3, 1, 0, 3, -10, -3, -1, -3, 8, 14],
    [5, 9, 10, 8, 0, 8, 11, 15, 23, 11, 10, 2, 6, 17, 15, 1, -2, 2, 2, 3, -4, -3, 4, 2],
    [
        -4, -1, -1, -2, -10, -11, 12, 11, 3, 13, 16, 28, 25, 20, -3, 6, 20, 11, -4, -2, -8, -10,
        -3, -1,
    ],
    [
        9, 13, 8, 8, -6, -14, 7, 4, 10, 14, 21, 25, 28, 25, 5, 0, -3, -9, -20, -18, -15, -16, -17,
        -14,
    ],
    [8, 10, 4, -1, 11, 14, 35, 43, 32, 31, 30, 30, 30, 28, 13, 1, 0, -5, -12, -14, -9, -4, 6, 6],
    [-2, -3, -5, -2, -1, 2, 7, 14, 9, 5, 6, 4, 7, 5, -13, -15, -4, -3, -19, -17, -24, -11, -10, -5],
];

/// `mne.stats.permutation_cluster_1samp_test` of MNE-Python 1.13.2 (NumPy 2.4.6, SciPy 1.17.1) of the same differences,
/// with `threshold=scipy.stats.t.ppf(0.975, 7)`, `n_permutations=256`, `tail=0`, `adjacency=None`: all 128 changes of sign that
/// are not each other's mirror image. First and last instant, mass, p.
///
/// The definitions differ in this: MNE goes through all changes of sign where there are no more than draws, and counts
/// mirror images once, which gives the same p; here signs are always drawn, and p = (1 + reached) / (1 + draws), which is
/// MNE's where it draws one less and counts the data as one of its draws. With `n_permutations="all"` MNE 1.13.2 leaves one of the
/// 128 out: its p are 1/127 and 4/127. The floor of the spread ([`LEAST_SPREAD`]) is no part of MNE's statistic; here it
/// is not reached. There is no F test of several courses: every two are compared.
const OF_MNE: [([usize; 2], f64, f64); 2] = [
    ([6, 13], 40.314_805_392_761_71, 1.0 / 128.0),
    ([18, 21], -15.185_547_709_052_113, 4.0 / 128.0),
];

#[test]
fn clusters_masses_and_p_are_those_of_mne() {
    let data = TENTHS.map(|own| own.map(|tenths| f64::from(tenths) / 10.0).to_vec());
    let options = ClusterPermutationOptions { permutations: 20_000, seed: 7 };
    let found = tested(&data, options);
    assert!((found.threshold_t - 2.364_624_251_592_784).abs() < 1e-12);
    assert_eq!(found.clusters.len(), OF_MNE.len());
    let largest = of_all_changes_of_sign(&data, found.threshold_t);
    for (own, ([first, last], mass, p)) in found.clusters.iter().zip(OF_MNE) {
        assert_eq!([own.first, own.last], [first, last]);
        assert!((own.mass - mass).abs() < 1e-10, "{} {mass}", own.mass);
        assert_eq!(share_reached(&largest, own.mass), p);
        // Four standard errors of 20 000 draws.
        let error = 4.0 * (p * (1.0 - p) / 20_000.0).sqrt();
        assert!((own.p - p).abs() < error, "{own:?}, of all {p}");
    }
}

#[test]
fn what_cannot_be_told_is_undefined_or_refused() {
    let one = vec![vec![1.0, 2.0]];
    assert!(cluster_permutation(&one, OPTIONS).unwrap().reason().is_some());
    assert!(cluster_permutation(&[Vec::new(), Vec::new()], OPTIONS).unwrap().reason().is_some());
    let few = ClusterPermutationOptions { permutations: 18, seed: 1 };
    assert!(cluster_permutation(&one, few).is_err());
    // Nobody moves at first; then all by the same.
    let same = vec![vec![0.0, 0.0, 2.0, 2.0]; 8];
    let found = tested(&same, OPTIONS);
    assert_eq!(&found.t[..2], [0.0, 0.0]);
    assert!(found.t.iter().all(|t| t.is_finite()));
    assert_eq!((found.clusters.len(), found.clusters[0].first), (1, 2));
    // Two of 256 changes of sign.
    assert!(found.clusters[0].p < 0.025, "{:?}", found.clusters);
}

#[test]
fn an_instant_at_which_all_differ_by_one_small_step_does_not_outweigh_the_others() {
    let mut data = courses(12, 60, 1.2, [20, 40], &mut Random::new(3));
    let before = tested(&data, OPTIONS);
    let largest = |found: &ClusterPermutation| {
        found.clusters.iter().fold(0.0, |m: f64, c| m.max(c.mass.abs()))
    };
    data.iter_mut().for_each(|own| own[0] = 0.01);
    let after = tested(&data, OPTIONS);
    assert!(largest(&after) < 1.1 * largest(&before), "{:?}", after.clusters);
}

#[test]
fn the_command_takes_rows_in_any_order_and_leaves_out_who_has_gaps() {
    let data = courses(10, 20, 2.0, [5, 15], &mut Random::new(6));
    let mut rows = Vec::new();
    for (person, course) in data.iter().enumerate() {
        for (instant, difference) in course.iter().enumerate() {
            let time = instant as f64 / 10.0;
            rows.push(format!("p{person},slow,{time},{difference}"));
            rows.push(format!("p{person},zero,{time},0"));
        }
    }
    rows.push("gap,slow,0,1".to_owned());
    rows.reverse();
    let csv = format!("who,what,when,how\n{}\n", rows.join("\n"));
    let table = Table::parse(csv.into_bytes()).unwrap();
    let given = [("participant", "who"), ("condition", "what"), ("time", "when"), ("value", "how")];
    let given = given.map(|(option, column)| (option.to_owned(), vec![column.to_owned()]));
    let arguments = Arguments::new(given);
    let answer = (PROCEDURE.run)(&table, &arguments).unwrap();
    assert!(answer.text.contains("10 people, 1 without"), "{}", answer.text);
    assert!(answer.text.contains("slow - zero"), "{}", answer.text);
    let options = ClusterPermutationOptions { permutations: 5000, seed: 1 };
    let found = tested(&data, options);
    let json = serde_json::to_string_pretty(&Outcome::Ok::<_>(found)).unwrap();
    assert_eq!(answer.json.matches("\"mass\"").count(), json.matches("\"mass\"").count());
}
