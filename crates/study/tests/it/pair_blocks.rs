//! Blocks of pairs: who is shown which pairs, in which order, on which side.

use std::collections::{BTreeMap, BTreeSet};

use mimique_study::{Draw, OrderedItem, Study, config_hash, order};
use mimique_test_support::study_text;
use serde_json::{Value, json};

fn study(change: impl FnOnce(&mut Value)) -> Study {
    let mut value = mimique_study::parse(&study_text("pairs.json")).unwrap();
    change(&mut value);
    Study::from_value(&value).unwrap()
}

/// Trial, left clip, right clip of each pair that a slot is shown.
fn shown(study: &Study, slot: u64) -> Vec<(String, String, String)> {
    let hash = config_hash(&serde_json::to_value(study).unwrap());
    let draw = Draw { seed: study.seed, config_hash: &hash, participant: slot, condition: None };
    let items = order(&study.projection(), draw).unwrap();
    let pair = |item| match item {
        OrderedItem::Trial { trial, clip, beside: Some(beside), .. } => Some((trial, clip, beside)),
        _ => None,
    };
    items.into_iter().filter_map(pair).collect()
}

fn method(clip: &str) -> &str {
    clip.split_once('.').unwrap().1
}

fn segment(clip: &str) -> &str {
    clip.split_once('.').unwrap().0
}

#[test]
fn a_share_of_the_pairs_is_dealt_evenly_over_people_and_within_each() {
    let study = study(|_| ());
    let mut pairs: BTreeMap<(String, bool), usize> = BTreeMap::new();
    let mut one_row: Option<BTreeSet<String>> = None;
    // 36 pairs, 12 each: three slots show all, six show all in both orders.
    for slot in 0..12 {
        let shown = shown(&study, slot);
        assert_eq!(shown.len(), 12);
        let mut of_method: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
        for (trial, left, right) in &shown {
            assert_eq!(segment(left), segment(right), "a pair is of one segment");
            assert_ne!(method(left), method(right));
            of_method.entry(method(left)).or_default()[0] += 1;
            of_method.entry(method(right)).or_default()[1] += 1;
            *pairs.entry((trial.clone(), left < right)).or_default() += 1;
        }
        for [left, right] in of_method.values() {
            assert_eq!(left + right, 6, "each of four methods in six of twelve pairs");
            assert!(left.abs_diff(*right) <= 1, "{of_method:?}");
        }
        let row: BTreeSet<String> = shown.iter().map(|each| each.0.clone()).collect();
        assert_eq!(row.len(), 12, "no pair twice");
        // The segments of neighbours differ, as the constraint of the file says.
        assert!(shown.windows(2).all(|two| segment(&two[0].1) != segment(&two[1].1)));
        one_row.get_or_insert(row);
    }
    assert_eq!(pairs.len(), 72, "36 pairs in both orders");
    assert!(pairs.values().all(|times| *times == 2), "{pairs:?}");
}

#[test]
fn every_pair_is_shown_to_everybody_by_default_and_sides_change_from_slot_to_slot() {
    let all = study(|value| {
        value["components"]["duels"].as_object_mut().unwrap().remove("schedule");
    });
    let [one, other] = [0, 1].map(|slot| shown(&all, slot));
    let orders = |shown: &[(String, String, String)]| -> BTreeSet<(String, String)> {
        shown.iter().map(|(_, left, right)| (left.clone(), right.clone())).collect()
    };
    let exchanged: BTreeSet<_> = orders(&other).into_iter().map(|(l, r)| (r, l)).collect();
    assert_eq!((orders(&one).len(), orders(&one)), (36, exchanged));
    let names = |shown: &[(String, String, String)]| -> BTreeSet<String> {
        shown.iter().map(|each| each.0.clone()).collect()
    };
    assert_eq!(names(&one), names(&other), "a trial has one name, whatever its sides");
}

#[test]
fn any_factor_is_compared_between_the_levels_that_are_named() {
    let expressions = study(|value| {
        let block = &mut value["components"]["duels"];
        block["compare"] = json!("expression");
        block["levels"] = json!(["joy", "fear", "anger"]);
        block["within"] = json!(["method"]);
        block["schedule"] = json!({ "rule": "all" });
        value["sequence"]["constraints"] = json!([]);
    });
    let shown = shown(&expressions, 0);
    // Three pairs of expressions by each of four methods.
    assert_eq!(shown.len(), 12);
    assert!(shown.iter().all(|(_, left, right)| method(left) == method(right)));
    let segments: BTreeSet<&str> =
        shown.iter().flat_map(|(_, left, right)| [segment(left), segment(right)]).collect();
    assert_eq!(segments, BTreeSet::from(["anger2", "fear2", "joy2"]));
}

#[test]
fn the_page_is_sent_trials_and_no_rule() {
    let projection = serde_json::to_value(study(|_| ()).projection()).unwrap();
    let block = &projection["components"]["duels"];
    assert_eq!(block["type"], "trials");
    assert_eq!(block["questions"], json!(["better", "why"]));
    assert_eq!(block["pairs"]["slots"].as_array().unwrap().len(), 3);
}
