//! The section "Sensitivity": on which rules, tests, segments and participants a verdict depends, where the answer is
//! planted.

use mimique_analysis::{Report, ReportOptions, analyze_with};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Generalise, Study};
use mimique_test_support::Random;
use serde_json::Value;

use crate::support::equivalence::equivalence;
use crate::support::planted::{answered, cells_changed};
use crate::support::results::text;
use crate::support::{Raters, demo_study, export};

/// Value of a column in the row of an answer.
type Cell<'c> = &'c dyn Fn(&str) -> String;

/// The demonstration with the hypothesis about believability alone, and rules on unfinished sessions and late frames.
fn study(generalise: Option<Generalise>) -> Study {
    let mut study = demo_study();
    study.hypotheses.retain(|hypothesis| hypothesis.id == "H3");
    study.hypotheses[0].generalise = generalise;
    study
}

/// Ratings that follow `mean` of a trial, with a little noise, of people who finish. `is_late` trials have late frames.
fn rated(
    study: &Study,
    people: usize,
    is_late: impl Fn(Cell<'_>) -> bool,
    mean: impl Fn(Cell<'_>) -> f64,
) -> String {
    // The last person of an export does not finish.
    let csv = export(study, &Raters { people: people + 1, effect: 0.0, seed: 31 });
    let mut random = Random::new(5);
    let csv = answered(&csv, "believability", |cell| {
        (mean(cell) + 0.4 * random.normal()).round().clamp(1.0, 7.0).to_string()
    });
    cells_changed(&csv, "frames_late", |cell| {
        Some(if is_late(cell) { cell("frames") } else { "0".to_owned() })
    })
}

fn report(study: &Study, csv: &str, language: Language) -> (Report, Value) {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let options = ReportOptions { multiverse: true, ..ReportOptions::default() };
    let report = analyze_with(&table, study, language, options).unwrap();
    let results: Value = serde_json::from_str(&text(&report, "results.json")).unwrap();
    (report, results["sensitivity"]["hypotheses"][0].clone())
}

/// The section of the report in Markdown.
fn section(report: &Report, heading: &str) -> String {
    let markdown = text(report, "report.md");
    let start = format!("\n## {heading}\n");
    let own = markdown.split_once(&start).expect("the section").1;
    own.split("\n## ").next().unwrap().to_owned()
}

fn is_lsts(cell: Cell<'_>) -> bool {
    cell("method") == "lsts30"
}

#[test]
fn a_clear_effect_has_the_same_verdict_in_every_specification() {
    let study = study(None);
    let mean = |cell: Cell<'_>| if is_lsts(cell) { 5.5 } else { 2.5 };
    let (report, found) = report(&study, &rated(&study, 12, |_| false, mean), Language::English);
    // Two rules, each applied or not, with three tests.
    let specifications = found["specifications"].as_array().unwrap();
    assert_eq!(specifications.len(), 4 * 3);
    for own in specifications {
        assert_eq!(own["verdict"]["decision"]["shown"], "difference", "{own}");
        assert_eq!(own["verdict"]["direction"]["higher"], "lsts30", "{own}");
        let estimate = own["estimate"]["value"].as_f64().unwrap();
        assert!((estimate - 3.0).abs() < 0.3, "planted 3: {own}");
    }
    assert_eq!(found["dependence"], serde_json::json!([]));
    let words = section(&report, "Sensitivity");
    for expected in [
        "The verdict is the same in 12 of 12 specifications. The verdict depends on none of these choices.",
        "None of the 6 segments changes the verdict when omitted.",
        "None of the 12 participants changes the verdict when omitted.",
        "every combination of the rules of exclusion, applied or not (4 in all)",
        "12 specifications for all hypotheses",
    ] {
        assert!(words.contains(expected), "{expected}\n{words}");
    }
    // The first specification is the verdict of the report.
    let results: Value = serde_json::from_str(&text(&report, "results.json")).unwrap();
    assert_eq!(specifications[0]["p"], results["hypotheses"][0]["p_holm_over_hypotheses"]);
    let table = Table::parse(text(&report, "tables/sensitivity.csv").into_bytes()).unwrap();
    assert_eq!(table.rows(), 12);
    let column = table.names().iter().position(|own| own == "as fixed in the study file").unwrap();
    let fixed = (0..table.rows()).filter(|row| table.cell(*row, column) == Some("yes"));
    assert_eq!(fixed.count(), 1);
    let curve = text(&report, "figures/sensitivity-h3.svg");
    assert!(curve.contains("lsts30") || curve.contains("LSTS"), "{curve}");
    assert!(!curve.contains("NaN"), "{curve}");
}

#[test]
fn an_effect_of_late_trials_alone_depends_on_the_rule_about_late_frames() {
    let study = study(None);
    let emotions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
    let is_late = |cell: Cell<'_>| {
        let emotion = emotions.iter().position(|own| *own == cell("expression")).unwrap();
        (cell("participant").parse::<usize>().unwrap() + emotion).is_multiple_of(2)
    };
    let mean = |cell: Cell<'_>| match (is_late(cell), is_lsts(cell)) {
        (true, true) => 6.0,
        (true, false) => 2.0,
        _ => 4.0,
    };
    let csv = rated(&study, 16, is_late, mean);
    for (language, heading, depends) in [
        (
            Language::English,
            "Sensitivity",
            "The verdict depends on the rule that excludes trials with more than 20 % late frames. Without it: null hypothesis of no difference rejected, ",
        ),
        (
            Language::French,
            "Sensibilité",
            "Le verdict dépend de la règle qui exclut les essais ayant plus de 20 % d’images en retard. Sans elle : hypothèse nulle d’absence de différence rejetée, ",
        ),
    ] {
        let (report, found) = report(&study, &csv, language);
        let dependence = found["dependence"].as_array().unwrap();
        assert_eq!(dependence.len(), 1, "{dependence:?}");
        assert_eq!(dependence[0]["changes"], serde_json::json!([{ "without_rule": 1 }]));
        let words = section(&report, heading);
        assert!(words.contains(depends), "{words}");
    }
}

