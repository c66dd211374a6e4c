//! The check: studies of the repository are clean, each kind of mistake is found and named.

use mimique_study::{Issue, Problem, Report, Severity, check, json_schema};

use crate::support::{study_folder, study_text};

fn everything_is_there(_: &str) -> Result<(), Problem> {
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
    let place = issue.place();
    format!("{severity} {place} [{}] {}; {}\n", issue.code(), issue.message(), issue.remedy())
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

/// `MIMIQUE_UPDATE_GOLDEN=1 cargo test` writes the expected reports and the schema anew; look at the
/// difference before you keep it.
fn update_wanted() -> bool {
    std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some()
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
        let lookup = |path: &str| match path.contains("absent") {
            true => Err(Problem::NoFile { path: format!("\"{path}\"") }),
            false => Ok(()),
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
        "{} is not current; write it anew with MIMIQUE_UPDATE_GOLDEN=1",
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
        report.issues.iter().filter(|issue| issue.code() == "unknown-key").collect();
    assert_eq!(unknown.len(), 4, "three scales and the languages: {}", complaints(&report));
    assert!(unknown.iter().any(|issue| {
        issue.pointer == "/demographics/questions/1/numitems"
            && issue.remedy() == "did you mean \"numItems\"?"
    }));
    assert!(unknown.iter().any(|issue| issue.remedy() == "did you mean \"languages\"?"));
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

/// Whatever is changed in a good study, the check answers.
mod broken_studies {
    use mimique_study::check;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

        /// Bytes cut out, doubled or changed: an answer, never a panic.
        #[test]
        fn broken_text_is_answered(
            from in any::<prop::sample::Index>(),
            length in 0_usize..60,
            insert in "[\\[\\]{}\"':,/*\\\\a-z0-9. \n]{0,6}",
        ) {
            let text = super::study_text("template.json");
            let letters: Vec<char> = text.chars().collect();
            let from = from.index(letters.len());
            let to = (from + length).min(letters.len());
            let changed: String =
                letters[..from].iter().copied().chain(insert.chars()).chain(letters[to..].iter().copied()).collect();
            let report = check(&changed, &super::everything_is_there);
            prop_assert_eq!(report.study.is_some(), report.errors() == 0);
        }
    }
}

#[test]
fn a_parameter_of_the_wrong_type_hides_no_other_fault() {
    let text = study_text("invalid/parameter-in-quotes.json");
    let report = check(&text, &everything_is_there);
    let said = complaints(&report);
    for place in [
        "error /stimuli/methods/lsts30/alpha [wrong-type] ",
        "error /stimuli/methods/box/alpha [bad-parameter] ",
        "error /stimuli/methods/soft/laplacian [unknown-word] ",
        "error /consent/minimumAge [wrong-type] ",
        "error /stimuli/methods/soft/kappa [bad-parameter] ",
    ] {
        assert!(said.contains(place), "{place}:\n{said}");
    }
    assert!(!said.contains("error / "), "{said}");
}
