//! Small studies whose sequence a test gives.

use mimique_study::{Draw, OrderedItem, Study, order};
use serde_json::{Value, json};

use super::study_text;

/// A study that passes the check whatever its `sequence` leaves to it: a clip for each
/// `(expression, intensity)` by each of so many methods (`joy2.m0`), shown by the component `faces`;
/// `first` and `second` show the clips of one half of the segments each, and `rest` is a break.
pub fn small_file(seed: u64, clips: &[(&str, u8)], methods: usize, sequence: Value) -> Value {
    let mut file = mimique_study::parse(&study_text("invalid/unsatisfiable-order.json")).unwrap();
    let id = |(expression, intensity): &(&str, u8)| format!("{expression}{intensity}");
    let segments = clips.iter().map(|clip| {
        let performance = json!({ "expression": clip.0, "intensity": clip.1 });
        json!({ "id": id(clip), "capture": "actor", "performance": performance })
    });
    file["stimuli"]["segments"] = segments.collect();
    file["stimuli"]["methods"] = ["box", "nnls"][..methods]
        .iter()
        .enumerate()
        .map(|(index, method)| (format!("m{index}"), json!({ "method": method })))
        .collect();
    let block = |clips: &[(&str, u8)]| {
        let of = |method| clips.iter().map(move |clip| format!("{}.m{method}", id(clip)));
        let ids: Vec<String> = (0..methods).flat_map(of).collect();
        json!({ "type": "trials", "questions": ["rating"], "clips": { "ids": ids } })
    };
    let half = clips.len().div_ceil(2);
    let rest = json!({ "type": "break", "heading": file["studyMetadata"]["title"].clone(),
        "text": file["studyMetadata"]["title"].clone() });
    file["components"] = json!({
        "faces": block(clips),
        "first": block(&clips[..half]),
        "second": block(&clips[half..]),
        "rest": rest,
    });
    file["questions"].as_array_mut().unwrap().remove(0);
    file["hypotheses"] = json!([]);
    file["seed"] = seed.into();
    file["sequence"] = sequence;
    file
}

/// The clips of a participant, in order.
pub fn clips(study: &Study, hash: &str, participant: u64) -> Vec<String> {
    let draw = Draw { seed: study.seed, config_hash: hash, participant, condition: None };
    let clip = |item| match item {
        OrderedItem::Trial { clip, .. } => Some(clip),
        OrderedItem::Component { .. } => None,
    };
    order(&study.projection(), draw).unwrap().into_iter().filter_map(clip).collect()
}

/// Numbers drawn from a seed: SplitMix64 (Steele, Lea & Flood 2014).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn below(&mut self, bound: u64) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % bound) as usize
    }
}

/// A constraint on one factor: most alike in a row, fewest places from one to the next.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    pub at_most_alike: usize,
    pub minimum_distance: usize,
}

/// Whether parts in this order, each with a value for each constraint, keep to all of them.
pub fn keeps_to<T: AsRef<[String]>>(order: &[T], limits: &[Limits]) -> bool {
    limits.iter().enumerate().all(|(factor, limits)| {
        let values: Vec<&String> = order.iter().map(|part| &part.as_ref()[factor]).collect();
        let runs = values.windows(limits.at_most_alike + 1);
        let mut near = values.iter().enumerate().map(|(place, value)| {
            values[place + 1..].iter().take(limits.minimum_distance - 1).any(|other| other == value)
        });
        runs.into_iter().all(|run| run.iter().any(|value| *value != run[0]))
            && !near.any(|same| same)
    })
}

/// Whether any order keeps to the constraints: all of them are tried, parts with the same values
/// once.
pub fn has_an_order(parts: &[Vec<String>], limits: &[Limits]) -> bool {
    fn extend<'a>(
        placed: &mut Vec<&'a [String]>,
        left: &mut Vec<(&'a [String], usize)>,
        limits: &[Limits],
    ) -> bool {
        if left.iter().all(|(_, times)| *times == 0) {
            return true;
        }
        for index in 0..left.len() {
            if left[index].1 == 0 {
                continue;
            }
            placed.push(left[index].0);
            left[index].1 -= 1;
            let found = keeps_to(placed, limits) && extend(placed, left, limits);
            left[index].1 += 1;
            placed.pop();
            if found {
                return true;
            }
        }
        false
    }
    let mut kinds: Vec<(&[String], usize)> = Vec::new();
    for part in parts {
        match kinds.iter_mut().find(|(kind, _)| *kind == part.as_slice()) {
            Some((_, times)) => *times += 1,
            None => kinds.push((part, 1)),
        }
    }
    extend(&mut Vec::new(), &mut kinds, limits)
}
