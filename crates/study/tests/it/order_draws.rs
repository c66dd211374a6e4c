//! Orders: never against a constraint, uniform where the design says random.

use std::collections::BTreeMap;

use mimique_study::{Draw, OrderedItem, Study, order, parse};
use proptest::prelude::*;

use crate::support::small::{Limits, Numbers, has_an_order};
use crate::support::study_text;

/// The clips in the order of a participant.
fn clips(study: &Study, hash: &str, participant: u64) -> Vec<String> {
    let draw = Draw { seed: study.seed, config_hash: hash, participant, condition: None };
    let items = order(&study.projection(), draw).unwrap();
    items
        .into_iter()
        .filter_map(|item| match item {
            OrderedItem::Trial { clip, .. } => Some(clip),
            OrderedItem::Component { .. } => None,
        })
        .collect()
}

/// A study of `segments` x `methods` whose sequence is given.
fn small_study(segments: &[(&str, &str)], methods: &[&str], sequence: &str) -> Study {
    let segments: Vec<String> = segments
        .iter()
        .map(|(id, kind)| {
            format!(
                "{{ id: '{id}', capture: 'c', first: 0, end: 9, factors: {{ kind: '{kind}' }} }}"
            )
        })
        .collect();
    let methods: Vec<String> = methods
        .iter()
        .map(|id| format!("{id}: {{ method: 'box', factors: {{ method: '{id}' }} }}"))
        .collect();
    let text = format!(
        "{{ id: 's', studyMetadata: {{ title: 't', version: '1' }}, languages: ['en'], seed: 5,
            components: {{
              faces: {{ type: 'trials', questions: [] }},
              some: {{ type: 'trials', questions: [], clips: {{ where: {{ kind: ['a'] }} }} }},
              others: {{ type: 'trials', questions: [], clips: {{ where: {{ kind: ['b'] }} }} }},
              rest: {{ type: 'break', heading: 'h', text: 't' }},
            }},
            sequence: {sequence},
            stimuli: {{ avatars: {{ h: {{ builtin: {{}} }} }}, captures: {{ c: {{ file: 'x' }} }},
              segments: [{}], methods: {{ {} }} }} }}",
        segments.join(", "),
        methods.join(", ")
    );
    Study::from_value(&parse(&text).unwrap()).unwrap()
}

#[test]
fn order_depends_on_seed_hash_and_participant() {
    let study = Study::from_text(&study_text("demo.json")).unwrap();
    let draw = Draw { seed: 1, config_hash: "a", participant: 1, condition: None };
    let first = order(&study.projection(), draw).unwrap();
    assert_eq!(order(&study.projection(), draw).unwrap(), first);
    assert_ne!(order(&study.projection(), Draw { seed: 2, ..draw }).unwrap(), first);
    assert_ne!(order(&study.projection(), Draw { config_hash: "b", ..draw }).unwrap(), first);
    assert_ne!(order(&study.projection(), Draw { participant: 2, ..draw }).unwrap(), first);
}

#[test]
fn ten_thousand_orders_of_the_demo_keep_its_constraints() {
    let study = Study::from_text(&study_text("demo.json")).unwrap();
    for participant in 0..10_000 {
        let order = clips(&study, "hash", participant);
        assert_eq!(order.len(), 12);
        let parts: Vec<(&str, &str)> =
            order.iter().map(|clip| clip.split_once('.').unwrap()).collect();
        for pair in parts.windows(2) {
            assert_ne!(pair[0].0, pair[1].0, "participant {participant}: {order:?}");
        }
        for four in parts.windows(4) {
            assert!(four.iter().any(|part| part.1 != four[0].1), "{participant}: {order:?}");
        }
        let mut sorted = order.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len(), 12, "each clip once");
    }
}

