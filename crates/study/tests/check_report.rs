//! The check: studies of the repository are clean, each kind of mistake is found and named.

mod support;

use mimique_study::{Issue, Report, Severity, check, json_schema};
use support::{study_folder, study_text};

fn everything_is_there(_: &str) -> Result<(), (String, String)> {
    Ok(())
}

fn complaints(report: &Report) -> String {
    report.issues.iter().map(line).collect()
}

/// As `mimique check` prints it.
fn line(issue: &Issue) -> String {
    let severity = match issue.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let Issue { pointer, code, message, hint, .. } = issue;
    let place = if pointer.is_empty() { "/" } else { pointer };
    format!("{severity} {place} [{code}] {message}; {hint}\n")
}

#[test]
fn studies_of_the_repository_have_no_problem() {
    let mut checked = 0;
    for entry in std::fs::read_dir(study_folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let text = std::fs::read_to_string(&path).unwrap();
            let report = check(&text, &everything_is_there);
            assert_eq!(complaints(&report), "", "{}", path.display());
            assert!(report.study.is_some());
            checked += 1;
        }
    }
    assert!(checked >= 3, "{checked} studies");
}

/// `MIMIQUE_UPDATE=1 cargo test` writes the expected reports and the schema anew; look at the
/// difference before you keep it.
fn update_wanted() -> bool {
    std::env::var_os("MIMIQUE_UPDATE").is_some()
}

#[test]
fn each_mistake_has_its_report() {
    let folder = study_folder().join("invalid");
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    assert!(files.len() >= 20, "{} files", files.len());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let lookup = |path: &str| -> Result<(), (String, String)> {
            if path.contains("absent") {
                Err((format!("no file \"{path}\""), "put the file there, or mend the path".into()))
            } else {
                Ok(())
            }
        };
        let report = complaints(&check(&text, &lookup));
        let expected_file = file.with_extension("expected.txt");
        if update_wanted() {
            std::fs::write(&expected_file, &report).unwrap();
        }
        let expected = std::fs::read_to_string(&expected_file).unwrap_or_default();
        assert!(!report.is_empty(), "{}: nothing found", file.display());
        assert_eq!(report, expected, "{}", file.display());
    }
}

#[test]
fn schema_is_the_one_in_the_repository() {
    let schema = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
    let file = study_folder().join("schema/study.schema.json");
    if update_wanted() {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, &schema).unwrap();
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(
        kept == schema,
        "{} is not current; write it anew with MIMIQUE_UPDATE=1",
        file.display()
    );
}

#[test]
fn all_problems_come_at_once_with_their_places() {
    let text = study_text("demo.json")
        .replace("\"numItems\": 7", "\"numitems\": \"seven\"")
        .replace("\"languages\": [\"en\", \"fr\"]", "\"langages\": [\"en\", \"fr\"]");
    let report = check(&text, &everything_is_there);
    let unknown: Vec<&Issue> =
        report.issues.iter().filter(|issue| issue.code == "unknown-key").collect();
    assert_eq!(unknown.len(), 4, "three scales and the languages: {}", complaints(&report));
    assert!(unknown.iter().any(|issue| {
        issue.pointer == "/demographics/questions/1/numitems"
            && issue.hint == "did you mean \"numItems\"?"
    }));
    assert!(unknown.iter().any(|issue| issue.hint == "did you mean \"languages\"?"));
    assert!(report.study.is_none());
}

#[test]
fn nonsense_is_an_error_and_never_a_panic() {
    let nested = "[".repeat(100_000);
    let deep = format!("{{\"sequence\": {}", "{\"components\": [".repeat(20_000));
    for text in ["", "{", "null", "[]", "3", "{\"id\": 1}", "\u{feff}{}", "NaN", &nested, &deep] {
        let report = check(text, &everything_is_there);
        assert!(report.errors() > 0, "{:.20}", text);
    }
}
