//! d' and criterion of a forced choice in the report: means over people where everybody saw enough, else of all answers
//! together.

use mimique_analysis::{Report, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_test_support::Random;
use serde_json::Value;

use crate::support::demo_study;
use crate::support::planted::{answered, export_of_passes};

/// The report of eleven people each of whom met every clip `times` times.
fn report(times: usize, language: Language) -> Report {
    let mut study = demo_study();
    study.exclusions = None;
    let text = export_of_passes(&study, 11, times);
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

#[test]
fn two_d_primes_planted_by_method_are_found_and_compared_within_people() {
    let mut study = demo_study();
    study.exclusions = None;
    let emotions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
    let mut random = Random::new(5);
    // Half and four fifths right; what is wrong is any other emotion.
    let right = |method: &str| if method == "lsts30" { 0.8 } else { 0.5 };
    let text = export_of_passes(&study, 14, 40);
    let text = answered(&text, "emotion", |cell| {
        let truth = cell("truth");
        if random.uniform() < right(&cell("method")) {
            return truth;
        }
        let others: Vec<&str> = emotions.into_iter().filter(|own| *own != truth).collect();
        others[(random.uniform() * 5.0) as usize].to_owned()
    });
    let table = Table::parse(text.as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::English).unwrap();
    let results: Value = serde_json::from_str(file(&report, "results.json")).unwrap();
    let by = &results["detection"][0]["by"];
    assert_eq!(by.as_array().unwrap().len(), 1, "the emotion itself is no factor of its detection");
    assert_eq!(by[0]["factor"], "method");
    let z = |rate: f64| -mimique_stats::normal_quantile_upper(rate);
    for own in by[0]["categories"].as_array().unwrap() {
        let means = ["box", "lsts30"].map(|method| {
            let right = right(method);
            let planted = z(right) - z((1.0 - right) / 5.0);
            let people = &own["at"][method]["of_people"];
            let mean = people["d_prime_mean"].as_f64().unwrap();
            assert!((mean - planted).abs() < 0.3, "{method}: {mean}, planted {planted}");
            assert_eq!(own["at"][method]["each"].as_object().unwrap().len(), 14);
            mean
        });
        let pair = &own["compared"]["d_prime"]["pairs"][0];
        assert_eq!((pair["a"].as_str(), pair["b"].as_str()), (Some("box"), Some("lsts30")));
        let difference = pair["difference"]["estimate"].as_f64().unwrap();
        assert!((difference - (means[0] - means[1])).abs() < 0.2, "{difference}, {means:?}");
        assert!(pair["wilcoxon"]["p_value"].as_f64().unwrap() < 0.01, "{pair}");
    }
    let planes = file(&report, "figures/emotion-d-prime-by-method.svg");
    assert_eq!(planes.matches("class=\"dot\"").count(), 2 * 6 * 14);
    assert_eq!(planes.matches(">d′</text>").count(), 2);
    let tests = file(&report, "tables/emotion-detection-by-method-tests.csv");
    assert_eq!(tests.lines().count(), 1 + 6 * 2, "{tests}");
    // Every emotion is read with the higher level first and the difference of the table.
    let page = file(&report, "report.md");
    let reading = page.lines().find(|line| line.contains("d′, one value per person")).unwrap();
    assert_eq!(reading.matches(" over ").count(), 6, "{reading}");
    for own in by[0]["categories"].as_array().unwrap() {
        let difference = &own["compared"]["d_prime"]["pairs"][0]["difference"]["estimate"];
        let words = format!("by {:.2}, p", -difference.as_f64().unwrap());
        assert!(reading.contains(&words), "{words}: {reading}");
    }
    let french = analyze(&table, &study, Language::French).unwrap();
    let french = file(&french, "report.md");
    assert!(french.contains("d′, une valeur par personne, diffère entre les niveaux"), "{french}");
}

#[test]
fn where_methods_are_alike_no_difference_of_d_prime_is_read() {
    for (language, words) in [
        (Language::English, "no difference of d′ by"),
        (Language::French, "aucune différence de d′ selon"),
    ] {
        let report = report(20, language);
        let found = file(&report, "report.md");
        let reading = found.lines().find(|line| line.contains(words));
        let results: Value = serde_json::from_str(file(&report, "results.json")).unwrap();
        let categories = results["detection"][0]["by"][0]["categories"].as_array().unwrap();
        let p = |own: &&Value| {
            own["compared"]["d_prime"]["pairs"][0]["wilcoxon"]["p_value"].as_f64().unwrap() >= 0.05
        };
        let alike = categories.iter().filter(p).count();
        assert!(alike > 0 && reading.is_some(), "{alike}: {found}");
    }
}

#[test]
fn levels_with_few_signals_are_not_compared_and_that_is_said() {
    let report = report(1, Language::French);
    let results: Value = serde_json::from_str(file(&report, "results.json")).unwrap();
    for own in results["detection"][0]["by"][0]["categories"].as_array().unwrap() {
        assert!(own["compared"].is_null(), "{own}");
        assert_eq!(own["at"]["box"]["pooled"]["status"], "ok");
    }
    assert!(file(&report, "report.md").contains("les niveaux ne sont pas comparés"));
}
