//! Squares and samples of one study: balanced against each other, and never without an order.

use std::collections::{BTreeMap, BTreeSet};

use mimique_study::{Draw, Issue, Study, check, order};
use serde_json::{Value, json};

use crate::support::small::{Numbers, clips, small_file};

const FOUR: [(&str, u8); 4] = [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2)];
const FIRST: [&str; 3] = ["joy1.m0", "joy2.m0", "fear1.m0"];
const ALL: [&str; 4] = ["joy", "fear", "anger", "disgust"];

fn study(file: &Value) -> Study {
    Study::from_value(file).unwrap()
}

/// How often each thing that participants see of a study comes up among the first so many.
fn counted<T: Ord>(
    file: &Value,
    participants: u64,
    seen: impl Fn(Vec<String>) -> T,
) -> BTreeMap<T, usize> {
    let study = study(file);
    let mut counts = BTreeMap::new();
    for participant in 0..participants {
        *counts.entry(seen(clips(&study, "h", participant))).or_default() += 1;
    }
    counts
}

fn square(components: Value) -> Value {
    json!({ "order": "latinSquare", "components": components })
}

#[test]
fn sibling_squares_show_all_combinations_equally_often() {
    let two = json!({ "order": "fixed", "components": [square(json!(["first"])), square(json!(["second"]))] });
    let file = small_file(5, &FOUR, 1, two);
    let orders = counted(&file, 4, |clips| (clips[0].clone(), clips[2].clone()));
    assert_eq!(orders.len(), 4, "{orders:?}");
    let orders = counted(&file, 40, |clips| (clips[0].clone(), clips[2].clone()));
    assert!(orders.values().all(|&times| times == 10), "{orders:?}");
}

#[test]
fn nested_squares_show_all_combinations_equally_often() {
    // Which half is first, and the order within each: eight.
    let nested = square(json!([square(json!(["first"])), square(json!(["second"]))]));
    let orders = counted(&small_file(5, &FOUR, 1, nested), 8, |clips| clips);
    assert_eq!(orders.len(), 8, "{orders:?}");
}

#[test]
fn a_sample_beside_a_square_is_balanced_against_it() {
    let both = json!({ "order": "fixed", "components": [
        square(json!(["first"])),
        { "order": "fixed", "components": ["second"], "numSamples": 1 },
    ] });
    for seed in 0..20 {
        let orders = counted(&small_file(seed, &FOUR, 1, both.clone()), 4, |clips| clips);
        assert_eq!(orders.len(), 4, "{orders:?}");
    }
}

/// Two of three clips are shown, in three samples, beside squares of two and of six rows: over 36
/// participants every combination comes up.
#[test]
fn samples_are_balanced_against_an_enclosing_square() {
    let clips = [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2), ("anger", 1), ("anger", 2)];
    let sampled = json!({ "order": "random", "components": ["first"], "numSamples": 2 });
    let both = square(json!([sampled, square(json!(["second"]))]));
    // First and second have three clips each: 3 samples, 6 rows of the inner square, 2 of the outer.
    for seed in 0..20 {
        let file = small_file(seed, &clips, 1, both.clone());
        let seen = counted(&file, 36, |clips| {
            let is_first = FIRST.contains(&clips[0].as_str());
            let shown: BTreeSet<&String> =
                clips.iter().filter(|clip| FIRST.contains(&clip.as_str())).collect();
            let others: Vec<&String> =
                clips.iter().filter(|clip| !FIRST.contains(&clip.as_str())).collect();
            format!("{is_first} {shown:?} {others:?}")
        });
        assert_eq!(seen.len(), 36, "{seen:?}");
    }
}

