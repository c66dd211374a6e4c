//! What is planted in an export is found, by its column or question, and nothing of it is left where it is left out.

use std::collections::BTreeMap;

use mimique_deposit::{
    Answers, Finding, Kind, NotAnswered, Pattern, Responses, Texts, known_columns, personal, rare,
};
use mimique_session::rows::Column;
use mimique_study::{Study, parse};
use serde_json::json;

/// The demonstration with a question whose answer is a text.
fn study() -> Study {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
    let mut file = parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let questions = file["demographics"]["questions"].as_array_mut().unwrap();
    questions.push(json!({ "id": "remarks", "type": "longText", "prompt": "Anything else?" }));
    Study::from_value(&file).unwrap()
}

/// A table with these rows; what a row does not name is empty.
fn table(extra: &[&str], rows: &[&[(&str, &str)]], known: &BTreeMap<String, Column>) -> Responses {
    let columns: Vec<&str> =
        known.keys().map(String::as_str).chain(extra.iter().copied()).collect();
    let mut text = columns.join(",") + "\n";
    for row in rows {
        let cell = |name: &&str| {
            let found = row.iter().find(|(own, _)| own == name);
            format!("\"{}\"", found.map_or("", |(_, value)| value))
        };
        text += &columns.iter().map(cell).collect::<Vec<_>>().join(",");
        text += "\n";
    }
    Responses::read(text.as_bytes()).unwrap()
}

fn planted() -> (Study, BTreeMap<String, Column>, Responses) {
    let study = study();
    let known = known_columns(&[&study]);
    let rows: [&[(&str, &str)]; 4] = [
        &[
            ("participant_id", "p1"),
            ("response_id", "emotion"),
            ("answer", "joy"),
            ("response", "joy"),
            ("rt", "1520.5"),
            ("start_time", "2026-11-27T10:00:00.000Z"),
            ("weights_hash", "0123456789012345678901234567890123456789012345678901234567890123"),
            ("browser", "Mozilla/5.0 (X11; Linux x86_64)"),
            ("PROLIFIC_PID", "5f2b1c9e8a7d6c5b4a392817"),
            ("age", "31"),
        ],
        &[
            ("participant_id", "p1"),
            ("response_id", "remarks"),
            ("answer", "ask me: jo@example.org"),
            ("response", "ask me: jo@example.org"),
            ("remarks", "ask me: jo@example.org"),
            ("age", "31"),
        ],
        &[
            ("participant_id", "p2"),
            ("response_id", "emotion"),
            ("answer", "fear"),
            // Only in the second of the two cells that say the same.
            ("response", "+33 6 12 34 56 78"),
            ("note", "seat 4"),
            ("rt", "192.168.0.17"),
            ("exclusion_reason", "Jo Smith asked for it"),
            ("age", "44"),
        ],
        &[("participant_id", "p3"), ("age", "44")],
    ];
    let responses = table(&["PROLIFIC_PID", "note"], &rows, &known);
    (study, known, responses)
}

fn found(responses: &Responses) -> Vec<Finding> {
    let study = study();
    personal(responses, "answers.csv", &[&study], &known_columns(&[&study]))
}

#[test]
fn everything_planted_is_found_with_its_place() {
    let (_, _, responses) = planted();
    let told: Vec<(String, Kind, usize, usize)> = found(&responses)
        .into_iter()
        .map(|own| (own.key, own.kind, own.values, own.first_line))
        .collect();
    for (key, kind, line) in [
        ("PROLIFIC_PID", Kind::RecruitmentIdentifier, 2),
        ("browser", Kind::Looks(Pattern::UserAgent), 2),
        ("start_time", Kind::ClockTime, 2),
        ("remarks", Kind::FreeText, 3),
        ("remarks", Kind::Looks(Pattern::EmailAddress), 3),
        ("emotion", Kind::Looks(Pattern::PhoneNumber), 4),
        ("note", Kind::AddedColumn, 4),
        ("rt", Kind::Looks(Pattern::NetworkAddress), 4),
        ("exclusion_reason", Kind::FreeText, 4),
    ] {
        let is_there = told.iter().any(|own| (&*own.0, own.1, own.3) == (key, kind, line));
        assert!(is_there, "{key} {kind:?} in line {line}: {told:?}");
    }
    // The column of the answer and its row are told apart; nothing else is found.
    assert_eq!(told.len(), 11, "{told:?}");
}

#[test]
fn what_is_left_out_is_nowhere_and_identifiers_always_are() {
    let (study, known, responses) = planted();
    let findings = found(&responses);
    let open = Answers { texts: Some(Texts::Keep), ..Answers::default() };
    let unanswered = open.judge(&findings).unanswered;
    let keys: Vec<&str> = unanswered.iter().map(|own| &*own.key).collect();
    assert!(
        keys.contains(&"remarks"),
        "an address in a text is asked about all the same: {keys:?}"
    );
    assert!(!keys.contains(&"exclusion_reason") && !keys.contains(&"PROLIFIC_PID"), "{keys:?}");

    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let answers = Answers {
        keep: names(&["rt"]),
        drop: names(&["browser", "start_time", "emotion", "note"]),
        texts: Some(Texts::Drop),
    };
    answers.check(&responses, &findings, &known).unwrap();
    let judged = answers.judge(&findings);
    assert_eq!(judged.unanswered, []);
    let mut left = responses.clone();
    judged.apply(&mut left);
    let text = String::from_utf8(left.to_csv().unwrap()).unwrap();
    for secret in ["jo@example", "+33", "5f2b1c9e", "Mozilla", "2026-11-27", "seat 4", "Jo Smith"] {
        assert!(!text.contains(secret), "{secret}: {text}");
    }
    assert!(text.contains("192.168.0.17"), "what is kept is there");
    assert_eq!(left.len(), 4, "no row goes");
    let again = personal(&left, "answers.csv", &[&study], &known);
    assert!(again.iter().all(|own| own.key == "rt"), "{again:?}");
}

#[test]
fn answers_that_cannot_be_are_refused() {
    let (_, known, responses) = planted();
    let findings = found(&responses);
    let check = |keep: &[&str], drop: &[&str]| {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let answers = Answers { keep: names(keep), drop: names(drop), texts: None };
        answers.check(&responses, &findings, &known)
    };
    assert!(matches!(check(&["PROLIFIC_PID"], &[]), Err(NotAnswered::Identifies { .. })));
    assert!(matches!(check(&["note"], &["note"]), Err(NotAnswered::Both { .. })));
    assert!(matches!(check(&[], &["participant_id"]), Err(NotAnswered::Needed { .. })));
    let unknown = check(&[], &["remark"]).unwrap_err().to_string();
    assert!(unknown.contains("--drop remark") && unknown.contains("remarks"), "{unknown}");
}

#[test]
fn people_whom_their_answers_tell_apart_are_counted() {
    let (study, _, responses) = planted();
    let rare = rare(&responses, &study).unwrap();
    assert_eq!((rare.alone, rare.people), (1, 3), "one is 31, two are 44");
    assert!(
        rare.columns.contains(&"age".to_owned()) && !rare.columns.contains(&"remarks".to_owned())
    );
}