#[test]
fn a_verdict_of_one_outlying_clip_depends_on_that_segment() {
    let study = study(Some(Generalise::TheseClips));
    let mean = |cell: Cell<'_>| match (cell("expression") == "joy", is_lsts(cell)) {
        (true, true) => 7.0,
        (true, false) => 1.0,
        _ => 4.0,
    };
    let (report, found) = report(&study, &rated(&study, 14, |_| false, mean), Language::English);
    let clips = study.clips();
    let joy = clips.iter().find(|clip| clip.factors["expression"].to_string() == "joy").unwrap();
    let words = section(&report, "Sensitivity");
    let expected = format!(
        "The verdict depends on 1 of the 6 segments: without segment {}: null hypothesis of no difference not rejected",
        joy.segment
    );
    assert!(words.contains(&expected), "{expected}\n{words}");
    // Other clips would not show it, and both tests that are about them find so.
    let changes: Vec<&Value> =
        found["dependence"].as_array().unwrap().iter().map(|own| &own["changes"]).collect();
    let tests = ["linear_model", "min_f"].map(|test| serde_json::json!([{ "test": test }]));
    assert_eq!(changes, tests.iter().collect::<Vec<_>>());
    let participants = &found["influence"][1];
    assert_eq!(participants["unit"], "participant");
    assert_eq!(participants["omissions"].as_array().unwrap().len(), 14);
}

/// Of six people the exact test of person means can reach p < 0.05, of five it cannot.
#[test]
fn a_verdict_of_six_people_depends_on_each_of_them() {
    let study = study(Some(Generalise::TheseClips));
    let mean = |cell: Cell<'_>| if is_lsts(cell) { 6.0 } else { 2.0 };
    let (report, _) = report(&study, &rated(&study, 6, |_| false, mean), Language::English);
    let words = section(&report, "Sensitivity");
    assert!(words.contains("The verdict depends on 6 of the 6 participants: without participant p0001: null hypothesis of no difference not rejected (p = 0.062)"), "{words}");
    assert!(words.contains("; the others are in the table."), "{words}");
}

#[test]
fn a_study_without_hypotheses_says_so_and_no_report_has_the_section_unasked() {
    let mut study = study(None);
    let csv = rated(&study, 6, |_| false, |_| 4.0);
    let table = Table::parse(csv.as_bytes()).unwrap();
    let unasked =
        analyze_with(&table, &study, Language::English, ReportOptions::default()).unwrap();
    assert!(!text(&unasked, "report.md").contains("Sensitivity"));
    assert!(!text(&unasked, "results.json").contains("\"sensitivity\""));
    study.hypotheses.clear();
    let (report, _) = report(&study, &csv, Language::English);
    let words = section(&report, "Sensitivity");
    assert!(words.contains("there is no verdict to repeat"), "{words}");
}

#[test]
fn equivalence_is_repeated_with_ranks_and_with_means() {
    let mut study = study(None);
    study.hypotheses = vec![equivalence("E", "believability", "method", ["lsts30", "box"], 1.0)];
    let csv = rated(&study, 14, |_| false, |_| 4.0);
    let (report, found) = report(&study, &csv, Language::English);
    let tests: Vec<&Value> =
        found["specifications"].as_array().unwrap().iter().map(|own| &own["test"]).collect();
    assert_eq!(tests.len(), 4 * 2);
    assert_eq!([tests[0], tests[1]], ["equivalence_of_ranks", "equivalence_of_means"]);
    let words = &report.sensitivity[0].1;
    assert!(words.contains("as fixed in the study file: equivalent (p < 0.001)"), "{words}");
    assert!(words.contains("The verdict is the same in 8 of 8 specifications."), "{words}");
}
