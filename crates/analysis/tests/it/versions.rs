//! The answers of an export belong to the study of the analysis: another study is refused, another version is shown with
//! what differs.

use mimique_analysis::{
    ExportError, Report, ReportOptions, ServedVersion, StudyVersions, analyze_with,
};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;

use crate::support::planted::cells_changed;
use crate::support::{Raters, demo_study, export, parameter_study};

const OWN: &str = "1111111111111111111111111111111111111111111111111111111111111111";
const OTHER: &str = "2222222222222222222222222222222222222222222222222222222222222222";

/// An export of the study of which the first ten participants met another version.
fn mixed(study: &Study) -> String {
    let csv = export(study, &Raters { people: 24, effect: 0.5, seed: 8 });
    cells_changed(&csv, "config_hash", |cell| {
        let earlier = cell("participant").parse::<usize>().unwrap() <= 10;
        Some(if earlier { OTHER } else { OWN }.to_owned())
    })
}

fn report(
    csv: &str,
    study: &Study,
    served: &[ServedVersion],
    language: Language,
) -> Result<Report, ExportError> {
    let versions = StudyVersions { config_hashes: &[OWN.to_owned()], served };
    let options = ReportOptions { versions, ..ReportOptions::default() };
    analyze_with(&Table::parse(csv.as_bytes()).unwrap(), study, language, options)
}

fn first_screen(report: &Report) -> &str {
    let file = report.files.iter().find(|file| file.path == "report.md").unwrap();
    file.text.split("\n## ").nth(1).unwrap()
}

#[test]
fn another_version_is_shown_with_what_differs() {
    let study = demo_study();
    let mut served = study.clone();
    served.exclusions.as_mut().unwrap().late_frame_share = Some(0.1);
    served.hypotheses[1].response = "believability".to_owned();
    served.hypotheses.remove(3);
    let served = [ServedVersion { config_hashes: vec![OTHER.to_owned()], study: served }];
    for (language, lines) in [
        (
            Language::English,
            [
                "10 participants answered another version of this study (222222222222)",
                "rule lateFrameShare (served: 0.1; here: 0.2)",
                "hypothesis H2",
                "hypothesis H4 (served: absent;",
            ],
        ),
        (
            Language::French,
            [
                "10 personnes ont répondu à une autre version de cette étude (222222222222)",
                "règle lateFrameShare (servie : 0.1 ; ici : 0.2)",
                "hypothèse H2",
                "hypothèse H4 (servie : absent ;",
            ],
        ),
    ] {
        let report = report(&mixed(&study), &study, &served, language).unwrap();
        let screen = first_screen(&report);
        for line in lines {
            assert!(screen.contains(line), "{line} in {screen}");
        }
        let text = &report.files.iter().find(|file| file.path == "report.md").unwrap().text;
        let fixed = language.pick("fixed in the study file", "fixées dans le fichier de l’étude");
        assert!(!text.contains(fixed), "rules are said to be fixed beforehand");
    }
}

#[test]
fn a_version_whose_file_is_unknown_is_shown_too() {
    let study = demo_study();
    let report = report(&mixed(&study), &study, &[], Language::English).unwrap();
    assert!(first_screen(&report).contains("The file of that version is not known here"));
}

#[test]
fn answers_to_the_file_of_the_analysis_need_no_warning() {
    let study = demo_study();
    let csv = cells_changed(&mixed(&study), "config_hash", |_| Some(OWN.to_owned()));
    let report = report(&csv, &study, &[], Language::English).unwrap();
    assert!(!first_screen(&report).contains("another version"));
}

#[test]
fn another_study_is_refused() {
    let study = demo_study();
    // Known by its file.
    let mut other = study.clone();
    other.id = "another".to_owned();
    let served = [ServedVersion { config_hashes: vec![OTHER.to_owned()], study: other }];
    let error = report(&mixed(&study), &study, &served, Language::English).unwrap_err();
    let words = error.to_string();
    assert!(words.contains("config_hash") && words.contains("\"another\""), "{words}");
    // Known by its clips and questions alone.
    let csv = mixed(&parameter_study());
    let error = report(&csv, &study, &[], Language::English).unwrap_err();
    assert!(matches!(error, ExportError::AnotherStudy { of: None, .. }), "{error}");
}
