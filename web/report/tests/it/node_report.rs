//! The module that a capsule loads gives the report that the native program gives: every file byte for byte, but for numbers
//! that are written unrounded, which agree to 1e-12.
//!
//! Needs node and the module built by `cargo xtask web` (in `target/web-dist`, or where `MIMIQUE_WEB_DIST` says).

use std::collections::BTreeMap;
use std::process::Command;

use mimique_analysis::{Parameters, ReportOptions, Simulation, StudyVersions, analyze_with};
use mimique_locale::Language;
use mimique_server::export::{Format, Unstored};
use mimique_stats::Table;
use mimique_study::{Study, answer_hashes};
use mimique_test_support::{repository, study_text, web_module};
use serde_json::{Value, json};

/// A study of the repository, simulated: its file, its export, its report.
fn case(name: &str, people: u64, language: Language, change: impl Fn(&mut Value)) -> Value {
    let mut file = mimique_study::parse(&study_text(name)).unwrap();
    change(&mut file);
    let study = Study::from_value(&file).unwrap();
    let writer = Unstored::new(file.clone(), BTreeMap::new(), Format::Csv).unwrap();
    let parameters = Parameters::for_study(&study);
    let simulation = Simulation::new(&study, writer.config_hash(), &parameters, 7).unwrap();
    let written =
        simulation.sessions(people, |one| writer.write(&one.started, &one.events).unwrap());
    let exported = writer.join(written.unwrap()).unwrap();
    let csv = String::from_utf8(exported.files[0].1.clone()).unwrap();
    let table = Table::parse(csv.as_str()).unwrap();
    let hashes = answer_hashes(&file);
    let versions = StudyVersions { config_hashes: &hashes, served: &[] };
    let options =
        ReportOptions { preview: Some("../index.html"), versions, ..ReportOptions::default() };
    let report = analyze_with(&table, &study, language, options).unwrap();
    let files: BTreeMap<_, _> =
        report.files.iter().map(|file| (file.path.clone(), file.text.clone())).collect();
    json!({
        "name": name, "csv": csv, "study": file.to_string(), "language": language.code(), "files": files,
        "summary": { "people": [report.people.0, report.people.1], "trials": report.trials, "readings": report.readings },
    })
}

#[test]
fn the_browser_s_report_is_the_native_one() {
    let as_it_is = |_: &mut Value| {};
    let stricter = |file: &mut Value| {
        file["exclusions"] = json!({ "incomplete": true, "lateFrameShare": 0.01 });
        file["hypotheses"][2]["test"] = json!("mann-whitney");
    };
    let cases = [
        case("demo.json", 30, Language::English, as_it_is),
        case("demo.json", 30, Language::French, stricter),
        case("study1.json", 20, Language::English, as_it_is),
        case("study2a.json", 20, Language::English, as_it_is),
    ];
    assert_ne!(cases[0]["files"]["results.json"], cases[1]["files"]["results.json"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cases.json");
    std::fs::write(&path, json!(cases).to_string()).unwrap();
    let test = "the_browser_s_report_is_the_native_one";
    let Some(dist) = web_module(test, "report") else { return };
    let output = Command::new("node")
        .arg(repository().join("tests/wasm/report_bytes.mjs"))
        .args([&dist, &path])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    eprintln!("{said}");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "run cargo xtask web if it is old\n{said}{errors}");
}