/// Tight constraints, where shuffling hopes in vain: nine clips of three kinds, no kind within
/// three places of itself, so that only 3! x (3!)^3 of 9! orders are right (1 in 280).
#[test]
fn tight_constraints_are_kept_too() {
    let segments = [
        ("p", "x"),
        ("q", "x"),
        ("r", "x"),
        ("s", "y"),
        ("t", "y"),
        ("u", "y"),
        ("v", "z"),
        ("w", "z"),
        ("o", "z"),
    ];
    let study = small_study(
        &segments,
        &["box"],
        "{ order: 'random', components: ['faces'],
           constraints: [{ factor: 'kind', minimumDistance: 3 }] }",
    );
    let kinds: BTreeMap<&str, &str> = segments.into_iter().collect();
    let mut different = std::collections::BTreeSet::new();
    for participant in 0..500 {
        let order = clips(&study, "h", participant);
        let kind: Vec<&str> =
            order.iter().map(|clip| kinds[clip.split_once('.').unwrap().0]).collect();
        for (place, value) in kind.iter().enumerate() {
            assert!(!kind[place + 1..].iter().take(2).any(|later| later == value), "{kind:?}");
        }
        different.insert(order);
    }
    assert!(different.len() > 300, "{} different orders of 1,296", different.len());
}

#[test]
fn impossible_constraints_are_an_error_and_no_hang() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "x"), ("s", "y")],
        &["box"],
        "{ order: 'random', components: ['faces'], constraints: [{ factor: 'kind', atMostAlike: 1 }] }",
    );
    let draw = Draw { seed: 1, config_hash: "h", participant: 1, condition: None };
    let error = order(&study.projection(), draw).unwrap_err().to_string();
    assert!(error.starts_with("/sequence/constraints: no order of its 4 parts"), "{error}");
}

fn chi_square(counts: impl Iterator<Item = usize>, expected: f64) -> f64 {
    counts.map(|count| (count as f64 - expected).powi(2) / expected).sum()
}

/// Every order of four clips equally often (23 degrees of freedom; 49.73 is the 0.999 quantile).
#[test]
fn random_order_is_uniform() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "y"), ("s", "y")],
        &["box"],
        "{ order: 'random', components: ['faces'] }",
    );
    let mut counts: BTreeMap<Vec<String>, usize> = BTreeMap::new();
    for participant in 0..12_000 {
        *counts.entry(clips(&study, "h", participant)).or_default() += 1;
    }
    assert_eq!(counts.len(), 24);
    let statistic = chi_square(counts.into_values(), 500.0);
    assert!(statistic < 49.73, "{statistic}");
}

/// Under constraints too, every order that fits is equally likely: x and y alternate in 2 x 3! x 3!
/// = 72 of the 720 orders (71 degrees of freedom; 112.3 is the 0.999 quantile).
#[test]
fn constrained_order_is_uniform_over_the_orders_that_fit() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "x"), ("s", "y"), ("t", "y"), ("u", "y")],
        &["box"],
        "{ order: 'random', components: ['faces'], constraints: [{ factor: 'kind', atMostAlike: 1 }] }",
    );
    let mut counts: BTreeMap<Vec<String>, usize> = BTreeMap::new();
    for participant in 0..14_400 {
        *counts.entry(clips(&study, "h", participant)).or_default() += 1;
    }
    assert_eq!(counts.len(), 72);
    let statistic = chi_square(counts.into_values(), 200.0);
    assert!(statistic < 112.3, "{statistic}");
}

#[test]
fn latin_square_shows_each_clip_at_each_place_equally_often() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "y"), ("s", "y")],
        &["box"],
        "{ order: 'latinSquare', components: ['faces'] }",
    );
    let mut places: BTreeMap<(usize, String), usize> = BTreeMap::new();
    for participant in 0..8 {
        for (place, clip) in clips(&study, "h", participant).into_iter().enumerate() {
            *places.entry((place, clip)).or_default() += 1;
        }
    }
    assert_eq!(places.len(), 16);
    assert!(places.values().all(|&times| times == 2), "{places:?}");
}

#[test]
fn samples_show_each_clip_equally_often() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "y"), ("s", "y"), ("t", "y")],
        &["box", "other"],
        "{ order: 'random', components: ['faces'], numSamples: 4 }",
    );
    let mut shown: BTreeMap<String, usize> = BTreeMap::new();
    for participant in 0..5 {
        let order = clips(&study, "h", participant);
        assert_eq!(order.len(), 4);
        for clip in order {
            *shown.entry(clip).or_default() += 1;
        }
    }
    assert_eq!(shown.len(), 10);
    assert!(shown.values().all(|&times| times == 2), "{shown:?}");
}

