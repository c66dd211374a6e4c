//! Excluded trials make no differences: comparisons within participants use what remains at every level, and the report
//! says where the rules exclude trials unequally.

use mimique_analysis::{Report, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use mimique_test_support::Random;
use serde_json::Value;

use crate::support::planted::{answered, cells_changed};
use crate::support::{Raters, demo_study, export, study_in_conditions};

const PEOPLE: usize = 40;

/// Ratings of the demonstration that follow `mean` of a trial, with noise; the answers to other questions are random.
fn rated(study: &Study, mean: impl Fn(&dyn Fn(&str) -> String) -> f64) -> String {
    let csv = export(study, &Raters { people: PEOPLE, effect: 0.0, seed: 31 });
    let mut random = Random::new(5);
    answered(&csv, "believability", |cell| {
        (mean(cell) + 0.5 * random.normal()).round().clamp(1.0, 7.0).to_string()
    })
}

/// The same export, where every frame of some trials was late: the study's rule excludes them.
fn late(csv: &str, is_late: impl Fn(&dyn Fn(&str) -> String) -> bool) -> String {
    cells_changed(csv, "frames_late", |cell| is_late(cell).then(|| cell("frames")))
}

/// The 36 of 40 participants whose trial is excluded.
fn is_hit(cell: &dyn Fn(&str) -> String) -> bool {
    !cell("participant").parse::<usize>().unwrap().is_multiple_of(10)
}

fn report(study: &Study, csv: &str, language: Language) -> Report {
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    &report.files.iter().find(|file| file.path == path).unwrap().text
}

fn results(report: &Report) -> Value {
    serde_json::from_str(file(report, "results.json")).unwrap()
}

fn comparison<'r>(results: &'r Value, measure: &str, factor: &str) -> &'r Value {
    let all = results["comparisons"].as_array().unwrap();
    all.iter().find(|own| own["measure"] == measure && own["factor"] == factor).unwrap()
}

/// What the report says before its second section.
fn first_screen(report: &Report) -> &str {
    file(report, "report.md").split("\n## ").nth(1).unwrap()
}

/// Ratings follow the emotion alone, and a rule removes the clip of joy by one method from nearly everybody: the methods
/// do not differ, in no test, no mean and no figure.
#[test]
fn a_clip_excluded_at_one_level_makes_no_difference() {
    let study = demo_study();
    let csv = rated(&study, |cell| if cell("expression") == "joy" { 6.0 } else { 3.0 });
    let csv =
        late(&csv, |cell| cell("method") == "box" && cell("expression") == "joy" && is_hit(cell));
    for (language, unequal, matched) in [
        (
            Language::English,
            "The rules exclude trials more often at some levels",
            "matched by segment",
        ),
        (Language::French, "Les règles excluent plus souvent des essais", "apparié par segment"),
    ] {
        let report = report(&study, &csv, language);
        let results = results(&report);
        let hypothesis = &results["hypotheses"][2];
        assert!(hypothesis["p"].as_f64().unwrap() > 0.05, "{hypothesis}");
        let pair = &hypothesis["recommended"]["pairs"][0];
        assert!(pair["difference"]["estimate"].as_f64().unwrap().abs() < 0.15, "{pair}");
        let min_f = hypothesis["other_clips"]["min_f"]["p_value"].as_f64().unwrap();
        assert!(min_f > 0.05, "{min_f}");
        let matching = &hypothesis["matching"];
        assert_eq!(matching["by"], serde_json::json!(["segment"]));
        let shown = matching["sets_shown"].as_u64().unwrap();
        assert!(matching["sets_left"][0].as_u64().unwrap() < shown, "{matching}");
        let reading = hypothesis["reading"].as_str().unwrap();
        assert!(reading.contains(matched), "{reading}");
        let own = comparison(&results, "believability", "method");
        let means = own["person_means"].as_object().unwrap().values();
        let means: Vec<f64> = means.map(|mean| mean.as_f64().unwrap()).collect();
        assert!((means[0] - means[1]).abs() < 0.15, "{means:?}");
        let described = own["descriptions"].as_object().unwrap().values();
        let described: Vec<f64> = described.map(|of| of["mean"].as_f64().unwrap()).collect();
        assert!((described[0] - described[1]).abs() < 0.15, "{described:?}");
        // The rates are shown where they cannot be missed.
        let rates = &results["exclusion_rates"][0];
        assert_eq!(rates["factor"], "method");
        assert!(rates["p_holm"].as_f64().unwrap() < 0.001, "{rates}");
        let screen = first_screen(&report);
        assert!(screen.contains(unequal), "{screen}");
    }
}

