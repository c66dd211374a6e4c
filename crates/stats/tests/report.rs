//! The report of a simulated study: complete, the same each time, and true to what was planted.

mod support;

use std::collections::BTreeSet;

use mimique_stats::{Language, Table, analyze};
use support::{Raters, demo_study, export};

fn report(raters: &Raters, language: Language) -> mimique_stats::Report {
    let study = demo_study();
    let table = Table::parse(export(&study, raters).as_bytes()).unwrap();
    analyze(&table, &study, language).unwrap()
}

fn results(report: &mimique_stats::Report) -> serde_json::Value {
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    serde_json::from_str(&file.text).unwrap()
}

#[test]
fn writes_the_same_bytes_each_time() {
    let raters = Raters { people: 9, effect: 0.5, seed: 4 };
    assert_eq!(report(&raters, Language::English), report(&raters, Language::English));
}

#[test]
fn holds_every_part_under_its_own_name() {
    for language in [Language::English, Language::French] {
        let report = report(&Raters { people: 12, effect: 1.0, seed: 2 }, language);
        let paths: BTreeSet<&str> = report.files.iter().map(|file| file.path.as_str()).collect();
        assert_eq!(paths.len(), report.files.len(), "two files of one name: {paths:?}");
        for path in [
            "report.html",
            "report.md",
            "results.json",
            "tables/hypothesis-h1.csv",
            "tables/late-frames.csv",
            "figures/participants.svg",
            "figures/emotion-confusion-lsts.svg",
            "figures/emotion-shares.svg",
            "figures/believability-by-method.svg",
            "figures/believability-by-method-differences.svg",
            "figures/response-times.svg",
        ] {
            assert!(paths.contains(path), "{path} is missing among {paths:?}");
        }
        let page = &report.files[0].text;
        assert!(page.contains(&format!("<html lang=\"{}\">", language.code())));
        // One file, no network: nothing is fetched.
        for fetched in ["src=", "@import", "url(", "<script", "<link"] {
            assert!(!page.contains(fetched), "{fetched} in the page");
        }
        for file in report.files.iter().filter(|file| file.path.ends_with(".svg")) {
            assert!(file.text.contains("role=\"img\"") && file.text.contains("aria-label=\""));
            assert!(!file.text.contains("NaN") && !file.text.contains("inf"), "{}", file.path);
        }
        assert!(!page.contains("NaN"));
    }
}

#[test]
fn finds_a_planted_effect_and_says_who_stands_behind_it() {
    let report = report(&Raters { people: 28, effect: 1.0, seed: 7 }, Language::English);
    let results = results(&report);
    let hypothesis = &results["hypotheses"][1];
    assert_eq!(hypothesis["id"], "H2");
    let pair = &hypothesis["recommended"]["pairs"][0];
    assert_eq!([&pair["a"], &pair["b"]], ["lsts", "box"]);
    assert_eq!(pair["n"], 27);
    assert!(pair["wilcoxon"]["p_value"].as_f64().unwrap() < 1e-4);
    let difference = &pair["difference"];
    assert!(difference["ci_low"].as_f64().unwrap() < 1.0);
    assert!(difference["ci_high"].as_f64().unwrap() > 0.8);
    let reading = &report.readings[1].1;
    assert!(reading.contains("lsts was rated higher than box"), "{reading}");
    assert!(reading.contains("of 27 people"), "{reading}");
    assert_eq!(hypothesis["as_in_the_thesis"]["assumes"], "independent observations");
}

#[test]
fn shows_no_difference_where_there_is_none_and_does_not_call_it_proof() {
    let report = report(&Raters { people: 20, effect: 0.0, seed: 11 }, Language::English);
    let reading = &report.readings[2].1;
    assert!(reading.contains("no difference between lsts and box was shown"), "{reading}");
    assert!(reading.contains("no proof that there is none"), "{reading}");
}

#[test]
fn counts_who_and_what_is_left_out() {
    let raters = Raters { people: 14, effect: 0.0, seed: 3 };
    let results = results(&report(&raters, Language::English));
    let flow = &results["flow"];
    assert_eq!(flow["people"], 14);
    assert_eq!(flow["people_left_out"]["incomplete"], 1);
    assert_eq!(flow["people_used"], 13);
    let late = flow["trials_left_out"]["late frames"].as_u64().unwrap();
    assert!(late > 0);
    assert_eq!(flow["trials_used"].as_u64().unwrap() + late, 13 * 12);
}

#[test]
fn two_people_are_too_few_and_that_is_said() {
    let report = report(&Raters { people: 3, effect: 2.0, seed: 5 }, Language::English);
    let reading = &report.readings[1].1;
    assert!(reading.contains("too few to compare lsts and box"), "{reading}");
    assert!(reading.contains("p could not fall below 0.500"), "{reading}");
    let french = self::report(&Raters { people: 2, effect: 0.0, seed: 5 }, Language::French);
    assert!(french.files[0].text.contains("Comme dans la thèse"));
}

#[test]
fn an_export_without_trials_or_columns_is_refused() {
    let study = demo_study();
    let only_incomplete = export(&study, &Raters { people: 1, effect: 0.0, seed: 1 });
    let table = Table::parse(only_incomplete.as_bytes()).unwrap();
    let refusal = analyze(&table, &study, Language::English).unwrap_err().to_string();
    let wanted = "no trial is left: 1 of 1 people and 0 of 0 trials are left out (incomplete: 1)";
    assert!(refusal.contains(wanted), "{refusal}");
    let table = Table::parse(b"a,b\n1,2\n").unwrap();
    let refusal = analyze(&table, &study, Language::English).unwrap_err().to_string();
    assert!(refusal.contains("column \"participant_id\": there is no such column"), "{refusal}");
}