/// Ten parts, four each: every cycle of five participants shows each part twice, and over a thousand
/// cycles the 45 pairs stand together equally often (44 degrees of freedom; 78.7 is the 0.999 quantile;
/// pairs of one block repel each other a little, which makes the statistic smaller, not larger).
#[test]
fn samples_show_each_pair_together_equally_often() {
    let study = small_study(
        &[("p", "x"), ("q", "x"), ("r", "y"), ("s", "y"), ("t", "y")],
        &["box", "other"],
        "{ order: 'random', components: ['faces'], numSamples: 4 }",
    );
    let mut pairs: BTreeMap<(String, String), usize> = BTreeMap::new();
    for participant in 0..5_000 {
        let mut order = clips(&study, "h", participant);
        order.sort();
        for (place, left) in order.iter().enumerate() {
            for right in &order[place + 1..] {
                *pairs.entry((left.clone(), right.clone())).or_default() += 1;
            }
        }
    }
    assert_eq!(pairs.len(), 45, "every pair");
    let expected = 5_000.0 * 6.0 / 45.0;
    let statistic = chi_square(pairs.into_values(), expected);
    assert!(statistic < 78.7, "{statistic}");
}

/// Orders of drawn designs, `MIMIQUE_ORDERS` of them (20,000 if not given; a million in the long
/// run): every constraint is kept, every clip comes as often as it should, nothing hangs. A design that
/// is refused has no order at all, as trying all of them shows where there are nine parts at most.
#[test]
fn a_million_orders_keep_their_constraints() {
    let wanted: u64 = std::env::var("MIMIQUE_ORDERS")
        .map_or(20_000, |text| text.parse().expect("MIMIQUE_ORDERS is a number"));
    let names = ["a", "b", "x", "y"];
    let all_ids: Vec<String> = (0..12).map(|index| format!("s{index}")).collect();
    let (mut drawn, mut design, mut impossible, mut decided) = (0, 0_u64, 0, 0);
    let mut longest = std::time::Duration::ZERO;
    while drawn < wanted {
        design += 1;
        let mut numbers = Numbers(design);
        let mut below = |bound| numbers.below(bound);
        let count = 1 + below(12);
        let kinds: Vec<&str> = (0..count).map(|_| names[below(4)]).collect();
        let methods = &["m0", "m1", "m2"][..1 + below(3)];
        let (alike, distance) = (1 + below(4), 1 + below(4));
        let segments: Vec<(&str, &str)> =
            all_ids.iter().map(String::as_str).zip(kinds.iter().copied()).collect();
        let sequence = format!(
            "{{ order: 'random', components: ['faces'], constraints: [
               {{ factor: 'kind', minimumDistance: {distance} }},
               {{ factor: 'method', atMostAlike: {alike} }} ] }}"
        );
        let study = small_study(&segments, methods, &sequence);
        let kind_of: BTreeMap<&str, &str> = segments.iter().copied().collect();
        for participant in 0..50 {
            let draw = Draw { seed: design, config_hash: "h", participant, condition: None };
            let begun = std::time::Instant::now();
            let ordered = order(&study.projection(), draw);
            longest = longest.max(begun.elapsed());
            let Ok(items) = ordered else {
                impossible += 1;
                if count * methods.len() <= 9 {
                    decided += 1;
                    let value = |kind: &&str, method: &&str| vec![(*kind).into(), (*method).into()];
                    let parts: Vec<Vec<String>> = kinds
                        .iter()
                        .flat_map(|kind| methods.iter().map(|m| value(kind, m)))
                        .collect();
                    let limits = [
                        Limits { at_most_alike: usize::MAX - 1, minimum_distance: distance },
                        Limits { at_most_alike: alike, minimum_distance: 1 },
                    ];
                    assert!(!has_an_order(&parts, &limits), "design {design} has an order");
                }
                break;
            };
            drawn += 1;
            let clips: Vec<&str> = items
                .iter()
                .filter_map(|item| match item {
                    OrderedItem::Trial { clip, .. } => Some(clip.as_str()),
                    OrderedItem::Component { .. } => None,
                })
                .collect();
            let parts: Vec<(&str, &str)> =
                clips.iter().map(|clip| clip.split_once('.').expect("segment.method")).collect();
            for (place, (segment, _)) in parts.iter().enumerate() {
                let near = parts[place + 1..].iter().take(distance - 1);
                let same = near.filter(|(other, _)| kind_of[other] == kind_of[segment]).count();
                assert_eq!(same, 0, "design {design}, participant {participant}: {clips:?}");
            }
            for run in parts.windows(alike + 1) {
                let mixed = run.iter().any(|(_, method)| *method != run[0].1);
                assert!(mixed, "design {design}, participant {participant}: {clips:?}");
            }
            let different: std::collections::BTreeSet<&&str> = clips.iter().collect();
            assert_eq!(different.len(), count * methods.len(), "each clip once");
        }
    }
    eprintln!(
        "{drawn} orders of {design} designs, {impossible} refused, {decided} of them decided by trying \
         all; longest {longest:?}"
    );
    assert!(drawn >= wanted && decided > 0 && impossible < design, "{impossible} of {design}");
}

