//! Answers about two clips at once are told of neither; how often each was chosen is counted, and so are
//! the best and the worst.

use std::collections::BTreeMap;

use mimique_analysis::{Parameters, PowerError, PowerOptions, Report, Simulation, analyze, power};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Problem, Study};
use serde_json::{Value, json};

use crate::support::simulated::simulated_export;

/// Study 2b, in which each solved clip stands beside the performance itself.
fn beside_the_performance() -> Value {
    mimique_study::parse(include_str!("../../../../study-config/study2b.json")).unwrap()
}

/// The same clips, the two methods beside each other; people choose one and rate "the" face.
fn beside_each_other() -> Value {
    let mut file = beside_the_performance();
    let choice = json!({
        "id": "nearer", "type": "comparison", "allowSame": true,
        "prompt": { "en": "Which moves more naturally?", "fr": "Lequel bouge plus naturellement ?" },
    });
    file["questions"].as_array_mut().unwrap().push(choice);
    let block = |own: &str, other: &str, segments: Value| {
        json!({
            "type": "trials", "questions": ["fidelity", "nearer"],
            "clips": { "where": { "method": [own], "intensity": segments } },
            "beside": { "method": other, "side": "random" },
        })
    };
    let pairs = block("lsts30", "box", json!([1, 2]));
    file["components"]["pairs"] = pairs;
    file["components"]["others"] = block("box", "lsts30", json!([3]));
    file["sequence"]["components"] = json!(["pairs", "others"]);
    file
}

/// The export of twelve simulated people.
fn export(study: &Study) -> String {
    let parameters = Parameters::for_study(study);
    simulated_export(&Simulation::new(study, "hash", &parameters, 3).unwrap(), study, 12)
}

fn report(study: &Study, csv: &str) -> (Report, Value) {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let report = analyze(&table, study, Language::English).unwrap();
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    let results = serde_json::from_str(&file.text).unwrap();
    (report, results)
}

fn few_runs() -> PowerOptions {
    PowerOptions {
        participants: vec![8],
        clips: Vec::new(),
        runs: 2,
        seed: 1,
        alpha: 0.05,
        false_positives: false,
        mixed: false,
    }
}

/// A row of the export by its columns' names.
fn rows(csv: &str) -> Vec<BTreeMap<String, String>> {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let cell = |row, place| table.cell(row, place).unwrap_or_default().to_owned();
    let names = || table.names().iter().cloned().enumerate();
    let row = |row| names().map(|(place, name)| (name, cell(row, place))).collect();
    (0..table.rows()).map(row).collect()
}

#[test]
fn a_rating_beside_one_reference_is_tested_as_before() {
    let study = Study::from_value(&beside_the_performance()).unwrap();
    let (report, results) = report(&study, &export(&study));
    assert!(!report.readings.is_empty());
    for (id, reading) in &report.readings {
        assert!(!reading.contains("Not tested"), "{id}: {reading}");
    }
    assert!(!results["comparisons"].as_array().unwrap().is_empty());
    let parameters = Parameters::for_study(&study);
    assert!(power(&study, "hash", &parameters, &few_runs(), &|| {}).is_ok());
}

#[test]
fn a_rating_of_two_methods_at_once_is_told_of_neither() {
    let study = Study::from_value(&beside_each_other()).unwrap();
    let (report, results) = report(&study, &export(&study));
    let [_, (id, reading), ..] = report.readings.as_slice() else {
        panic!("{:?}", report.readings)
    };
    let first = &report.readings[0].1;
    assert!(first.starts_with("Not tested: \"fidelity\" was asked of two clips"), "{first}");
    assert!(reading.starts_with("Not tested"), "{id}: {reading}");
    assert_eq!(results["hypotheses"][0]["p"], Value::Null);
    assert_eq!(results["hypotheses"][0]["recommended"]["overall"][0]["status"], "undefined");
    // Nothing is explored by the method either; the emotion is that of both clips.
    let explored: Vec<&str> = results["comparisons"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|each| each["measure"] == "fidelity")
        .map(|each| each["factor"].as_str().unwrap())
        .collect();
    assert!(explored.contains(&"expression") && !explored.contains(&"method"), "{explored:?}");
    for file in &report.files {
        assert!(!file.path.contains("fidelity-by-method"), "{}", file.path);
    }
    let parameters = Parameters::for_study(&study);
    let refused = power(&study, "hash", &parameters, &few_runs(), &|| {}).unwrap_err();
    let words = refused.to_string();
    let PowerError::OfPair { place, problem } = refused else { panic!("{words}") };
    assert_eq!(place, "/hypotheses/0/factors");
    assert!(matches!(*problem, Problem::RatingOfPair { .. }), "{problem:?}");
    assert!(words.starts_with("/hypotheses/0/factors: \"fidelity\" rates two clips"), "{words}");
}

#[test]
fn a_choice_between_two_clips_is_no_answer_of_the_first_one() {
    let mut file = beside_each_other();
    file["hypotheses"] = json!([{
        "id": "H", "statement": { "en": "No effect.", "fr": "Sans effet." },
        "test": "chi-square", "response": "nearer", "factors": ["method"],
    }]);
    let study = Study::from_value(&file).unwrap();
    let (report, _) = report(&study, &export(&study));
    let reading = &report.readings[0].1;
    assert!(reading.starts_with("Not tested: \"nearer\" says which of two clips"), "{reading}");
    let refused = power(&study, "hash", &Parameters::for_study(&study), &few_runs(), &|| {});
    let Err(PowerError::OfPair { problem, .. }) = refused else { panic!("{refused:?}") };
    assert!(matches!(*problem, Problem::ChoiceOfPair { .. }), "{problem:?}");
    let checked = mimique_study::check(&file.to_string(), &|_| Ok(()));
    let codes: Vec<&str> = checked.issues.iter().map(|issue| issue.code()).collect();
    assert!(codes.contains(&"of-two-clips"), "{codes:?}");
}