/// What passes the check gives everybody an order, however unlucky the samples of later cycles; each
/// part is shown equally often in every cycle, and the constraints hold.
#[test]
fn samples_under_constraints_have_an_order_for_everybody() {
    let (mut passed, mut uneven, mut refused) = (0, 0, 0);
    for seed in 0..400 {
        let mut numbers = Numbers(seed);
        let mut all: Vec<(&str, u8)> =
            ALL.iter().flat_map(|&kind| [1, 2, 3].map(|intensity| (kind, intensity))).collect();
        // Kinds of different sizes, so that some samples have too many of one.
        let count = 4 + numbers.below(8);
        while all.len() > count {
            all.remove(numbers.below(all.len() as u64));
        }
        let samples = 2 + numbers.below(count as u64 - 2);
        let alike = 1 + numbers.below(2);
        let distance = 1 + numbers.below(3);
        let file = small_file(
            seed,
            &all,
            1,
            json!({ "order": "random", "components": ["faces"], "numSamples": samples, "constraints": [
                { "factor": "expression", "atMostAlike": alike },
                { "factor": "expression", "minimumDistance": distance },
            ] }),
        );
        let report = check(&file.to_string(), &|_| Ok(()));
        let Some(checked) = report.study else {
            let codes: BTreeSet<&str> = report.issues.iter().map(|issue| issue.code()).collect();
            assert!(codes.contains("unsatisfiable-order"), "{codes:?}");
            refused += 1;
            continue;
        };
        passed += 1;
        uneven += usize::from(report.issues.iter().any(|issue| issue.code() == "uneven-samples"));
        let mut shown: BTreeMap<String, usize> = BTreeMap::new();
        let cycle = (1_usize..).find(|cycle| (cycle * samples).is_multiple_of(count)).unwrap();
        for participant in 0..200 {
            let clips = clips(checked.study(), checked.config_hash(), participant);
            assert_eq!(clips.len(), samples, "seed {seed}, participant {participant}");
            let kinds: Vec<&str> = clips
                .iter()
                .map(|clip| clip.trim_end_matches(".m0"))
                .map(|id| &id[..id.len() - 1])
                .collect();
            for run in kinds.windows(alike + 1) {
                assert!(
                    run.iter().any(|kind| *kind != run[0]),
                    "seed {seed}, {participant}: {kinds:?}"
                );
            }
            for (place, kind) in kinds.iter().enumerate() {
                let near = kinds[place + 1..].iter().take(distance - 1);
                assert!(!near.clone().any(|other| other == kind), "seed {seed}: {kinds:?}");
            }
            for clip in clips {
                *shown.entry(clip).or_default() += 1;
            }
            if (participant + 1).is_multiple_of(cycle as u64) {
                let each = (participant as usize + 1) * samples / count;
                assert!(
                    shown.len() == count && shown.values().all(|&times| times == each),
                    "{shown:?}"
                );
            }
        }
    }
    eprintln!("{passed} designs passed, {uneven} of them with a warning; {refused} were refused");
    assert!(passed > 100 && uneven > 20 && refused > 20, "{passed} {uneven} {refused}");
}

/// Three of six clips are joy: in one cycle of ten one participant would be shown these three.
#[test]
fn the_check_warns_where_samples_cannot_be_balanced() {
    let mut all: Vec<(&str, u8)> = vec![("joy", 1), ("joy", 2), ("joy", 3)];
    all.extend([("fear", 1), ("anger", 1), ("disgust", 1)]);
    let of = |seed| {
        let sequence = json!({ "order": "random", "components": ["faces"], "numSamples": 3,
            "constraints": [{ "factor": "expression", "atMostAlike": 1 }] });
        check(&small_file(seed, &all, 1, sequence).to_string(), &|_| Ok(()))
    };
    let reports = (0..20).map(of).filter(|report| report.study.is_some());
    let issues: Vec<Issue> = reports.flat_map(|report| report.issues).collect();
    let issue = issues.iter().find(|issue| issue.code() == "uneven-samples").expect("a warning");
    assert_eq!(issue.pointer, "/sequence/numSamples");
    assert!(issue.message().contains("of 20 rounds"), "{}", issue.message());
}

#[test]
fn samples_beyond_proof_are_refused_with_a_number_that_can_be_taken() {
    let mut sequence = json!({ "order": "random", "components": ["faces"], "numSamples": 250,
        "constraints": [{ "factor": "expression", "atMostAlike": 3 }] });
    let of = |sequence: &Value| {
        let mut file = small_file(1, &FOUR[..], 1, sequence.clone());
        // 1,012 trials.
        file["components"]["faces"]["repetitions"] = 253.into();
        check(&file.to_string(), &|_| Ok(()))
    };
    let report = of(&sequence);
    let issue = report.issues.iter().find(|issue| issue.code() == "too-many").unwrap();
    assert_eq!(issue.pointer, "/sequence/numSamples");
    assert!(issue.remedy().contains("divides 1012"), "{}", issue.remedy());
    sequence["numSamples"] = 253.into();
    let report = of(&sequence);
    let checked = report.study.expect("4 samples are proved");
    let draw =
        Draw { seed: 1, config_hash: checked.config_hash(), participant: 1_000, condition: None };
    assert!(order(&checked.study().projection(), draw).is_ok());
}
