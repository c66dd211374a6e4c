//! Every problem at once: damage in one place hides nothing elsewhere, and makes nothing up.

use mimique_study::{Issue, check, parse};
use serde_json::{Value, json};

use crate::support::study_text;

/// Code and place of each problem.
fn found(file: &Value) -> Vec<(String, &'static str)> {
    let report = check(&file.to_string(), &|_| Ok(()));
    report.issues.into_iter().map(|issue| (issue.pointer.clone(), issue.code())).collect()
}

#[test]
fn a_typo_and_a_wrong_type_hide_nothing() {
    let mut file = parse(&study_text("invalid/unsatisfiable-order.json")).unwrap();
    let map = file.as_object_mut().unwrap();
    map.remove("contact");
    map.insert(
        "debreifing".to_owned(),
        json!([{ "heading": { "en": "Thanks", "fr": "Merci" },
        "text": { "en": "Bye.", "fr": "Au revoir." } }]),
    );
    file["questions"][1]["numItems"] = json!("seven");
    file["questions"][0]["prompt"] = json!({ "en": "Which emotion?" });
    let found = found(&file);
    let at = |pointer: &str, code| (pointer.to_owned(), code);
    let wanted = [
        at("/debreifing", "unknown-key"),
        at("/questions/1/numItems", "wrong-type"),
        at("", "no-contact"),
        at("/questions/0/prompt", "missing-translation"),
        at("/sequence/constraints", "unsatisfiable-order"),
    ];
    for each in &wanted {
        assert!(found.contains(each), "{each:?} of {found:?}");
    }
    assert_eq!(found.len(), wanted.len(), "{found:?}");
}

#[test]
fn what_a_misspelt_key_holds_is_checked_at_its_own_place() {
    let mut file = parse(&study_text("invalid/unsatisfiable-order.json")).unwrap();
    file["sequence"]["constraints"] = json!([]);
    let map = file.as_object_mut().unwrap();
    let contact = map.remove("contact").unwrap();
    map.insert("contacts".to_owned(), contact);
    file["contacts"]["investigator"]["email"] = json!("nowhere");
    file["contacts"]["ethicsBoard"]["email"] = json!(3);
    let wanted = [
        ("/contacts", "unknown-key"),
        ("/contacts/ethicsBoard/email", "wrong-type"),
        ("/contacts/investigator/email", "bad-email"),
    ];
    assert_eq!(found(&file), wanted.map(|(pointer, code)| (pointer.to_owned(), code)));
}

/// What docs/guide/study-file.md shows of `mimique check docs/guide/data/bad.json`.
#[test]
fn the_example_of_the_guide_says_what_is_printed_there() {
    let page = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/guide/study-file.md"
    ))
    .unwrap();
    let report = check(r#"{ "id": "x", "languges": ["en"], "components": {} }"#, &|_| Ok(()));
    for issue in &report.issues {
        let (place, message, remedy) = (issue.place(), issue.message(), issue.remedy());
        let line = format!("\nerror: docs/guide/data/bad.json: {place}: {message}; {remedy}\n");
        assert!(page.contains(&line), "{line}");
    }
    let count = format!("\ndocs/guide/data/bad.json: {} errors, 0 warnings\n", report.errors());
    assert!(page.contains(&count), "{count}");
}

/// The pointers of everything in a file.
fn pointers(value: &Value, here: &str, all: &mut Vec<String>) {
    let mut below = |key: &str, value| {
        let place = format!("{here}/{}", key.replace('~', "~0").replace('/', "~1"));
        all.push(place.clone());
        pointers(value, &place, all);
    };
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| below(key, value)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(index, value)| below(&index.to_string(), value));
        }
        _ => {}
    }
}

