//! `analysis.R` and `analysis.py` as a reader runs them: every number of the report once more, by other
//! programs.

use std::process::Command;

use mimique_analysis::{Report, Simulation, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{CompositeScale, Study};

use crate::support::confident::confident;
use crate::support::equivalence::equivalence;
use crate::support::followed::{followed, followers};
use crate::support::planted::export_of_passes;
use crate::support::rerun::{compare, numbers, run, write};
use crate::support::simulated::simulated_export;
use crate::support::{Raters, demo_study, export, parameter_study, study_in_conditions};

fn reports() -> Vec<(&'static str, Report)> {
    let (mut demo, mut conditions) = (demo_study(), study_in_conditions());
    let methods = ["lsts30", "box"];
    demo.hypotheses.push(equivalence("E1", "believability", "method", methods, 0.5));
    demo.hypotheses.push(equivalence("E2", "emotion", "method", methods, 0.1));
    let scale = |items: [&str; 2], reversed: &[&str]| CompositeScale {
        items: items.map(str::to_owned).into(),
        reversed: reversed.iter().map(|item| (*item).to_owned()).collect(),
    };
    let items = ["believability", "perceived_intensity"];
    demo.scales.insert("strength".to_owned(), scale(items, &[]));
    conditions.scales.insert("strength".to_owned(), scale(items, &["perceived_intensity"]));
    let groups = ["rested", "at-once"];
    let own = equivalence("E3", "believability", "assigned_condition", groups, 0.5);
    conditions.hypotheses.push(own);
    let report = |study: &Study, csv: &str| {
        analyze(&Table::parse(csv.as_bytes()).unwrap(), study, Language::French).unwrap()
    };
    let mut reports: Vec<(&str, Report)> = [
        ("demo", demo, Raters { people: 9, effect: 0.5, seed: 4 }),
        ("parameter", parameter_study(), Raters { people: 14, effect: 0.3, seed: 8 }),
        ("conditions", conditions, Raters { people: 17, effect: 0.3, seed: 15 }),
    ]
    .into_iter()
    .map(|(name, study, raters)| (name, report(&study, &export(&study, &raters))))
    .collect();
    // Enough signals for everybody's own d' by method, and area below the ROC curve.
    let mut often = confident(demo_study());
    (often.exclusions, often.hypotheses) = (None, Vec::new());
    reports.push(("often", report(&often, &export_of_passes(&often, 8, 6))));
    // A rating that follows the clip.
    let study = followed();
    let parameters = followers(&study, [("box", 60.0), ("lsts", 80.0), ("recorded", 90.0)]);
    let simulation = Simulation::new(&study, "hash", &parameters, 7).unwrap();
    reports.push(("followed", report(&study, &simulated_export(&simulation, &study, 9))));
    reports
}

#[test]
fn r_finds_every_number_again() {
    let Some(rscript) = mimique_test_support::rscript("r_finds_every_number_again") else { return };
    for (name, report) in reports() {
        let folder = write(&report, &format!("r-{name}"));
        // The first model of the small study is fitted too, where its package is installed.
        let models = if name == "demo" { "one-model" } else { "no-models" };
        let text = run(Command::new(&rscript).arg(folder.join("analysis.R")).arg(models));
        for model in ["Cumulative link mixed model of believability", "Binomial mixed model of"] {
            // A line that follows the clip has no steps.
            assert!(text.contains(model) || name == "followed", "{text}");
        }
        let failed =
            |line: &&str| line.contains("not fitted") && !line.contains("install.packages");
        assert_eq!(text.lines().find(failed), None, "{text}");
        assert!(compare(&report, &folder, "numbers-r.csv") > 60);
    }
}

#[test]
fn python_finds_every_number_again() {
    let Some(python) = mimique_test_support::python("python_finds_every_number_again") else {
        return;
    };
    for (name, report) in reports() {
        let folder = write(&report, &format!("python-{name}"));
        run(Command::new(&python).arg(folder.join("analysis.py")));
        assert!(compare(&report, &folder, "numbers-python.csv") > 60);
    }
}

/// What is computed person by person is among them.
#[test]
fn d_primes_by_method_and_courses_are_computed_again() {
    let keys = |wanted: &str| -> Vec<String> {
        let (_, report) = reports().into_iter().find(|(name, _)| *name == wanted).unwrap();
        let file = report.files.iter().find(|file| file.path == "data/numbers.csv").unwrap();
        numbers(&file.text).into_keys().map(|(key, name)| format!("{key} {name}")).collect()
    };
    let often = keys("often");
    for key in [
        "detection:emotion:method:anger:box effect",
        "detection:emotion:method:anger:d':box | lsts30 p",
        "detection:emotion:method:anger:c:box | lsts30 p_holm",
        "roc:emotion:anger low",
        "roc:emotion:anger:all hits.3",
    ] {
        assert!(often.iter().any(|own| own == key), "{key}");
    }
    let followed = keys("followed");
    for key in [
        "trace:strength:method:box:1 mean",
        "trace:strength:method:lsts:31 low",
        "trace:strength:method:box | recorded mass.1",
        "trace:strength:method:box | recorded:p p.1",
        "trace:strength:method:box | lsts:p p_holm",
    ] {
        assert!(followed.iter().any(|own| own == key), "{key}");
    }
}

/// Every p of results.json is among the numbers that the scripts compute.
#[test]
fn no_p_of_the_results_is_left_out() {
    for (_, report) in reports() {
        let file = |path: &str| &report.files.iter().find(|file| file.path == path).unwrap().text;
        let known: Vec<u64> =
            numbers(file("data/numbers.csv")).values().map(|value| value.to_bits()).collect();
        let results: serde_json::Value = serde_json::from_str(file("results.json")).unwrap();
        let mut found = 0;
        let mut left = vec![&results];
        while let Some(value) = left.pop() {
            match value {
                serde_json::Value::Object(map) => {
                    for key in ["p_value", "statistic", "p_holm", "p_holm_over_hypotheses"] {
                        if let Some(number) = map.get(key).and_then(|value| value.as_f64()) {
                            assert!(known.contains(&number.to_bits()), "{key} {number}");
                            found += 1;
                        }
                    }
                    left.extend(map.values());
                }
                serde_json::Value::Array(items) => left.extend(items),
                _ => {}
            }
        }
        assert!(found > 20, "{found}");
    }
}
