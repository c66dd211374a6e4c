//! Choices between two clips, from people with worths to the report: what is planted is found again, the words name
//! what was computed, other programs find the same numbers.

use std::path::Path;
use std::process::Command;

use mimique_analysis::{
    Parameters, PowerOptions, Report, ReportOptions, Simulation, analyze, analyze_with, power,
};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Severity, Study};
use serde_json::{Value, json};

use crate::support::preregistered::preregistered;
use crate::support::simulated::simulated_export;

/// Study 2b as pairs of its three methods, each two beside each other: one block for each.
fn three_methods() -> Value {
    let mut file =
        mimique_study::parse(include_str!("../../../../study-config/study2b.json")).unwrap();
    file["questions"].as_array_mut().unwrap().push(json!({
        "id": "nearer", "type": "comparison", "allowSame": true,
        "prompt": { "en": "Which moves more naturally?", "fr": "Lequel bouge plus naturellement ?" },
    }));
    let block = |own: &str, beside: Value| {
        json!({ "type": "trials", "questions": ["nearer"],
            "clips": { "where": { "method": [own], "intensity": [1, 2] } }, "beside": beside })
    };
    file["components"] = json!({
        "first": block("lsts30", json!({ "method": "box", "side": "random" })),
        "second": block("box", json!({ "method": "real", "avatar": "actor", "side": "random" })),
        "third": block("real", json!({ "method": "lsts30", "avatar": "head", "side": "random" })),
    });
    file["sequence"] = json!({ "order": "random", "components": ["first", "second", "third"] });
    file["hypotheses"] = json!([{
        "id": "H", "test": "bradley-terry", "response": "nearer", "factors": ["method"],
        "generalise": "these clips",
        "statement": { "en": "No method is chosen over another.", "fr": "Aucune méthode n’est préférée." },
    }]);
    file.as_object_mut().unwrap().remove("tables");
    file
}

/// The two solved methods alone.
fn two_methods() -> Value {
    let mut file = three_methods();
    file["components"].as_object_mut().unwrap().retain(|name, _| name == "first");
    file["sequence"]["components"] = json!(["first"]);
    file["hypotheses"][0]["test"] = "sign".into();
    file
}

fn study(file: &Value) -> Study {
    Study::from_value(file).unwrap()
}

/// People to whom these worths are planted.
fn planted(study: &Study, worths: &[(&str, f64)], side: f64) -> Parameters {
    let mut parameters = Parameters::for_study(study);
    let own = parameters.comparisons.get_mut("nearer").unwrap();
    own.worth = worths.iter().map(|(level, worth)| ((*level).to_owned(), *worth)).collect();
    (own.side, own.lapse) = (side, 0.0);
    parameters
}

fn report(study: &Study, parameters: &Parameters, people: u64, language: Language) -> Report {
    let simulation = Simulation::new(study, "hash", parameters, 11).unwrap();
    let csv = simulated_export(&simulation, study, people);
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    let found = report.files.iter().find(|file| file.path == path);
    &found.unwrap_or_else(|| panic!("no {path}")).text
}

