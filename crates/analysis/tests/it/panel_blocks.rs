//! Panels, from people who know the reference to report, screening, scripts, power and preregistration.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use mimique_analysis::{Parameters, PowerOptions, Report, Simulation, analyze, power};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{PanelBlock, Study};
use serde_json::Value;

use crate::support::preregistered::preregistered;
use crate::support::simulated::simulated_export;

fn study() -> Study {
    let file = mimique_study::parse(include_str!("../../../../study-config/panel.json")).unwrap();
    Study::from_value(&file).unwrap()
}

/// The same study, whose panel leaves nobody out.
fn without_exclusion() -> Study {
    let mut study = study();
    let mut block = study.panel_blocks().next().unwrap().1;
    block.exclude = None;
    let block = PanelBlock::new(serde_json::to_value(block).unwrap());
    study.components.insert("quality".to_owned(), mimique_study::Component::Panel(block));
    study
}

/// Ratings whose means are 45 (box), 55 (ridge), 60 (lsts) and 25 (anchor); `misses`: the share who do not find the
/// reference.
fn planted(study: &Study, misses: f64) -> Parameters {
    let mut parameters = Parameters::for_study(study);
    let own = parameters.ratings.get_mut("faithful").unwrap();
    (own.mean, own.noise_sd, own.person_sd, own.clip_sd) = (0.0, 6.0, 5.0, 0.0);
    (own.segment_sd, own.per_trial) = (2.0, 0.0);
    own.person_by_sd = BTreeMap::new();
    own.effects = BTreeMap::from([(
        "method".to_owned(),
        [("box", 45.0), ("ridge", 55.0), ("lsts", 60.0), ("recorded", 70.0), ("slow", 25.0)]
            .map(|(level, mean)| (level.to_owned(), mean))
            .into(),
    )]);
    parameters.careless.share = 0.0;
    parameters.dropout.per_trial = 0.0;
    parameters.dropout.declined = 0.0;
    let panel = parameters.panels.get_mut("quality").unwrap();
    (panel.page_sd, panel.misses_reference) = (8.0, misses);
    parameters
}

fn export(study: &Study, misses: f64, people: u64) -> String {
    let parameters = planted(study, misses);
    let simulation = Simulation::new(study, "hash", &parameters, 5).unwrap();
    simulated_export(&simulation, study, people)
}

fn report(study: &Study, csv: &str, language: Language) -> Report {
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    let found = report.files.iter().find(|file| file.path == path);
    &found.unwrap_or_else(|| panic!("no {path}")).text
}

fn results(report: &Report) -> Value {
    serde_json::from_str(file(report, "results.json")).unwrap()
}

