//! A report of an export in memory, and the people whom a test simulates.

use mimique_analysis::{Parameters, Report, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::Value;

/// The report, and its `results.json`.
pub fn report(study: &Study, csv: &str, language: Language) -> (Report, Value) {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let report = analyze(&table, study, language).unwrap();
    let results = serde_json::from_str(&text(&report, "results.json")).unwrap();
    (report, results)
}

/// A file of a report.
pub fn text(report: &Report, path: &str) -> String {
    let file = report.files.iter().find(|file| file.path == path);
    file.unwrap_or_else(|| panic!("{path} is written")).text.clone()
}

/// People who answer with care and all come to the end.
pub fn careful(study: &Study) -> Parameters {
    let mut parameters = Parameters::for_study(study);
    parameters.careless.share = 0.0;
    parameters.dropout.declined = 0.0;
    parameters.dropout.per_trial = 0.0;
    parameters
}