fn tests_of(report: &Report) -> Value {
    let results: Value = serde_json::from_str(file(report, "results.json")).unwrap();
    let choices = results["choices"].as_array().unwrap();
    choices.iter().find(|own| own["by"] == "method").unwrap()["tests"].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

const WORTHS: [(&str, f64); 3] = [("box", -0.7), ("lsts30", 0.1), ("real", 0.6)];

#[test]
fn planted_worths_side_and_ties_are_found_again() {
    let study = study(&three_methods());
    let report = report(&study, &planted(&study, &WORTHS, 0.4), 60, Language::English);
    let tests = tests_of(&report);
    let worths = &tests["worths"];
    let levels: Vec<&str> =
        worths["items"].as_array().unwrap().iter().map(|item| item.as_str().unwrap()).collect();
    assert_eq!(levels.len(), 3, "the third method too: {levels:?}");
    for (level, planted) in WORTHS {
        let place = levels.iter().position(|own| *own == level).unwrap();
        let found = number(&worths["worth"][place]);
        // The taste of people (0.5) and clips (0.2) draws estimates towards 0 a little.
        let se = number(&worths["se_cluster"][place]);
        assert!(se < 0.12 && (found - planted).abs() < 3.0 * se + 0.08, "{level}: {found} ± {se}");
        let [low, high] = [0, 1].map(|end| number(&worths["worth_interval"][place][end]));
        assert!(low < found && found < high && high - low < 0.5, "{level}: {low} {found} {high}");
    }
    let side = &worths["side"];
    let (side, se) = (number(&side["estimate"]), number(&side["se_cluster"]));
    assert!((side - 0.4).abs() < 3.0 * se + 0.05, "{side} ± {se}");
    let tie = number(&worths["tie"]["estimate"]);
    assert!((tie + 0.5).abs() < 0.25, "{tie}");
    let deciding = &tests["recommended"]["overall"][0];
    assert!(deciding["test"].as_str().unwrap().contains("clustered by participant"), "{deciding}");
    assert!(number(&deciding["p_value"]) < 1e-6, "{deciding}");
    assert!(number(&worths["lack_of_fit"]["G2"]) >= 0.0);
    let reading = &report.readings[0].1;
    for words in ["Bradley-Terry", "Real face is chosen over Box (baseline) in ", "clustered"] {
        assert!(reading.contains(words), "{words}: {reading}");
    }
    let svg = file(&report, "figures/nearer-choices-method-ranking.svg");
    assert!(svg.contains("worth in just noticeable differences (1: chosen in 75 %)"));
    for path in ["sides", "shares", "worths", "pairs", "tests"] {
        let table = file(&report, &format!("tables/nearer-choices-method-{path}.csv"));
        if path != "tests" {
            assert!(table.contains("Real face"), "{path}: {table}");
        }
    }
}

/// Choices are decided for other clips, too: the ranking on the first screen is that of the model that decides.
#[test]
fn choices_are_decided_for_other_clips_by_the_linear_model() {
    let of_others = |mut file: Value| {
        file["hypotheses"][0].as_object_mut().unwrap().remove("generalise");
        study(&file)
    };
    let three = of_others(three_methods());
    let own = report(&three, &planted(&three, &WORTHS, 0.4), 60, Language::English);
    let results: Value = serde_json::from_str(file(&own, "results.json")).unwrap();
    let hypothesis = &results["hypotheses"][0];
    assert_eq!(hypothesis["scope"], "other_clips");
    assert_eq!(hypothesis["p"], hypothesis["other_clips"]["linear_model"]["p"]);
    let text = file(&own, "report.md");
    let screen = &text[..text.find("## Participants").unwrap()];
    let places = ["Real face: ", "LSTS30: ", "Box (baseline): "]
        .map(|words| screen.find(words).unwrap_or_else(|| panic!("{words}: {screen}")));
    assert!(places.is_sorted(), "{screen}");
    assert!(screen.contains(" % of choices over the others \\["), "{screen}");
    let reading = &own.readings[0].1;
    assert!(reading.contains("Real face over Box (baseline): chosen in "), "{reading}");
    assert!(reading.contains("Of these clips alone: "), "{reading}");
    let two = of_others(two_methods());
    let worths = [("lsts30", 0.8), ("box", 0.0)];
    let own = report(&two, &planted(&two, &worths, 0.0), 60, Language::French);
    let text = file(&own, "report.md");
    let screen =
        &text[..text.find("## Personnes").or_else(|| text.find("## Participants")).unwrap()];
    assert!(screen.contains("LSTS30 plutôt que Boîte"), "{screen}");
    for (language, words) in [
        (Language::English, "decides: F test of a linear model of choices"),
        (Language::French, "décide : test F d’un modèle linéaire des choix"),
    ] {
        let parameters = Parameters::for_study(&three);
        let options = PowerOptions {
            participants: vec![12],
            clips: Vec::new(),
            runs: 3,
            seed: 1,
            alpha: 0.05,
            false_positives: false,
            mixed: false,
        };
        let found = power(&three, "hash", &parameters, &options, &|| {}).unwrap();
        let text = preregistered(&three, &parameters, &found, language);
        assert!(text.contains(words), "{text}");
    }
}

/// The first screen says which level is preferred: the ranking with its intervals, drawn, or the share of two.
#[test]
fn the_first_screen_has_the_ranking() {
    let study = study(&three_methods());
    let own = report(&study, &planted(&study, &WORTHS, 0.4), 60, Language::English);
    let results: Value = serde_json::from_str(file(&own, "results.json")).unwrap();
    let ranking = results["hypotheses"][0]["preference"]["ranking"].as_array().unwrap();
    let levels: Vec<&str> = ranking.iter().map(|level| level["level"].as_str().unwrap()).collect();
    assert_eq!(levels, ["real", "lsts30", "box"]);
    let text = file(&own, "report.md");
    let screen = &text[..text.find("## Participants").unwrap()];
    let places = ["Real face: 0.", "LSTS30: ", "Box (baseline): -"]
        .map(|words| screen.find(words).unwrap_or_else(|| panic!("{words}: {screen}")));
    assert!(places.is_sorted(), "{screen}");
    assert!(screen.contains(" JND \\["), "{screen}");
    let page = file(&own, "report.html");
    assert!(page.contains("just noticeable differences (JND: one of two is chosen in 75"));
    let reading = &own.readings[0].1;
    let order = "From the most to the least chosen: Real face, LSTS30, Box (baseline).";
    assert!(reading.contains(order), "{reading}");
    assert!(page.contains("class=\"forest"), "the intervals are drawn");

    let two = self::study(&two_methods());
    let chosen = planted(&two, &[("box", -0.6), ("lsts30", 0.6)], 0.0);
    let own = report(&two, &chosen, 24, Language::English);
    let text = file(&own, "report.md");
    let screen = &text[..text.find("## Participants").unwrap()];
    let words = "LSTS30 over Box (baseline): ";
    assert!(
        screen.contains(words) && screen.contains(" % of the choices of one of them"),
        "{screen}"
    );
}

#[test]
fn worths_are_fitted_to_an_export() {
    let study = study(&three_methods());
    let simulated = planted(&study, &WORTHS, 0.4);
    let simulation = Simulation::new(&study, "hash", &simulated, 7).unwrap();
    let csv = simulated_export(&simulation, &study, 60);
    let fitted = Parameters::fit(&Table::parse(csv.as_bytes()).unwrap(), &study).unwrap();
    let own = &fitted.comparisons["nearer"];
    for (level, worth) in WORTHS {
        assert!((own.worth[level] - worth).abs() < 0.35, "{level}: {own:?}");
    }
    assert!((own.side - 0.4).abs() < 0.2 && (own.tie + 0.5).abs() < 0.25, "{own:?}");
    fitted.check(&study).unwrap();
}

#[test]
fn of_two_methods_the_sign_test_of_people_decides() {
    let study = study(&two_methods());
    let chosen = planted(&study, &[("box", -0.6), ("lsts30", 0.6)], 0.0);
    let found = report(&study, &chosen, 24, Language::English);
    let tests = tests_of(&found);
    let deciding = &tests["recommended"]["overall"][0];
    let words = deciding["test"].as_str().unwrap();
    assert!(words.starts_with("sign test of each person's choices"), "{words}");
    assert!(number(&deciding["p_value"]) < 1e-4, "{deciding}");
    let reading = &found.readings[0].1;
    assert!(reading.contains("LSTS30 is chosen over Box (baseline) in "), "{reading}");
    assert!(reading.contains("sign test of people"), "{reading}");

    let alike = planted(&study, &[], 0.0);
    let found = report(&study, &alike, 24, Language::French);
    let p = number(&tests_of(&found)["recommended"]["overall"][0]["p_value"]);
    assert!(p > 0.05, "{p}");
    let reading = &found.readings[0].1;
    assert!(
        reading.contains("n’a pas été montré") && reading.contains("test du signe"),
        "{reading}"
    );
}

#[test]
fn the_trials_file_has_both_sides_and_what_was_chosen() {
    let study = study(&three_methods());
    let report = report(&study, &planted(&study, &WORTHS, 0.0), 6, Language::English);
    let table = Table::parse(file(&report, "data/trials.csv").as_bytes()).unwrap();
    let cell = |row: usize, name: &str| {
        table.cell(row, table.position(name).unwrap()).unwrap_or_default().to_owned()
    };
    assert!(table.rows() > 100);
    for row in 0..table.rows() {
        let (clip, beside) = (cell(row, "stimulus"), cell(row, "beside"));
        assert!(clip.contains(&format!(".{}.", cell(row, "method"))), "{clip}");
        assert!(beside.contains(&format!(".{}.", cell(row, "beside.method"))), "{beside}");
        let expected = match cell(row, "nearer.answer") {
            same if same == "same" => String::new(),
            side if side == cell(row, "beside_side") => beside,
            _ => clip,
        };
        assert_eq!(cell(row, "nearer.chosen"), expected);
    }
}

#[test]
fn r_and_python_find_the_tests_of_choices_again() {
    let name = "r_and_python_find_the_tests_of_choices_again";
    let rscript = mimique_test_support::rscript(name);
    let python = mimique_test_support::python(name);
    for (case, file, people) in
        [("three", three_methods(), 30), ("few", three_methods(), 4), ("two", two_methods(), 12)]
    {
        let study = study(&file);
        let report = report(&study, &planted(&study, &WORTHS, 0.3), people, Language::English);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("choices-{case}"));
        for file in &report.files {
            let path = folder.join(&file.path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, &file.text).unwrap();
        }
        let numbers = self::file(&report, "data/numbers.csv");
        for key in ["hypothesis:H:recommended 1", "choices:nearer:method:recommended 1"] {
            assert!(numbers.contains(key), "{case}: {numbers}");
        }
        let scripts = [(&rscript, "analysis.R"), (&python, "analysis.py")];
        for (program, script) in scripts {
            let Some(program) = program else { continue };
            let output = Command::new(program).arg(folder.join(script)).output().unwrap();
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(
                output.status.success() && text.contains(" 0 differ"),
                "{case}: {text}\n{errors}"
            );
        }
    }
}

