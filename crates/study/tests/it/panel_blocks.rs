//! Blocks of panels: which clips stand on a page, at which places.

use std::collections::{BTreeMap, BTreeSet};

use mimique_study::{Draw, OrderedItem, Study, config_hash, order};
use mimique_test_support::study_text;
use serde_json::{Value, json};

fn study(change: impl FnOnce(&mut Value)) -> Study {
    let mut value = mimique_study::parse(&study_text("panel.json")).unwrap();
    change(&mut value);
    Study::from_value(&value).unwrap()
}

/// The trial of each page that a slot is shown, and its clips from the first place to the last.
fn shown(study: &Study, slot: u64) -> Vec<(String, Vec<String>)> {
    let hash = config_hash(&serde_json::to_value(study).unwrap());
    let draw = Draw { seed: study.seed, config_hash: &hash, participant: slot, condition: None };
    let items = order(&study.projection(), draw).unwrap();
    let page = |item| match item {
        OrderedItem::Trial { trial, clip, panel, .. } => {
            assert_eq!(Some(&clip), panel.first());
            Some((trial, panel))
        }
        OrderedItem::Component { .. } => None,
    };
    items.into_iter().filter_map(page).collect()
}

#[test]
fn every_page_has_every_condition_once_and_places_are_drawn() {
    let study = study(|_| ());
    let mut first: BTreeMap<String, usize> = BTreeMap::new();
    let mut orders = BTreeSet::new();
    for slot in 0..200 {
        let pages = shown(&study, slot);
        assert_eq!(pages.len(), 6, "a page for each segment");
        for (trial, clips) in pages {
            let conditions: BTreeSet<&str> =
                clips.iter().map(|clip| clip.split_once('.').unwrap().1).collect();
            let segments: BTreeSet<&str> =
                clips.iter().map(|clip| clip.split_once('.').unwrap().0).collect();
            assert_eq!(conditions.len(), 5, "{clips:?}");
            assert_eq!(segments.len(), 1, "{clips:?}");
            assert_eq!(trial, format!("quality/{}|head", segments.first().unwrap()));
            *first.entry(clips[0].split_once('.').unwrap().1.to_owned()).or_default() += 1;
            orders.insert(
                clips
                    .iter()
                    .map(|clip| clip.split_once('.').unwrap().1.to_owned())
                    .collect::<Vec<_>>(),
            );
        }
    }
    // Each of five conditions first in a fifth of 1200 pages: 240 with a standard deviation of 14.
    assert!(first.values().all(|count| count.abs_diff(240) < 60), "{first:?}");
    assert_eq!(orders.len(), 120, "every order comes about");
    assert_eq!(shown(&study, 7), shown(&study, 7));
}

#[test]
fn levels_and_clips_restrict_a_page() {
    let study = study(|value| {
        value["components"]["quality"]["levels"] = json!(["lsts", "recorded", "slow"]);
        value["components"]["quality"]["clips"] = json!({"where": {"segment": ["joy2", "fear2"]}});
    });
    let pages = shown(&study, 0);
    assert_eq!(pages.len(), 2);
    assert!(pages.iter().all(|(_, clips)| clips.len() == 3));
}
