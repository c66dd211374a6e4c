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
    let threshold = found.threshold_t;
    let all: Vec<f64> = (0..1_u32 << 7)
        .map(|signs| {
            let sign = |person: usize| if signs >> person & 1 == 1 { -1.0 } else { 1.0 };
            let t: Vec<f64> = (0..30)
                .map(|instant| {
                    let own: Vec<f64> =
                        (0..7).map(|person| sign(person) * data[person][instant]).collect();
                    let (mean, variance) = crate::moments(&own);
                    mean / (variance.unwrap() / 7.0).sqrt()
                })
                .collect();
            clusters(&t, threshold).iter().fold(0.0_f64, |most, (_, mass)| most.max(mass.abs()))
        })
        .collect();
    assert!(!found.clusters.is_empty());
    for own in &found.clusters {
        let reached = all.iter().filter(|mass| **mass >= own.mass.abs() - 1e-9).count();
        let exact = reached as f64 / all.len() as f64;
        assert!((own.p - exact).abs() < 0.015, "{own:?}, of all {exact}");
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
