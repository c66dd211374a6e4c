//! Conditions between participants: who is shown what, and what every row says of it.

use std::collections::BTreeMap;

use mimique_study::{
    Draw, OrderedItem, Study, check, config_hash, drawn_condition, order, text::words,
};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::support::small::{Limits, keeps_to, small_file};

const CLIPS: [(&str, u8); 6] =
    [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2), ("anger", 1), ("anger", 2)];

/// A condition that shows a block in a drawn order, no expression three times in a row.
fn condition(id: &str, block: &str) -> Value {
    json!({ "id": id, "conditional": true, "order": "random", "components": [block],
        "constraints": [{ "factor": "expression", "atMostAlike": 2 }] })
}

fn read(file: &Value) -> (Study, String) {
    let report = check(&file.to_string(), &|_| Ok(()));
    assert!(report.study.is_some() && report.issues.is_empty(), "{:?}", report.issues);
    (Study::from_value(file).unwrap(), config_hash(file))
}

fn drawn(study: &Study, hash: &str, slot: u64, condition: Option<&str>) -> Vec<OrderedItem> {
    let draw = Draw { seed: study.seed, config_hash: hash, participant: slot, condition };
    order(&study.projection(), draw).unwrap()
}

/// Clips by component, the components that are no trials as themselves, in the order drawn.
fn shown(items: &[OrderedItem]) -> BTreeMap<&str, Vec<&str>> {
    let mut shown: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for item in items {
        let (component, clip) = match item {
            OrderedItem::Trial { component, clip, .. } => (component, clip),
            OrderedItem::Component { component } => (component, component),
        };
        shown.entry(component).or_default().push(clip);
    }
    shown
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Whatever the order around them, a condition shows its own blocks and what everybody is shown,
    /// each once, and its order keeps to its constraints.
    #[test]
    fn a_condition_shows_its_own_and_no_other(
        seed in 0_u64..1_000_000,
        rule in prop::sample::select(vec!["fixed", "random", "latinSquare"]),
        blocks in prop::collection::vec(prop::sample::select(vec!["faces", "first", "second"]), 2..5),
        place in 0_usize..5,
        slot in 1_u64..200,
    ) {
        let mut parts: Vec<Value> = blocks
            .iter()
            .enumerate()
            .map(|(index, block)| condition(&format!("c{index}"), block))
            .collect();
        parts.insert(place.min(parts.len()), json!("rest"));
        let mut file = small_file(seed, &CLIPS, 1, json!({ "order": rule, "components": parts }));
        for name in ["faces", "first", "second"] {
            if !blocks.contains(&name) {
                file["components"].as_object_mut().unwrap().remove(name);
            }
        }
        let (study, hash) = read(&file);
        for (index, block) in blocks.iter().enumerate() {
            let items = drawn(&study, &hash, slot, Some(&format!("c{index}")));
            let shown = shown(&items);
            let clips = &shown[block];
            let keys: Vec<&str> = shown.keys().copied().collect();
            let mut expected = vec![*block, "rest"];
            expected.sort_unstable();
            prop_assert_eq!(keys, expected);
            let half = match *block {
                "faces" => &CLIPS[..],
                "first" => &CLIPS[..3],
                _ => &CLIPS[3..],
            };
            let mut wanted: Vec<String> = half.iter().map(|(e, i)| format!("{e}{i}.m0")).collect();
            wanted.sort();
            let mut sorted = clips.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, wanted);
            let values: Vec<[String; 1]> =
                clips.iter().map(|clip| [clip[..clip.len() - 4].to_owned()]).collect();
            let limits = [Limits { at_most_alike: 2, minimum_distance: 1 }];
            prop_assert!(keeps_to(&values, &limits));
            prop_assert_eq!(&shown["rest"], &["rest"]);
        }
        // Who is in none of them is shown what everybody is.
        let items = drawn(&study, &hash, slot, None);
        prop_assert_eq!(shown(&items).keys().copied().collect::<Vec<_>>(), ["rest"]);
    }
}