/// In a good study one value after the other is replaced by one of a wrong type: nothing is said but
/// of that place, for all else is well.
#[test]
fn a_wrong_value_makes_nothing_up_elsewhere() {
    let (mut damaged, mut unread) = (0, 0);
    let mut made_up = String::new();
    for name in ["template.json", "animface.json"] {
        let file = parse(&study_text(name)).unwrap();
        assert_eq!(found(&file), [], "{name}");
        let mut all = Vec::new();
        pointers(&file, "", &mut all);
        for pointer in all {
            for wrong in [json!([[["deep"]]]), json!({ "unheard": { "of": true } }), json!(-0.5)] {
                let mut file = file.clone();
                *file.pointer_mut(&pointer).unwrap() = wrong.clone();
                let report = check(&file.to_string(), &|_| Ok(()));
                let wrong_type = |issue: &Issue| {
                    ["wrong-type", "unknown-key", "missing-key"].contains(&issue.code())
                };
                if !report
                    .issues
                    .iter()
                    .any(|issue| issue.code() == "wrong-type" && issue.pointer == pointer)
                {
                    unread += 1;
                    continue;
                }
                damaged += 1;
                for issue in report.issues {
                    let here = issue.pointer.starts_with(&pointer);
                    if !here || !wrong_type(&issue) {
                        made_up += &format!("{name}: {wrong} at {pointer}: {issue:?}\n");
                    }
                }
            }
        }
    }
    eprintln!("{damaged} wrong values; {unread} could stand there");
    assert_eq!(made_up, "");
    assert!(damaged > 1_000, "{damaged}");
}

/// The same where a key is missing.
#[test]
fn a_missing_key_makes_nothing_up_elsewhere() {
    let mut missing = 0;
    let mut made_up = String::new();
    for name in ["template.json", "study2b.json", "animface.json"] {
        let file = parse(&study_text(name)).unwrap();
        let mut all = Vec::new();
        pointers(&file, "", &mut all);
        for pointer in all {
            let mut file = file.clone();
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let Some(Value::Object(map)) = file.pointer_mut(parent) else { continue };
            map.remove(&key.replace("~1", "/").replace("~0", "~"));
            let report = check(&file.to_string(), &|_| Ok(()));
            if report.issues.first().is_none_or(|issue| issue.code() != "missing-key") {
                continue;
            }
            missing += 1;
            for issue in &report.issues[1..] {
                made_up += &format!("{name}: {pointer}: {issue:?}\n");
            }
        }
    }
    assert_eq!(made_up, "");
    assert!(missing > 100, "{missing}");
}

/// Where it cannot be read which sequences are conditional, nothing is said of the conditions.
#[test]
fn conditions_that_cannot_be_read_are_not_missed() {
    let mut file = parse(&study_text("invalid/condition-within-people.json")).unwrap();
    for place in 0..2 {
        file["sequence"]["components"][place]["conditional"] = json!("yes");
    }
    let codes: Vec<&str> = found(&file).into_iter().map(|(_, code)| code).collect();
    assert_eq!(codes, ["wrong-type", "wrong-type"]);
}

#[test]
fn recorded_weights_that_are_only_played_need_no_marker_map() {
    let codes = |methods: Value| -> Vec<&'static str> {
        let mut file = parse(&study_text("demo.json")).unwrap();
        file["stimuli"]["captures"] = json!({"take": {"file": "weights.csv"}});
        file["stimuli"]["segments"] =
            json!([{"id": "one", "capture": "take", "first": 0, "end": 90}]);
        file["stimuli"]["methods"] = methods;
        let markers = ["no-markers", "no-neutral", "no-head"];
        let of_capture = found(&file).into_iter().filter(|(place, code)| {
            place.starts_with("/stimuli/captures/take") && markers.contains(code)
        });
        of_capture.map(|(_, code)| code).collect()
    };
    assert_eq!(codes(json!({"real": {"method": "recorded"}})), [""; 0]);
    let solved = codes(json!({"real": {"method": "recorded"}, "lsts": {"method": "lsts"}}));
    assert_eq!(solved, ["no-markers", "no-neutral", "no-head"]);
}
