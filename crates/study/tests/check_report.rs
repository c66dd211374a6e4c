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

/// Whatever is changed in a good study, the check answers; and what it lets pass can be run.
mod changed_studies {
    use mimique_study::flow::Plan;
    use mimique_study::wire::SessionStarted;
    use mimique_study::{Study, check, parse};
    use proptest::prelude::*;
    use serde_json::{Value, json};

    /// Pointers of every value of a file.
    fn pointers(value: &Value, here: &str, all: &mut Vec<String>) {
        all.push(here.to_owned());
        match value {
            Value::Object(map) => {
                for (key, value) in map {
                    let key = key.replace('~', "~0").replace('/', "~1");
                    pointers(value, &format!("{here}/{key}"), all);
                }
            }
            Value::Array(items) => {
                for (index, value) in items.iter().enumerate() {
                    pointers(value, &format!("{here}/{index}"), all);
                }
            }
            _ => {}
        }
    }

    fn replacement(choice: u8) -> Value {
        match choice % 12 {
            0 => Value::Null,
            1 => json!(-1),
            2 => json!(0),
            3 => json!(1e300),
            4 => json!(4_294_967_295_u64),
            5 => json!(""),
            6 => json!("faces"),
            7 => json!([]),
            8 => json!({}),
            9 => json!([[["deep"]]]),
            10 => json!({ "en": "x", "fr": "y" }),
            _ => json!(true),
        }
    }

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

        #[test]
        fn never_panic_and_run_if_they_pass(
            changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..4),
        ) {
            let mut value = parse(&super::study_text("template.json")).unwrap();
            for (index, choice, remove) in changes {
                let mut all = Vec::new();
                pointers(&value, "", &mut all);
                let pointer = index.get(&all).clone();
                let (parent, key) = pointer.rsplit_once('/').unwrap_or(("", ""));
                if remove && let Some(Value::Object(map)) = value.pointer_mut(parent) {
                    map.remove(key);
                } else if let Some(place) = value.pointer_mut(&pointer) {
                    *place = replacement(choice);
                }
            }
            let report = check(&value.to_string(), &super::everything_is_there);
            let Some(checked) = report.study else {
                prop_assert!(report.issues.iter().all(|issue| !issue.message.is_empty() && !issue.hint.is_empty()));
                return Ok(());
            };
            let study: Study = checked.study().clone();
            let started = SessionStarted {
                session: "s".into(),
                participant_id: "p1".into(),
                participant: 1,
                slot: 1,
                condition: None,
                seed: study.seed,
                stage: "live".into(),
                config_hash: checked.config_hash().to_owned(),
                withdrawal_code: "w".into(),
            };
            let plan = Plan::new(study, started);
            prop_assert!(plan.is_ok(), "{:?}", plan.err());
            prop_assert!(plan.unwrap().trial_count(false) > 0);
        }
    }
}
