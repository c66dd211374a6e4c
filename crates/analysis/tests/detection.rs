//! d' and criterion of a forced choice in the report: means over people where everybody saw enough, else of all answers
//! together.

#[expect(dead_code, reason = "other tests take the other studies")]
mod support;

use mimique_analysis::{Language, Report, analyze};
use mimique_stats::Table;
use serde_json::Value;
use support::{Raters, demo_study, export};

/// The report of people each of whom met every clip `times` times.
fn report(times: usize, language: Language) -> Report {
    let mut study = demo_study();
    study.exclusions = None;
    let once = export(&study, &Raters { people: 12, effect: 0.0, seed: 9 });
    let mut text = once.lines().next().unwrap().to_owned() + "\n";
    for person in 1..12 {
        for time in 0..times {
            // Of another seed each time: who answers twice does not answer alike.
            let csv = export(&study, &Raters { people: 12, effect: 0.0, seed: 9 + time as u64 });
            let id = format!("p{person:04},");
            for line in csv.lines().filter(|line| line.starts_with(&id)) {
                text += &line.replace(",faces/", &format!(",faces/{time}-"));
                text.push('\n');
            }
        }
    }
    analyze(&Table::parse(text.as_bytes()).unwrap(), &study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    &report.files.iter().find(|file| file.path == path).unwrap().text
}

fn categories(report: &Report) -> Vec<Value> {
    let results: Value = serde_json::from_str(file(report, "results.json")).unwrap();
    results["detection"][0]["categories"].as_array().unwrap().clone()
}

#[test]
fn what_is_recognised_more_often_has_the_larger_d_prime() {
    let report = report(4, Language::English);
    let found = categories(&report);
    assert_eq!(found.len(), 6);
    let mean = |name: &str| {
        let own = found.iter().find(|own| own["category"] == name).unwrap();
        assert_eq!(own["of_people"]["people"], 11, "{own}");
        let [low, high] =
            [0, 1].map(|end| own["of_people"]["d_prime_interval_95"][end].as_f64().unwrap());
        let mean = own["of_people"]["d_prime_mean"].as_f64().unwrap();
        assert!(low < mean && mean < high);
        mean
    };
    // Planted: 45 % of anger are recognised, 85 % of surprise.
    assert!(mean("surprise") > mean("anger") + 0.5, "{} {}", mean("surprise"), mean("anger"));
    assert!(mean("anger") > 0.5);
    let plane = file(&report, "figures/emotion-d-prime.svg");
    assert_eq!(plane.matches("class=\"dot\"").count(), 6 * 11);
    assert!(plane.contains("Criterion across"));
}

#[test]
fn few_signals_are_told_of_all_people_together_alone() {
    let report = report(1, Language::French);
    for own in categories(&report) {
        assert!(own["of_people"].is_null(), "{own}");
        assert_eq!(own["pooled"]["status"], "ok");
        // Log-linear: d' of the counts once more.
        let count = |name: &str| own[name].as_u64().unwrap() as f64;
        let rate = |yes: f64, all: f64| (yes + 0.5) / (all + 1.0);
        let z = |rate: f64| -mimique_stats::normal_quantile_upper(rate);
        let hits = rate(count("hits"), count("signals"));
        let alarms = rate(count("false_alarms"), count("noise"));
        let d_prime = own["pooled"]["d_prime"].as_f64().unwrap();
        assert!((z(hits) - z(alarms) - d_prime).abs() < 1e-9, "{own}");
    }
    let table = file(&report, "tables/emotion-detection.csv");
    assert!(table.contains("fausses alarmes"), "{table}");
    let plane = file(&report, "figures/emotion-d-prime.svg");
    assert_eq!(plane.matches("class=\"dot\"").count(), 0);
}
