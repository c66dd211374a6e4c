//! Thresholds of adaptive blocks: planted ones are found again, those outside the levels are told as such, and levels
//! that answers do not give are an error that is named.

use mimique_analysis::Simulation;
use mimique_locale::Language;
use mimique_study::Study;
use serde_json::Value;

use crate::support::results::{careful, report, text};
use crate::support::simulated::simulated_export;

const PEOPLE: u64 = 8;

fn study() -> Study {
    let file = include_str!("../../../../study-config/jnd-alpha.json");
    Study::from_value(&mimique_study::parse(file).unwrap()).unwrap()
}

/// People whose thresholds lie here, who answer with care and all come to the end.
fn export(study: &Study, threshold: f64) -> String {
    let mut parameters = careful(study);
    let own = parameters.discrimination.get_mut("limit").unwrap();
    (own.threshold, own.person_sd, own.spread) = (threshold, 0.0, 0.08);
    simulated_export(&Simulation::new(study, "hash", &parameters, 5).unwrap(), study, PEOPLE)
}

#[test]
fn planted_thresholds_are_found_again() {
    let study = study();
    for planted in [0.3, 0.65] {
        let (_, results) = report(&study, &export(&study, planted), Language::English);
        let block = &results["thresholds"][0];
        assert_eq!((&block["block"], &block["parameter"]), (&"limit".into(), &"alpha".into()));
        let people = block["people"].as_array().unwrap();
        assert_eq!(people.len() as u64, PEOPLE);
        let mut covered = 0;
        for person in people {
            assert_eq!((&person["answers"], &person["catches"][0]), (&30.into(), &3.into()));
            if let [Some(low), Some(high)] = [0, 1].map(|end| person["interval"][end].as_f64()) {
                covered += u64::from((low..=high).contains(&planted));
            }
        }
        assert!(covered + 2 >= PEOPLE, "{covered} of {PEOPLE} intervals have {planted}");
        let mean = block["mean"]["mean"].as_f64().unwrap();
        assert!((mean - planted).abs() < 0.06, "{mean} of {planted}");
    }
}

/// The block asks whether the clips differ.
fn yes_or_no() -> Study {
    let file = include_str!("../../../../study-config/jnd-alpha.json");
    let mut value = mimique_study::parse(file).unwrap();
    value["questions"] = serde_json::json!([{
        "id": "differ", "type": "singleChoice",
        "prompt": { "en": "Do the two faces differ?", "fr": "Les deux visages diffèrent-ils ?" },
        "options": [
            { "value": "yes", "label": { "en": "Yes", "fr": "Oui" } },
            { "value": "no", "label": { "en": "No", "fr": "Non" } },
        ],
    }]);
    let block = &mut value["components"]["limit"];
    (block["question"], block["yes"], block["catch"]) = ("differ".into(), "yes".into(), 0.5.into());
    Study::from_value(&value).unwrap()
}

#[test]
fn planted_thresholds_are_found_again_where_people_say_yes_or_no() {
    let study = yes_or_no();
    let (found, results) = report(&study, &export(&study, 0.4), Language::English);
    let block = &results["thresholds"][0];
    assert_eq!(block["yes_no"], true);
    let mut catches = 0;
    for person in block["people"].as_array().unwrap() {
        assert_eq!((&person["answers"], &person["fit"]["guess"]), (&30.into(), &0.0.into()));
        // Nobody says yes without a difference: all catch trials are right.
        let [shown, right] = [0, 1].map(|i| person["catches"][i].as_u64().unwrap());
        assert_eq!(shown, right);
        // 15 are drawn among the 30; those behind a track's last answer are not shown, since the block has ended.
        assert!((11..=15).contains(&shown), "{shown}");
        catches += shown;
    }
    let mean = block["mean"]["mean"].as_f64().unwrap();
    assert!((mean - 0.4).abs() < 0.04, "{mean}");
    assert!(text(&found, "report.md").contains(&format!("In 0 of {catches} catch trials")));
    assert_eq!(results["choices"], serde_json::json!([]));

    // Who says yes without seeing anything is found by the catch trials, and has a lower threshold.
    let mut parameters = careful(&study);
    let own = parameters.discrimination.get_mut("limit").unwrap();
    (own.threshold, own.person_sd, own.spread, own.false_alarm) = (0.4, 0.0, 0.08, 0.3);
    let simulation = Simulation::new(&study, "hash", &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, PEOPLE);
    let (_, results) = report(&study, &csv, Language::French);
    let people = results["thresholds"][0]["people"].as_array().unwrap();
    let right: u64 = people.iter().map(|own| own["catches"][1].as_u64().unwrap()).sum();
    let shown: u64 = people.iter().map(|own| own["catches"][0].as_u64().unwrap()).sum();
    let share = 1.0 - right as f64 / shown as f64;
    assert!((share - 0.3).abs() < 0.15, "{share} of catch trials are answered yes");
    let low = results["thresholds"][0]["mean"]["mean"].as_f64().unwrap();
    assert!(low < mean - 0.03, "{low} and {mean}");
}

