//! The examples of `docs/guide/recruitment.md` are study files that the check has nothing to say against.

use mimique_session::Standing::{
    ChecksFailed, Completed, Declined, DeviceRefused, InProgress, ScreenedOut, Withdrawn,
};
use mimique_study::{Study, check, parse};
use serde_json::{Value, json};

use crate::support::study_text;

/// The blocks of JSON of a page of the documentation: a section of the study file each.
fn sections(page: &str) -> Vec<Value> {
    let path = format!("{}/../../docs/guide/{page}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let blocks = text.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(|block| parse(&format!("{{{block}}}")).unwrap()).collect()
}

/// A study from which a session can end in every way.
fn study_with(section: &Value) -> Value {
    let mut file = parse(&study_text("template.json")).unwrap();
    for (key, value) in section.as_object().unwrap() {
        file[key] = value.clone();
    }
    file
}

#[test]
fn every_example_passes_the_check() {
    let sections = sections("recruitment.md");
    assert!(sections.len() >= 5, "{} examples", sections.len());
    for section in &sections {
        assert!(section.get("recruitment").is_some(), "{section}");
        let report = check(&study_with(section).to_string(), &|_| Ok(()));
        assert!(report.study.is_some() && report.issues.is_empty(), "{section}: {report:?}");
    }
}

#[test]
fn an_example_without_one_of_its_codes_is_complained_about() {
    let prolific = &sections("recruitment.md")[0];
    for code in ["completionCode", "screenedOutCode", "failedChecksCode"] {
        let mut less = prolific.clone();
        less["recruitment"].as_object_mut().unwrap().remove(code).unwrap();
        let report = check(&study_with(&less).to_string(), &|_| Ok(()));
        let codes: Vec<_> = report.issues.iter().map(|issue| issue.code()).collect();
        assert_eq!(codes, ["no-code"], "without {code}");
    }
}

#[test]
fn each_way_out_has_the_code_that_the_page_says() {
    let codes = |section: &Value| {
        let study = Study::from_value(&study_with(section)).unwrap();
        [Completed, ScreenedOut, ChecksFailed, Declined, Withdrawn, InProgress, DeviceRefused]
            .map(|standing| standing.completion_code(&study.recruitment).map(str::to_owned))
    };
    for section in sections("recruitment.md") {
        let named = |name: &str| {
            section["recruitment"].get(name).and_then(Value::as_str).map(str::to_owned)
        };
        let [completed, screened_out, failed_checks, rest @ .., refused] = codes(&section);
        assert_eq!(completed, named("completionCode"));
        assert_eq!(screened_out, named("screenedOutCode"));
        assert_eq!(refused, screened_out);
        assert_eq!(failed_checks, named("failedChecksCode"));
        assert_eq!(json!(rest), json!([null, null, null]));
    }
}
