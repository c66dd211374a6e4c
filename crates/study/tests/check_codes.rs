//! Every kind of problem that the check can report stands in an expected report of
//! `study-config/invalid`.

mod support;

use std::collections::BTreeSet;

use support::study_folder;

/// Codes that no file can bring about.
const NEVER: [&str; 1] = ["shape"];

/// The second argument of each call that reports a problem, as the sources of the check have it.
fn codes_of_the_sources() -> BTreeSet<String> {
    let folder = format!("{}/src/check", env!("CARGO_MANIFEST_DIR"));
    let mut codes = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        for call in ["issues.error(", "issues.warning(", "self.fault("] {
            for (start, _) in text.match_indices(call) {
                let argument = second_argument(&text[start + call.len()..]);
                let code = argument.trim().strip_prefix('"').and_then(|it| it.strip_suffix('"'));
                // Only the helper that passes a code on names none.
                assert!(code.is_some() || argument.trim() == "code", "{call}…{argument}");
                codes.extend(code.map(str::to_owned));
            }
        }
    }
    codes
}

fn second_argument(text: &str) -> String {
    let (mut depth, mut commas, mut quoted, mut escaped) = (0, 0, false, false);
    let mut argument = String::new();
    for letter in text.chars() {
        match letter {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' if depth > 0 => depth -= 1,
            ',' if depth == 0 => {
                commas += 1;
                continue;
            }
            _ => {}
        }
        match commas {
            0 => {}
            1 => argument.push(letter),
            _ => break,
        }
    }
    argument
}

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
    let emitted = codes_of_the_sources();
    assert!(emitted.len() > 60, "{emitted:?}");
    let unseen: Vec<&String> =
        emitted.difference(&reported).filter(|code| !NEVER.contains(&code.as_str())).collect();
    assert!(unseen.is_empty(), "no file of study-config/invalid shows {unseen:?}");
    let unknown: Vec<&String> = reported.difference(&emitted).collect();
    assert!(unknown.is_empty(), "the check reports no {unknown:?}");
}