#[test]
fn a_threshold_above_the_levels_is_told_and_in_no_mean() {
    let study = study();
    let csv = export(&study, 30.0);
    let (found, results) = report(&study, &csv, Language::English);
    let people = results["thresholds"][0]["people"].as_array().unwrap();
    let above = people.iter().filter(|person| person["threshold"]["above"] == 1.0).count();
    assert!(
        above > 0 && people.iter().all(|person| person["threshold"]["at"].as_f64() != Some(30.0))
    );
    assert!(text(&found, "report.md").contains("above 1"));
    let (found, _) = report(&study, &csv, Language::French);
    assert!(text(&found, "report.md").contains("au-dessus de 1"));
}

#[test]
fn levels_that_answers_do_not_give_are_an_error_that_is_named() {
    let study = study();
    let csv = export(&study, 0.5);
    let mut lines = csv.lines();
    let header = lines.next().unwrap();
    let place = header.split(',').position(|name| name == "level_replayed").unwrap();
    let is_sixth_trial = |line: &&str| line.contains("\"p0003\"") && line.contains("\"limit/6\"");
    let line = csv.lines().find(is_sixth_trial).unwrap();
    let mut cells: Vec<&str> = line.split(',').collect();
    assert_eq!(cells[place], "true");
    cells[place] = "false";
    let (found, results) = report(&study, &csv.replace(line, &cells.join(",")), Language::English);
    let people = results["thresholds"][0]["people"].as_array().unwrap();
    let wrong: Vec<&Value> =
        people.iter().filter(|person| person["threshold"] == "notReplayed").collect();
    assert_eq!(wrong.len(), 1);
    assert_eq!(wrong[0]["participant"], "p0003");
    assert!(text(&found, "report.md").contains("Error: seed and answers do not give the levels"));
}

#[test]
fn choices_of_an_adaptive_block_are_not_counted_by_level() {
    let study = study();
    let (found, results) = report(&study, &export(&study, 0.5), Language::English);
    assert_eq!(results["choices"], serde_json::json!([]));
    let figures: Vec<&str> = found
        .files
        .iter()
        .map(|file| file.path.as_str())
        .filter(|path| path.contains("limit-track"))
        .collect();
    assert!(!figures.is_empty(), "tracks and curves are drawn");
}

#[test]
fn thresholds_of_levels_that_fall_are_found_again() {
    let file = include_str!("../../../../study-config/jnd-alpha.json");
    let mut value = mimique_study::parse(file).unwrap();
    let block = &mut value["components"]["limit"];
    block["vary"] =
        serde_json::json!({ "parameter": "lowpassHz", "from": 12, "to": 2, "levels": 21 });
    block["rule"]["questPlus"] =
        serde_json::json!({ "threshold": [2.5, 11.5, 19], "spread": [0.5, 1.0, 2.0] });
    let study = Study::from_value(&value).unwrap();
    let mut parameters = careful(&study);
    let own = parameters.discrimination.get_mut("limit").unwrap();
    (own.threshold, own.person_sd, own.spread) = (5.0, 0.0, 0.8);
    let simulation = Simulation::new(&study, "hash", &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, PEOPLE);
    let (written, results) = report(&study, &csv, Language::English);
    let block = &results["thresholds"][0];
    assert_eq!(
        (&block["falls"], &block["levels"]),
        (&true.into(), &serde_json::json!([2.0, 12.0]))
    );
    let mean = block["mean"]["mean"].as_f64().unwrap();
    assert!((mean - 5.0).abs() < 0.6, "{mean}");
    for person in block["people"].as_array().unwrap() {
        let ends = [0, 1].map(|end| person["interval"][end].as_f64().unwrap());
        assert!(ends[0] < ends[1], "{ends:?}");
    }
    // Nobody sees even the lowest low-pass.
    own_threshold(&mut parameters, -20.0);
    let simulation = Simulation::new(&study, "hash", &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, PEOPLE);
    let (unseen, _) = report(&study, &csv, Language::English);
    assert!(text(&unseen, "report.md").contains("below 2"), "{}", text(&unseen, "report.md"));
    assert!(!text(&written, "report.md").contains("below 2 |"));
}

fn own_threshold(parameters: &mut mimique_analysis::Parameters, threshold: f64) {
    parameters.discrimination.get_mut("limit").unwrap().threshold = threshold;
}
