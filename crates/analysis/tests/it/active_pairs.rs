//! Active schedules of pairs: simulated people go through them, worths come back, and pairs whose answer is known are
//! asked about less often.

use std::collections::BTreeMap;

use mimique_analysis::{Parameters, PowerOptions, Simulation, power};
use mimique_locale::Language;
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::preregistered::preregistered;
use crate::support::results::{careful, report, text};
use crate::support::simulated::simulated_export;

const PEOPLE: u64 = 30;
const PAIRS: usize = 24;
const LEVELS: [&str; 5] = ["box", "lsts", "recorded", "ridge", "greedy"];

fn study() -> Study {
    let file = include_str!("../../../../study-config/pairs.json");
    let mut value = mimique_study::parse(file).unwrap();
    let methods: serde_json::Map<String, Value> =
        LEVELS.map(|name| (name.to_owned(), json!({ "method": name }))).into_iter().collect();
    value["stimuli"]["methods"] = methods.into();
    value["stimuli"]["clips"] = json!({});
    let questions = value["questions"].as_array().unwrap();
    let choice = questions.iter().find(|question| question["type"] == "comparison").unwrap();
    let choice = choice["id"].as_str().unwrap().to_owned();
    value["components"] = json!({
        "duels": {
            "type": "pairs", "question": choice,
            "schedule": { "rule": "active", "perParticipant": PAIRS }
        }
    });
    value["sequence"] = json!({ "order": "fixed", "components": ["duels"] });
    value["hypotheses"] = json!([{
        "id": "H1", "test": "bradley-terry", "response": choice, "factors": ["method"],
        "statement": { "en": "No method is chosen over another.", "fr": "Aucune méthode n’est préférée." }
    }]);
    for unused in ["tables", "scales"] {
        value.as_object_mut().unwrap().remove(unused);
    }
    Study::from_value(&value).unwrap()
}

/// A row of the export: column -> cell.
type Row = BTreeMap<String, String>;

/// The rows of the export.
fn rows(csv: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let head = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| {
        head.iter()
            .zip(record.iter())
            .map(|(name, cell)| (name.to_owned(), cell.to_owned()))
            .collect()
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

#[test]
fn worths_come_back_and_what_is_known_is_asked_about_less() {
    let study = study();
    let mut parameters = careful(&study);
    let (_, own) = parameters.comparisons.iter_mut().next().unwrap();
    own.worth = [("box", -3.0), ("recorded", 3.0)].map(|(k, v)| (k.to_owned(), v)).into();
    (own.person_sd, own.segment_sd, own.lapse) = (0.0, 0.0, 0.0);
    let simulation = Simulation::new(&study, "hash", &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, PEOPLE);
    let rows = rows(&csv);
    let trials: Vec<&Row> = rows.iter().filter(|row| !row["item_left"].is_empty()).collect();
    assert_eq!(trials.len(), PAIRS * PEOPLE as usize);
    let (dealt, active): (Vec<&Row>, Vec<&Row>) =
        trials.iter().partition(|row| row["batch"].is_empty());
    assert_eq!((dealt.len(), active.len()), (trials.len() / 2, trials.len() / 2));
    // Of a batch of four pairs all five levels are compared.
    for row in &active {
        let batch: usize = row["batch"].parse().unwrap();
        assert!((1..=PAIRS / 2 / 4).contains(&batch), "{batch}");
    }
    let is = |row: &&&Row, one: &str, other: &str| {
        let items = [row["item_left"].as_str(), row["item_right"].as_str()];
        items.contains(&one) && items.contains(&other)
    };
    let known = active.iter().filter(|row| is(row, "box", "recorded")).count();
    let close = active.iter().filter(|row| is(row, "lsts", "ridge")).count();
    assert!(3 * known < close, "box and recorded {known} times, lsts and ridge {close} times");
    // Sides: each level stands left about as often as right.
    for level in LEVELS {
        let left = active.iter().filter(|row| row["item_left"] == level).count() as f64;
        let right = active.iter().filter(|row| row["item_right"] == level).count() as f64;
        assert!((left - right).abs() < 0.2 * (left + right) + 8.0, "{level}: {left}, {right}");
    }
    let (written, results) = report(&study, &csv, Language::English);
    let found = results["choices"][0].to_string();
    let says = |what: &str| found.contains(what);
    assert!(
        says(r#""default_test":"clustered-f""#) && says(r#""friedman_on_wins":null"#),
        "{found}"
    );
    assert!(text(&written, "report.md").contains("recorded"), "{:?}", written.readings);
}

#[test]
fn the_preregistration_says_how_pairs_are_chosen() {
    let study = study();
    let parameters = Parameters::for_study(&study);
    let options = PowerOptions {
        participants: vec![12],
        clips: vec![30],
        runs: 5,
        seed: 5,
        alpha: 0.05,
        false_positives: false,
        mixed: false,
    };
    let found = power(&study, "hash", &parameters, &options, &|| {}).unwrap();
    for (language, says) in [
        (Language::English, "spanning tree of greatest expected information"),
        (Language::French, "l’arbre couvrant de plus grande information attendue"),
    ] {
        let text = preregistered(&study, &parameters, &found, language);
        assert!(text.contains(says), "{text}");
    }
}