#[test]
fn the_report_counts_which_clip_was_chosen_against_which() {
    let study = Study::from_value(&beside_each_other()).unwrap();
    let csv = export(&study);
    let (report, results) = report(&study, &csv);
    // The export names the clip that was chosen, and a clip's identifier its method.
    let mut expected = BTreeMap::from([("lsts30", 0_u64), ("box", 0), ("neither", 0)]);
    let mut used = 0;
    for row in rows(&csv) {
        if row["response_id"] != "nearer" || row["status"] != "completed" {
            continue;
        }
        used += 1;
        let chosen = match row["chosen"].as_str() {
            "" => "neither",
            clip if clip.contains(".box.") => "box",
            _ => "lsts30",
        };
        *expected.get_mut(chosen).unwrap() += 1;
    }
    assert!(used > 100 && expected.values().all(|count| *count > 10), "{expected:?}");
    let choices = results["choices"].as_array().unwrap();
    let by = |factor: &str| choices.iter().find(|each| each["by"] == factor);
    let pairs = by("method").unwrap()["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), 1, "the two methods, whichever was the trial's own: {pairs:?}");
    let pair = &pairs[0];
    let count = |name: &str| pair[name].as_u64().unwrap();
    let of = |method: &str| match pair["first"] == method {
        true => count("first_chosen"),
        false => count("second_chosen"),
    };
    assert_eq!((of("lsts30"), of("box")), (expected["lsts30"], expected["box"]));
    assert_eq!(count("no_difference"), expected["neither"]);
    // The clips of a pair are of one segment: by its factors there is nothing to choose between.
    assert!(by("expression").is_none());
    let by_clip = choices.iter().find(|each| each["by"].is_null()).unwrap();
    let clips = by_clip["pairs"].as_array().unwrap();
    assert_eq!(clips.len(), 18);
    let trials = |pair: &Value| -> u64 {
        let counts = ["first_chosen", "second_chosen", "no_difference"];
        counts.iter().map(|name| pair[*name].as_u64().unwrap()).sum()
    };
    assert_eq!(clips.iter().map(trials).sum::<u64>(), used);
    let paths: Vec<&str> = report.files.iter().map(|file| file.path.as_str()).collect();
    assert!(paths.contains(&"tables/nearer-choices-by-method.csv"), "{paths:?}");
}

#[test]
fn the_report_scores_best_and_worst_by_condition() {
    let mut file = beside_the_performance();
    let options: Vec<Value> = ["eyes", "mouth", "skin", "brows"]
        .map(|word| json!({ "value": word, "label": { "en": word, "fr": word } }))
        .into();
    let question = |id: &str| {
        json!({ "id": id, "type": "bestWorst", "options": options,
            "prompt": { "en": "Which is best, which worst?", "fr": "Le meilleur, le pire ?" } })
    };
    file["questions"].as_array_mut().unwrap().push(question("feature"));
    file["components"]["pairs"]["questions"] = json!(["fidelity", "feature"]);
    file["demographics"]["questions"].as_array_mut().unwrap().push(question("liked"));
    let study = Study::from_value(&file).unwrap();
    let csv = export(&study);
    let (report, results) = report(&study, &csv);
    let count = |pick: &str, option: &str, method: Option<&str>| {
        let own = |row: &&BTreeMap<String, String>| {
            row["response_id"] == format!("feature.{pick}")
                && row["status"] == "completed"
                && (option.is_empty() || row["answer"] == option)
                && method.is_none_or(|method| row["method"] == method)
        };
        rows(&csv).iter().filter(own).count() as u64
    };
    let scores = results["best_worst"].as_array().unwrap();
    let feature: Vec<&Value> = scores.iter().filter(|each| each["response"] == "feature").collect();
    for (by, of) in [(None, None), (Some("method"), Some("box")), (Some("method"), Some("lsts30"))]
    {
        let own =
            feature.iter().find(|each| each["by"].as_str() == by && each["of"].as_str() == of);
        let own = own.unwrap_or_else(|| panic!("no scores by {by:?} of {of:?}: {scores:?}"));
        let counted = own["options"].as_array().unwrap();
        assert_eq!(counted.len(), 4);
        let mut sum = 0.0;
        for each in counted {
            let option = each["option"].as_str().unwrap();
            let [best, worst, shown] = [("best", option), ("worst", option), ("best", "")]
                .map(|(pick, option)| count(pick, option, of));
            assert!(shown > 50);
            assert_eq!([&each["best"], &each["worst"], &each["shown"]], [best, worst, shown]);
            let score = (best as f64 - worst as f64) / shown as f64;
            assert!((each["score"].as_f64().unwrap() - score).abs() < 1e-12);
            sum += score;
        }
        assert!(sum.abs() < 1e-9, "as many best as worst: {sum}");
    }
    let liked = scores.iter().find(|each| each["response"] == "liked").unwrap();
    let people = results["flow"]["people_used"].as_u64().unwrap();
    assert_eq!(liked["options"][0]["shown"], people);
    let paths: Vec<&str> = report.files.iter().map(|file| file.path.as_str()).collect();
    for path in ["tables/feature-scores.csv", "tables/feature-scores-by-method.csv"] {
        assert!(paths.contains(&path), "{path} is missing among {paths:?}");
    }
}