#[test]
fn power_counts_choices_and_the_preregistration_says_the_test_that_decides() {
    let study = study(&three_methods());
    let parameters = Parameters::for_study(&study);
    let options = PowerOptions {
        participants: vec![24],
        clips: vec![18],
        runs: 40,
        seed: 5,
        alpha: 0.05,
        false_positives: true,
        mixed: false,
    };
    let found = power(&study, "hash", &parameters, &options, &|| {}).unwrap();
    let own = &found.points[0].hypotheses[0];
    assert!(own.effect);
    assert!(own.power.deciding.share > 0.8, "{:?}", own.power);
    let none = own.false_positives.unwrap();
    assert!(none.deciding.share <= 0.15, "{none:?}");
    for (language, words) in [
        (Language::English, "decides: equal worths in the Bradley-Terry model"),
        (Language::French, "décide : égalité des valeurs dans le modèle de Bradley-Terry"),
    ] {
        let text = preregistered(&study, &parameters, &found, language);
        assert!(text.contains(words), "{text}");
        assert!(!text.contains("Friedman test on person means"), "{text}");
    }
}

#[test]
fn worths_of_a_parameters_file_are_checked_against_the_study() {
    let study = study(&three_methods());
    let base = Parameters::for_study(&study);
    let read = |text: &str| Parameters::read_over(&base, text, &study);
    let given =
        read(r#"{"comparisons": {"nearer": {"worth": {"real": 0.5}, "tie": -9}}}"#).unwrap();
    assert_eq!(given.comparisons["nearer"].worth.len(), 1);
    for (text, place) in [
        (
            r#"{"comparisons": {"nearer": {"worth": {"gone": 1}}}}"#,
            "/comparisons/nearer/worth/gone",
        ),
        (r#"{"comparisons": {"nearer": {"factor": "gone"}}}"#, "/comparisons/nearer/factor"),
        (r#"{"comparisons": {"nearer": {"personSd": -1}}}"#, "/comparisons/nearer/personSd"),
        (r#"{"comparisons": {"nearer": {"lapse": 2}}}"#, "/comparisons/nearer/lapse"),
        (r#"{"comparisons": {"fidelity": {}}}"#, "/comparisons/fidelity"),
    ] {
        assert_eq!(read(text).unwrap_err().pointer, place, "{text}");
    }
}

/// The places and codes of what is wrong with a study file.
fn problems(file: &Value) -> Vec<(String, String)> {
    let checked = mimique_study::check(&file.to_string(), &|_| Ok(()));
    let errors = checked.issues.iter().filter(|issue| issue.severity == Severity::Error);
    errors.map(|issue| (issue.pointer.clone(), issue.code().to_owned())).collect()
}

#[test]
fn a_test_of_choices_is_refused_where_nothing_is_chosen_between() {
    let mut right = three_methods();
    assert_eq!(problems(&right), [], "three methods");
    assert_eq!(problems(&two_methods()), [], "two methods");
    right["hypotheses"][0]["test"] = "sign".into();
    let place = |of: &str| format!("/hypotheses/0/{of}");
    assert_eq!(problems(&right), [(place("levels"), "wrong-length".to_owned())]);
    right["hypotheses"][0]["levels"] = json!(["box", "real"]);
    assert_eq!(problems(&right), []);
    for (key, value, expected) in [
        ("factors", json!(["expression"]), (place("factors/0"), "no-pairs")),
        ("measure", json!("rt"), (place("test"), "no-choice")),
        ("test", json!("friedman"), (place("factors/0"), "of-two-clips")),
    ] {
        let mut wrong = three_methods();
        wrong["hypotheses"][0][key] = value;
        let found = problems(&wrong);
        assert!(found.contains(&(expected.0.clone(), expected.1.to_owned())), "{key}: {found:?}");
    }
    let mut parted = three_methods();
    parted["components"].as_object_mut().unwrap().retain(|name, _| name == "first");
    parted["sequence"]["components"] = json!(["first"]);
    parted["hypotheses"][0]["levels"] = json!(["box", "lsts30", "real"]);
    assert_eq!(problems(&parted), [(place("factors/0"), "pairs-in-parts".to_owned())]);
}

/// Of two methods the share of choices is the estimate, and a direction belongs to the verdict.
#[test]
fn choices_of_two_methods_have_a_verdict_with_its_direction_in_every_specification() {
    let study = study(&two_methods());
    let parameters = planted(&study, &[("box", -0.7), ("lsts30", 0.7)], 0.0);
    let simulation = Simulation::new(&study, "hash", &parameters, 11).unwrap();
    let csv = simulated_export(&simulation, &study, 30);
    let table = Table::parse(csv.as_bytes()).unwrap();
    let options = ReportOptions { multiverse: true, ..ReportOptions::default() };
    let report = analyze_with(&table, &study, Language::English, options).unwrap();
    let results: Value = serde_json::from_str(file(&report, "results.json")).unwrap();
    let own = &results["sensitivity"]["hypotheses"][0];
    for each in own["specifications"].as_array().unwrap() {
        assert!(["linear_model", "person_means"].contains(&each["test"].as_str().unwrap()));
        assert_eq!(each["verdict"]["direction"]["higher"], "lsts30", "{each}");
        assert_eq!(each["estimate"]["unit"], "chosen", "{each}");
        assert_eq!(each["estimate"]["levels"], json!(["box", "lsts30"]));
        assert!(number(&each["estimate"]["value"]) < 0.35, "{each}");
    }
    assert_eq!(own["dependence"], json!([]));
    let said = &report.sensitivity[0].1;
    assert!(said.contains("is chosen more often"), "{said}");
    assert!(!file(&report, "figures/sensitivity-h.svg").contains("NaN"));
}