/// Where conditions have no squares or samples of their own, what everybody is shown comes in the same
/// order for the same slot; within a condition slots are balanced as in a study without conditions.
#[test]
fn conditions_share_the_orders_of_what_they_share() {
    let square = json!({ "order": "latinSquare", "components": ["first"] });
    let arms = [
        json!({ "id": "rested", "conditional": true, "order": "fixed", "components": ["rest"] }),
        json!({ "id": "control", "conditional": true, "order": "fixed", "components": [] }),
    ];
    let parts = json!({ "order": "fixed", "components": [arms[0], square, arms[1]] });
    let mut file = small_file(3, &CLIPS, 1, parts);
    for unused in ["faces", "second"] {
        file["components"].as_object_mut().unwrap().remove(unused);
    }
    let (study, hash) = read(&file);
    assert_eq!(study.conditions(), ["rested", "control"]);
    let mut places = BTreeMap::new();
    for slot in 1..=6 {
        let [rested, control] =
            ["rested", "control"].map(|name| drawn(&study, &hash, slot, Some(name)));
        assert_eq!(rested[1..], control[..]);
        assert!(matches!(&rested[0], OrderedItem::Component { component } if component == "rest"));
        for (place, clip) in shown(&control)["first"].iter().enumerate() {
            *places.entry((place, (*clip).to_owned())).or_insert(0) += 1;
        }
    }
    assert_eq!(places.len(), 9);
    assert!(places.values().all(|times| *times == 2), "{places:?}");
}

#[test]
fn an_address_can_only_name_what_there_is() {
    let arms = ["plain", "with-hint"].map(|id| condition(id, "faces"));
    let file = small_file(1, &CLIPS, 1, json!({ "order": "fixed", "components": arms }));
    let study = Study::from_value(&file).unwrap();
    assert_eq!(study.sequence.conditions_for(None).unwrap(), ["plain", "with-hint"]);
    assert_eq!(study.sequence.conditions_for(Some("with-hint")).unwrap(), ["with-hint"]);
    for name in ["Plain", "plain,with-hint", "", "{conditions}"] {
        let unknown = study.sequence.conditions_for(Some(name)).unwrap_err();
        assert_eq!(unknown.name, name);
        assert_eq!(
            unknown.to_string(),
            format!("there is no condition {name:?}; the study has: plain, with-hint")
        );
        for (language, sentence) in [
            ("en", "The address asks for the condition “{}”; "),
            ("fr", "L’adresse demande la condition «\u{a0}{}\u{a0}»"),
        ] {
            let (message, remedy) = words(language).unknown_condition(&unknown);
            assert!(message.starts_with(&sentence.replace("{}", name)), "{message}");
            assert!(message.ends_with("plain, with-hint."), "{message}");
            assert!(!remedy.is_empty());
        }
    }
    // Nor is it passed over where there is none.
    let file = small_file(1, &CLIPS, 1, json!({ "order": "fixed", "components": ["faces"] }));
    let study = Study::from_value(&file).unwrap();
    assert_eq!(study.sequence.conditions_for(None).unwrap(), Vec::<&str>::new());
    let unknown = study.sequence.conditions_for(Some("plain")).unwrap_err();
    assert!(words("en").unknown_condition(&unknown).0.ends_with("has: –."), "{unknown}");
}

#[test]
fn where_nobody_counts_each_condition_is_equally_likely() {
    let names = ["a", "b", "c"];
    let mut counts = BTreeMap::new();
    for participant in 0..3000 {
        let draw = Draw { seed: 1, config_hash: "h", participant, condition: None };
        *counts.entry(drawn_condition(draw, &names).unwrap()).or_insert(0.0) += 1.0;
        assert_eq!(drawn_condition(draw, &names), drawn_condition(draw, &names));
    }
    let chi_square: f64 = counts.values().map(|n: &f64| (n - 1000.0).powi(2) / 1000.0).sum();
    // 2 degrees of freedom: 13.8 is the 0.999 quantile; the seed is fixed.
    assert!(counts.len() == 3 && chi_square < 13.8, "{counts:?}");
    let draw = Draw { seed: 1, config_hash: "h", participant: 1, condition: None };
    assert_eq!(drawn_condition(draw, &[]), None);
}
