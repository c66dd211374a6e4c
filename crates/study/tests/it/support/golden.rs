//! The orders that are stored in `tests/golden`: how each is drawn, natively (`tests/it/golden_orders.rs`) and
//! in the browser's module (`web/bits/src/orders.rs`, run by
//! `tests/browser/order_bits.test.mjs`). Needs the modules `study_text` and `small`.

use std::fmt::Write as _;

use mimique_study::{Component, Draw, OrderedItem, Sides, Study, option_order, order};
use serde_json::{Value, json};

use super::small::small_file;
use super::study_text;

/// Every file of `tests/golden`, without its ending.
pub const NAMES: [&str; 10] = [
    "order",
    "latin_square_even",
    "latin_square_odd",
    "samples",
    "samples_of_a_prime",
    "nesting",
    "several_squares",
    "samples_under_constraints",
    "options",
    "sides",
];

const PARTICIPANTS: [u64; 5] = [0, 1, 7, 40, 9_007_199_254_740_991];
const SEVEN: [(&str, u8); 7] =
    [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2), ("anger", 1), ("anger", 2), ("disgust", 1)];

/// What the file of this name holds: a line a participant.
pub fn lines(name: &str) -> String {
    let square = json!({ "order": "latinSquare", "components": ["faces"] });
    let sample = json!({ "order": "random", "components": ["faces"], "numSamples": 4 });
    match name {
        "order" => {
            let study = Study::from_text(&study_text("demo.json")).unwrap();
            order_of(&study, &[0, 1, 7, 9_007_199_254_740_991])
        }
        "latin_square_even" => orders(6, square),
        "latin_square_odd" => orders(7, square),
        "samples" => orders(6, sample),
        "samples_of_a_prime" => orders(7, sample),
        "nesting" => orders(
            6,
            json!({ "order": "random",
        "interruptions": [{ "component": "rest", "spacing": 2 }], "components": [
            { "id": "a", "order": "random", "components": ["first"],
              "constraints": [{ "factor": "expression", "atMostAlike": 1 }] },
            { "id": "b", "order": "fixed", "components": ["second"] } ] }),
        ),
        "several_squares" => orders(
            6,
            json!({ "order": "latinSquare", "components": [
        { "order": "latinSquare", "components": ["first"] },
        { "order": "latinSquare", "components": ["second"], "numSamples": 2 } ] }),
        ),
        "samples_under_constraints" => orders(
            6,
            json!({ "order": "random", "components": ["faces"],
        "numSamples": 4, "constraints": [{ "factor": "expression", "atMostAlike": 1 }] }),
        ),
        "options" => options(),
        "sides" => sides(),
        other => panic!("no order is called {other}"),
    }
}

/// The hash is fixed, so that a new wording in a study does not draw new orders.
fn hash() -> String {
    "0".repeat(64)
}

/// A line a participant: trials by their clip, other components by name.
fn order_of(study: &Study, participants: &[u64]) -> String {
    let hash = hash();
    let mut lines = String::new();
    for &participant in participants {
        let items = order(
            &study.projection(),
            Draw { seed: study.seed, config_hash: &hash, participant, condition: None },
        )
        .unwrap();
        let name = |item: OrderedItem| match item {
            OrderedItem::Trial { clip, .. } => clip,
            OrderedItem::Component { component } => component,
        };
        let names: Vec<String> = items.into_iter().map(name).collect();
        writeln!(lines, "{participant}: {}", names.join(" ")).unwrap();
    }
    lines
}

fn orders(count: usize, sequence: Value) -> String {
    let study = Study::from_value(&small_file(5, &SEVEN[..count], 1, sequence)).unwrap();
    order_of(&study, &PARTICIPANTS)
}

fn options() -> String {
    let hash = hash();
    let mut lines = String::new();
    for participant in PARTICIPANTS {
        let draw = Draw { seed: 5, config_hash: &hash, participant, condition: None };
        writeln!(lines, "{participant}: {:?}", option_order(draw, "emotion", 6)).unwrap();
    }
    lines
}

/// On which side the companion stands, trial by trial.
fn sides() -> String {
    let hash = hash();
    let study = Study::from_text(&study_text("study2b.json")).unwrap();
    let mut lines = String::new();
    for participant in PARTICIPANTS {
        let draw = Draw { seed: study.seed, config_hash: &hash, participant, condition: None };
        let items = order(&study.projection(), draw).unwrap();
        let mut sides = Sides::new(&study.projection(), draw, &items);
        let side = |left: bool| if left { 'l' } else { 'r' };
        let of = items.iter().filter_map(|item| match item {
            OrderedItem::Trial { component, .. } => match study.components.get(component) {
                Some(Component::Trials(block)) => {
                    block.beside.as_ref().map(|beside| side(sides.is_left(component, beside)))
                }
                _ => None,
            },
            OrderedItem::Component { .. } => None,
        });
        writeln!(lines, "{participant}: {}", of.collect::<String>()).unwrap();
    }
    lines
}