#[test]
fn planted_means_are_found_again_and_the_order_agrees() {
    let study = study();
    let results = results(&report(&study, &export(&study, 0.0, 40), Language::English));
    let panel = &results["panels"][0];
    assert_eq!(
        (panel["block"].as_str(), panel["response"].as_str()),
        (Some("quality"), Some("faithful"))
    );
    let conditions = &panel["conditions"];
    assert_eq!(conditions["levels"].as_array().unwrap().len(), 3, "without reference and anchor");
    let means = &conditions["person_means"];
    for (level, planted) in [("box", 45.0), ("ridge", 55.0), ("lsts", 60.0)] {
        let mean = means[level].as_f64().unwrap();
        // Of people 5 / sqrt 40, of six segments 2 / sqrt 6, of pages 8 / sqrt 240: 1.3.
        assert!((mean - planted).abs() < 4.0, "{level}: {mean}");
    }
    let difference = means["lsts"].as_f64().unwrap() - means["box"].as_f64().unwrap();
    assert!((difference - 15.0).abs() < 2.0, "pages cancel: {difference}");
    assert!(conditions["recommended"]["overall"][0]["p_value"].as_f64().unwrap() < 1e-6);
    let worths = &panel["order"]["worths"];
    let items: Vec<&str> =
        worths["items"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let worth = |level: &str| {
        worths["worth"][items.iter().position(|item| *item == level).unwrap()].as_f64()
    };
    if let Some(best) = worth("recorded") {
        let order = ["slow", "box", "ridge", "lsts"].map(|level| worth(level).unwrap());
        assert!(order.is_sorted() && order[3] < best, "{order:?} {best}");
    } else {
        // The reference is at the top of every page: it never lost.
        assert!(worths["reason"].as_str().unwrap().contains("recorded"), "{worths}");
    }
}

#[test]
fn who_misses_the_reference_is_screened_and_left_out_where_the_study_says_so() {
    let (applied, printed) = (study(), without_exclusion());
    let csv = export(&applied, 0.3, 40);
    let [with, without] =
        [&applied, &printed].map(|study| results(&report(study, &csv, Language::English)));
    let out = |results: &Value| {
        let people =
            results["panels"][0]["screening"]["found"]["people"].as_array().unwrap().clone();
        people.iter().filter(|person| person["excluded"] == true).count() as u64
    };
    let missed = out(&with);
    assert!((4..=20).contains(&missed), "30 % of 40 with a standard deviation of 3: {missed}");
    assert_eq!(out(&without), missed);
    assert_eq!(with["flow"]["people_used"], 40 - missed);
    assert_eq!(without["flow"]["people_used"], 40);
    let reasons = &with["flow"]["people_left_out"];
    assert_eq!(reasons["missed the hidden reference or the anchor (BS.1534)"], missed);
    assert_eq!(with["flow"]["rules"].as_array().unwrap().last().unwrap(), "bs1534 (quality)");
    let text = file(&report(&printed, &csv, Language::French), "report.md").to_owned();
    assert!(text.contains("n’applique pas cette règle"), "{text}");
    // With the means of the applied rule, the reference is at the top.
    let described = |results: &Value| {
        results["comparisons"]
            .as_array()
            .unwrap()
            .iter()
            .find(|own| own["measure"] == "faithful" && own["factor"] == "method")
            .unwrap()["person_means"]["recorded"]
            .as_f64()
            .unwrap()
    };
    assert_eq!(described(&with), 100.0);
    assert!(described(&without) < 98.0);
}

#[test]
fn a_page_has_a_row_for_each_clip_in_the_export() {
    let study = study();
    let table = Table::parse(export(&study, 0.1, 4).as_bytes()).unwrap();
    let column = |name: &str| -> Vec<String> {
        table.column(name).unwrap().map(|cell| cell.unwrap_or_default().to_owned()).collect()
    };
    let [trial, order, stimulus, response, condition, role, place] = [
        "trial_id",
        "trial_order",
        "stimulus",
        "response_id",
        "panel_condition",
        "panel_role",
        "panel_place",
    ]
    .map(column);
    let rows: Vec<usize> = (0..table.rows()).filter(|&row| response[row] == "faithful").collect();
    assert_eq!(rows.len(), 4 * 6 * 5);
    for page in rows.chunks(5) {
        let first = page[0];
        for (at, &row) in page.iter().enumerate() {
            assert_eq!((&trial[row], &order[row]), (&trial[first], &order[first]));
            assert_eq!(place[row], (at + 1).to_string());
            let segment = trial[row].strip_prefix("quality/").unwrap().split('|').next().unwrap();
            assert_eq!(stimulus[row], format!("{segment}.{}", condition[row]));
            let expected = match condition[row].as_str() {
                "recorded" => "reference",
                "slow" => "anchor",
                _ => "condition",
            };
            assert_eq!(role[row], expected);
        }
    }
}

#[test]
fn r_and_python_find_the_panel_again() {
    let study = without_exclusion();
    let report = report(&study, &export(&study, 0.5, 30), Language::English);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("panel");
    for file in &report.files {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.text).unwrap();
    }
    let numbers = file(&report, "data/numbers.csv");
    assert!(
        numbers.contains("panel:quality:order") && numbers.contains("panel:quality:recommended"),
        "{numbers}"
    );
    let rscript = mimique_test_support::rscript("r_and_python_find_the_panel_again");
    let python = mimique_test_support::python("r_and_python_find_the_panel_again");
    for (program, script) in [(rscript, "analysis.R"), (python, "analysis.py")] {
        let Some(program) = program else { continue };
        let output = Command::new(program).arg(folder.join(script)).arg("no-models").output();
        let output = output.unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && text.contains(" 0 differ"), "{script}: {text}{errors}");
    }
}

#[test]
fn power_is_that_of_every_page_and_the_preregistration_names_the_rule() {
    let study = study();
    // So small that not everybody orders the three alike, where Friedman's F has no finite value.
    let mut parameters = planted(&study, 0.1);
    let own = parameters.ratings.get_mut("faithful").unwrap();
    let means = [("box", 50.0), ("ridge", 53.0), ("lsts", 56.0)];
    let means = means.map(|(level, mean)| (level.to_owned(), mean));
    own.effects.get_mut("method").unwrap().extend(means);
    own.person_by_sd = BTreeMap::from([("method".to_owned(), 3.0)]);
    let options = PowerOptions {
        participants: vec![12],
        clips: vec![30],
        runs: 20,
        seed: 5,
        alpha: 0.05,
        false_positives: true,
        mixed: false,
    };
    let found = power(&study, "hash", &parameters, &options, &|| {}).unwrap();
    let own = &found.points[0].hypotheses[0];
    assert!(own.effect && own.power.deciding.share > 0.7, "{:?}", own.power);
    for (language, words) in [
        (Language::English, ["6 pages in all", "BS.1534-3", "slow is the anchor"]),
        (Language::French, ["6 pages en tout", "BS.1534-3", "slow est l’ancre"]),
    ] {
        let text = preregistered(&study, &parameters, &found, language);
        assert!(words.iter().all(|words| text.contains(words)), "{text}");
    }
}
