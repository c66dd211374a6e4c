//! Answers held against measures of the stimuli: what is planted is found, and tables that cannot be used are refused.

use std::fmt::Write as _;

use mimique_analysis::{ExportError, Report, ReportOptions, StimuliError, analyze_with};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::Value;

use crate::support::{Raters, demo_study, export};

fn report(study: &Study, stimuli: &str, language: Language) -> Result<Report, ExportError> {
    let table = Table::parse(export(study, &Raters { people: 30, effect: 1.5, seed: 7 })).unwrap();
    let stimuli = Table::parse(stimuli).unwrap();
    let options = ReportOptions { stimuli: Some(&stimuli), ..ReportOptions::default() };
    analyze_with(&table, study, language, options)
}

/// A row per clip: a measure that follows the planted effect of the method, one that has nothing to do with anything, and a note.
fn planted(study: &Study) -> String {
    let mut text = "stimulus,segment,method,duration_ms,follows,unrelated,note\n".to_owned();
    for (place, clip) in study.clips().iter().enumerate() {
        let follows = if clip.method == "lsts30" { -1.0 } else { 1.0 } + 1e-3 * place as f64;
        let unrelated = (place * 7919 + 13) % 101;
        let (id, segment, method) = (&clip.id, &clip.segment, &clip.method);
        writeln!(text, "{id},{segment},{method},1000,{follows},{unrelated},a note").unwrap();
    }
    text
}

fn results(report: &Report) -> Vec<Value> {
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    let results: Value = serde_json::from_str(&file.text).unwrap();
    results["stimulus_measures"].as_array().cloned().unwrap_or_default()
}

#[test]
fn a_measure_that_goes_with_the_answers_is_told_from_one_that_does_not() {
    let study = demo_study();
    let report = report(&study, &planted(&study), Language::English).unwrap();
    let told = results(&report);
    let of = |measure: &str| -> Vec<&Value> {
        told.iter().filter(|each| each["measure"] == measure).collect()
    };
    let follows = of("follows");
    assert!(!follows.is_empty());
    assert_eq!(follows.len(), of("unrelated").len());
    // Neither a duration nor a text is a measure.
    assert_eq!(told.len(), 2 * follows.len());
    let ratings = follows.iter().filter(|each| each["response"] != "emotion");
    for each in ratings {
        // What is the larger is rated the lower, and more plainly within one performance.
        let [all, within] =
            ["all", "within_performances"].map(|over| each[over]["rho"].as_f64().unwrap());
        assert!(within < -0.8 && within < all + 0.05, "{each}");
        let ends = each["within_performances"]["ci95"].as_array().unwrap();
        let [low, high] = [0, 1].map(|end| ends[end].as_f64().unwrap());
        // Performances that are drawn twice tie their ranks, which takes the interval a little farther from 0.
        assert!(-1.0 <= low && low < high && high < -0.8 && (low - within).abs() < 0.1, "{each}");
        assert_eq!(each["all"]["stimuli"], study.clips().len());
    }
    for each in of("unrelated") {
        assert!(each["all"]["rho"].as_f64().unwrap().abs() < 0.5, "{each}");
    }
}

#[test]
fn the_table_stands_in_the_report_in_both_languages_and_only_where_it_is_given() {
    let study = demo_study();
    let stimuli = planted(&study).replace("follows", "obj_marker_correlation");
    for (language, heading, words) in [
        (Language::English, "Answers and measures of the stimuli", "Correlation with the markers"),
        (Language::French, "Réponses et mesures des stimuli", "Corrélation avec les marqueurs"),
    ] {
        let report = report(&study, &stimuli, language).unwrap();
        let page = report.files.iter().find(|file| file.path == "report.md").unwrap();
        assert!(page.text.contains(heading) && page.text.contains(words));
        assert!(report.files.iter().any(|f| f.path.ends_with("-and-stimulus-measures.csv")));
    }
    // A table without measures leaves the report as it is.
    let bare: String = (planted(&study).lines())
        .map(|line| line.split(',').take(4).collect::<Vec<_>>().join(",") + "\n")
        .collect();
    let report = report(&study, &bare, Language::English).unwrap();
    assert!(results(&report).is_empty());
    assert!(!report.files.iter().any(|file| file.text.contains("measures of the stimuli")));
}

#[test]
fn clips_prepared_anew_are_left_out_and_said() {
    let study = demo_study();
    let first = study.clips()[0].id.clone();
    let stimuli = planted(&study);
    let again = stimuli.lines().find(|line| line.starts_with(&format!("{first},"))).unwrap();
    let again = again.replace(",13,", ",14,");
    let report = report(&study, &format!("{stimuli}{again}\n"), Language::English).unwrap();
    let page = report.files.iter().find(|file| file.path == "report.md").unwrap();
    assert!(page.text.contains(&format!("between versions of the study: {first}")), "said");
    let told = results(&report);
    assert_eq!(told[0]["all"]["stimuli"], study.clips().len() - 1);
}

#[test]
fn tables_that_cannot_be_used_are_refused() {
    let study = demo_study();
    let refused = |text: &str| match report(&study, text, Language::English) {
        Err(ExportError::Stimuli(error)) => error,
        other => panic!("{other:?}"),
    };
    let headless = planted(&study).replacen("stimulus,", "clip,", 1);
    assert_eq!(refused(&headless), StimuliError::NoStimulus);
    let spoilt = planted(&study).replacen(",13,", ",thirteen,", 1);
    let StimuliError::NotANumber { column, line, cell } = refused(&spoilt) else { panic!() };
    assert_eq!((column.as_str(), line, cell.as_str()), ("unrelated", 2, "thirteen"));
}
