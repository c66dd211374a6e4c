//! Every kind of problem that the check can report stands in an expected report of
//! `study-config/invalid`.

use std::collections::BTreeSet;

use mimique_study::Problem;

use crate::support::study_folder;

/// Codes that no text of a study file can bring about; `upload` is of the archive around it,
/// `smoothing-advised`, `clips-unlike` and `not-prepared` of the captures and clips that it names.
const NEVER: [&str; 6] =
    ["shape", "upload", "smoothing-advised", "clips-unlike", "not-prepared", "sound-ends-early"];

#[test]
fn every_code_has_an_expected_report() {
    let mut reported = BTreeSet::new();
    for entry in std::fs::read_dir(study_folder().join("invalid")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "txt") {
            continue;
        }
        for line in std::fs::read_to_string(path).unwrap().lines() {
            // `error /a pointer [code] message`
            let code = line.split_once(" [").and_then(|(_, rest)| rest.split_once("] "));
            reported.insert(code.unwrap().0.to_owned());
        }
    }
    let emitted: BTreeSet<String> = Problem::CODES.iter().map(|code| (*code).to_owned()).collect();
    assert!(emitted.len() > 60, "{emitted:?}");
    let unseen: Vec<&String> =
        emitted.difference(&reported).filter(|code| !NEVER.contains(&code.as_str())).collect();
    assert!(unseen.is_empty(), "no file of study-config/invalid shows {unseen:?}");
    let unknown: Vec<&String> = reported.difference(&emitted).collect();
    assert!(unknown.is_empty(), "the check reports no {unknown:?}");
}