#[test]
fn nested_sequences_stay_together_and_breaks_come_between() {
    let study = small_study(
        &[("p", "a"), ("q", "a"), ("r", "b"), ("s", "b"), ("t", "b")],
        &["box"],
        "{ order: 'random', interruptions: [{ component: 'rest', spacing: 2 }], components: [
           { id: 'first', order: 'random', components: ['some'] },
           { id: 'second', order: 'fixed', components: ['others'] } ] }",
    );
    let mut beginnings = std::collections::BTreeSet::new();
    for participant in 0..40 {
        let draw = Draw { seed: 5, config_hash: "h", participant, condition: None };
        let items = order(&study.projection(), draw).unwrap();
        let mut line = String::new();
        for item in &items {
            match item {
                OrderedItem::Trial { condition, .. } => line.push_str(&condition[..1]),
                OrderedItem::Component { component } => {
                    assert_eq!(component, "rest");
                    line.push('-');
                }
            }
        }
        assert!(line == "ff-ss-s" || line == "ss-sf-f", "{line}");
        beginnings.insert(line);
    }
    assert_eq!(beginnings.len(), 2, "both come up");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Any small design with any constraint gives an order that keeps it, or an error; never a hang.
    #[test]
    fn any_order_keeps_its_constraints(
        kinds in proptest::collection::vec(0_usize..4, 1..14),
        methods in 1_usize..4,
        alike in 1_usize..4,
        distance in 1_usize..5,
        participant in any::<u64>(),
    ) {
        let names = ["a", "b", "x", "y"];
        let ids: Vec<String> = (0..kinds.len()).map(|index| format!("s{index}")).collect();
        let segments: Vec<(&str, &str)> =
            ids.iter().zip(&kinds).map(|(id, &kind)| (id.as_str(), names[kind])).collect();
        let sequence = format!(
            "{{ order: 'random', components: ['faces'], constraints: [
               {{ factor: 'kind', minimumDistance: {distance} }},
               {{ factor: 'method', atMostAlike: {alike} }} ] }}"
        );
        let study = small_study(&segments, &["m0", "m1", "m2"][..methods], &sequence);
        let draw = Draw { seed: 3, config_hash: "h", participant, condition: None };
        let Ok(items) = order(&study.projection(), draw) else { return Ok(()) };
        let kind_of: BTreeMap<&str, &str> = segments.iter().copied().collect();
        let trials: Vec<(&str, String)> = items.iter().filter_map(|item| match item {
            OrderedItem::Trial { clip, .. } => {
                let (segment, method) = clip.split_once('.')?;
                Some((kind_of[segment], method.to_owned()))
            }
            OrderedItem::Component { .. } => None,
        }).collect();
        prop_assert_eq!(trials.len(), kinds.len() * methods);
        for (place, (kind, _)) in trials.iter().enumerate() {
            prop_assert!(!trials[place + 1..].iter().take(distance - 1).any(|later| later.0 == *kind));
        }
        for run in trials.windows(alike + 1) {
            prop_assert!(run.iter().any(|(_, method)| *method != run[0].1));
        }
    }
}
