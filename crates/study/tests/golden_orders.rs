//! Orders kept in the repository: they must never change, natively or in the browser, or an old study
//! could not be replayed. `MIMIQUE_UPDATE_GOLDEN=1` writes them anew; look at the difference before
//! you keep it.

mod support;

use std::fmt::Write as _;

use mimique_study::flow::{Plan, Step};
use mimique_study::{Draw, OrderedItem, Study, option_order, order};
use serde_json::{Value, json};
use support::small::small_file;
use support::{started, study_text};

const PARTICIPANTS: [u64; 5] = [0, 1, 7, 40, 9_007_199_254_740_991];
const SEVEN: [(&str, u8); 7] =
    [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2), ("anger", 1), ("anger", 2), ("disgust", 1)];

/// The hash is fixed, so that a new wording in a study does not draw new orders.
fn hash() -> String {
    "0".repeat(64)
}

fn kept(name: &str, lines: &str) {
    let file = format!("{}/tests/golden/{name}.txt", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, lines).unwrap();
    }
    assert_eq!(lines, std::fs::read_to_string(&file).unwrap_or_default(), "{file}");
}

/// A line a participant: trials by their clip, other components by name.
fn lines(study: &Study, participants: &[u64]) -> String {
    let hash = hash();
    let mut lines = String::new();
    for &participant in participants {
        let items =
            order(study, Draw { seed: study.seed, config_hash: &hash, participant }).unwrap();
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
    lines(&study, &PARTICIPANTS)
}

#[test]
fn constrained_random_order_of_the_demo() {
    let study = Study::from_text(&study_text("demo.json")).unwrap();
    kept("order", &lines(&study, &[0, 1, 7, 9_007_199_254_740_991]));
}

#[test]
fn latin_squares() {
    let square = json!({ "order": "latinSquare", "components": ["faces"] });
    kept("latin_square_even", &orders(6, square.clone()));
    kept("latin_square_odd", &orders(7, square));
}

#[test]
fn samples() {
    let sample = json!({ "order": "random", "components": ["faces"], "numSamples": 4 });
    kept("samples", &orders(6, sample.clone()));
    kept("samples_of_a_prime", &orders(7, sample));
}

#[test]
fn nesting() {
    kept(
        "nesting",
        &orders(
            6,
            json!({ "order": "random",
        "interruptions": [{ "component": "rest", "spacing": 2 }], "components": [
            { "id": "a", "order": "random", "components": ["first"],
              "constraints": [{ "factor": "expression", "atMostAlike": 1 }] },
            { "id": "b", "order": "fixed", "components": ["second"] } ] }),
        ),
    );
}

#[test]
fn squares_beside_squares_and_samples() {
    kept(
        "several_squares",
        &orders(
            6,
            json!({ "order": "latinSquare", "components": [
        { "order": "latinSquare", "components": ["first"] },
        { "order": "latinSquare", "components": ["second"], "numSamples": 2 } ] }),
        ),
    );
}

#[test]
fn samples_under_constraints() {
    kept(
        "samples_under_constraints",
        &orders(
            6,
            json!({ "order": "random", "components": ["faces"],
        "numSamples": 4, "constraints": [{ "factor": "expression", "atMostAlike": 1 }] }),
        ),
    );
}

#[test]
fn options() {
    let hash = hash();
    let mut lines = String::new();
    for participant in PARTICIPANTS {
        let draw = Draw { seed: 5, config_hash: &hash, participant };
        writeln!(lines, "{participant}: {:?}", option_order(draw, "emotion", 6)).unwrap();
    }
    kept("options", &lines);
}

/// On which side the companion stands, trial by trial.
#[test]
fn sides() {
    let mut lines = String::new();
    for participant in PARTICIPANTS {
        let (study, mut session) = started(&study_text("study2b.json"), participant);
        session.config_hash = hash();
        let plan = Plan::new(study, session).unwrap();
        let trials = plan.steps.iter().filter_map(Step::trial).filter(|trial| !trial.training);
        let sides: String = trials
            .filter_map(|trial| trial.beside.as_ref())
            .map(|beside| if beside.left { 'l' } else { 'r' })
            .collect();
        writeln!(lines, "{participant}: {sides}").unwrap();
    }
    kept("sides", &lines);
}