/// The mirror image: ratings follow the method alone, and joy loses its clip by the method that is rated higher.
#[test]
fn a_property_of_the_segment_is_matched_on_the_other_factors() {
    let study = demo_study();
    let csv = rated(&study, |cell| if cell("method") == "box" { 6.0 } else { 3.0 });
    let csv =
        late(&csv, |cell| cell("method") == "box" && cell("expression") == "joy" && is_hit(cell));
    let results = results(&report(&study, &csv, Language::English));
    let own = comparison(&results, "believability", "expression");
    assert_eq!(own["matching"]["by"], serde_json::json!(["method"]), "{}", own["matching"]);
    let p = own["recommended"]["overall"][0]["p_value"].as_f64().unwrap();
    assert!(p > 0.05, "{p}");
}

/// Without unequal exclusions there is no warning.
#[test]
fn equal_exclusions_are_no_reason_for_a_warning() {
    let study = demo_study();
    let csv = rated(&study, |_| 4.0);
    let csv = late(&csv, |cell| {
        cell("participant").parse::<usize>().unwrap().is_multiple_of(4)
            && cell("expression") == "joy"
    });
    let report = report(&study, &csv, Language::English);
    let screen = first_screen(&report);
    assert!(!screen.contains("more often at some levels of method"), "{screen}");
    assert!(results(&report)["exclusion_rates"][0]["p_holm"].as_f64().is_none_or(|p| p > 0.05));
}

/// A rule that excludes trials in one condition only is named where it cannot be missed.
#[test]
fn unequal_exclusion_between_conditions_is_a_warning() {
    let mut study = study_in_conditions();
    study.exclusions.as_mut().unwrap().late_frame_share = Some(0.2);
    let csv = export(&study, &Raters { people: PEOPLE, effect: 0.0, seed: 31 });
    let condition = "assigned_condition";
    let csv = late(&csv, |cell| cell(condition) == "rested" && cell("expression") == "joy");
    for (language, words) in [
        (Language::English, "more often in some conditions than in others: "),
        (
            Language::French,
            "plus souvent des essais dans certaines conditions que dans d’autres : ",
        ),
    ] {
        let report = report(&study, &csv, language);
        let results = results(&report);
        let rates = results["exclusion_rates"].as_array().unwrap();
        let own = rates.iter().find(|own| own["factor"] == condition).unwrap();
        assert_eq!(own["between_people"], true);
        assert!(own["p_holm"].as_f64().unwrap() < 0.001, "{own}");
        // Thirteen participants a condition; a few more trials were late by chance.
        let excluded = |level: &str| own["counts"][level][0].as_u64().unwrap();
        assert!(excluded("rested") >= 2 * 13 && excluded("10") < 13, "{own}");
        let screen = first_screen(&report);
        assert!(screen.contains(words), "{screen}");
    }
}

/// Where each participant sees every segment by one method only, segments cannot be matched: the methods are compared all
/// the same.
#[test]
fn a_design_that_shows_each_segment_once_is_compared_without_segments() {
    let study = demo_study();
    let csv = rated(&study, |cell| if cell("method") == "box" { 3.0 } else { 5.0 });
    let emotions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
    let mut lines = csv.lines();
    let heading = lines.next().unwrap();
    let names: Vec<&str> = heading.split(',').collect();
    let place = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let [participant, method, expression] = ["participant", "method", "expression"].map(place);
    let kept = lines.filter(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let emotion = emotions.iter().position(|own| *own == cells[expression]).unwrap();
        let number: usize = cells[participant].parse().unwrap();
        (cells[method] == "box") == (number + emotion).is_multiple_of(2)
    });
    let csv = std::iter::once(heading).chain(kept).collect::<Vec<_>>().join("\n") + "\n";
    let results = results(&report(&study, &csv, Language::English));
    let hypothesis = &results["hypotheses"][2];
    assert!(hypothesis["recommended"]["people"].as_u64().unwrap() > 35, "{hypothesis}");
    assert!(hypothesis["p"].as_f64().unwrap() < 0.001, "{hypothesis}");
    let by = hypothesis["matching"]["by"].as_array().unwrap();
    assert!(!by.contains(&Value::from("segment")), "{by:?}");
}
