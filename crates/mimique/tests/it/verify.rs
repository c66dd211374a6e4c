//! `mimique verify`: exit code 0 where all is right, 1 where a value is wrong, 2 where nothing can be
//! computed; text and JSON.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::{mimique, ok, refused, text};

/// A folder with one case of statistics: four numbers and their mean.
fn folder(mean: f64) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let expected = json!({"cases": [{
        "id": "four", "test": "descriptives", "file": "four.csv", "columns": {"response": "y"},
        "expected": {"n": 4, "mean": mean},
    }]});
    std::fs::write(folder.path().join("four.csv"), "y\n1\n2\n3\n4\n").unwrap();
    std::fs::write(folder.path().join("expected.json"), expected.to_string()).unwrap();
    folder
}

/// What a run printed that must end with 1.
fn wrong(args: &[&str]) -> String {
    let out = mimique(args);
    assert_eq!(out.status.code(), Some(1), "{}", String::from_utf8_lossy(&out.stderr));
    assert!(out.stderr.is_empty(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).unwrap()
}

#[test]
fn right_cases_end_with_0() {
    let folder = folder(2.5);
    let path = text(folder.path());
    assert_eq!(ok(&["verify", &path]), "right  four  2 values\n1 case, 2 values: all right\n");
    let told: Value = serde_json::from_str(&ok(&["verify", &path, "--json"])).unwrap();
    assert_eq!(
        told,
        json!({"cases": [{"case": "four", "right": true, "values": [
            {"field": "mean", "expected": 2.5, "got": 2.5, "tolerance": 2.5e-9},
            {"field": "n", "expected": 4, "got": 4, "tolerance": 4e-9},
        ]}]})
    );
}

#[test]
fn a_planted_mistake_ends_with_1_and_names_the_field() {
    let folder = folder(2.500001);
    let path = text(folder.path());
    assert_eq!(
        wrong(&["verify", &path]),
        "wrong  four  1 of 2 values\n         mean: 2.5 where 2.500001 is expected, within 2.5e-9\n\
         1 case, 1 wrong; 2 values, 1 wrong\n"
    );
    let told: Value = serde_json::from_str(&wrong(&["verify", &path, "--json"])).unwrap();
    assert_eq!(told["cases"][0]["right"], false);
    assert_eq!(told["cases"][0]["values"][0]["field"], "mean");
}

#[test]
fn what_is_no_folder_of_cases_ends_with_2() {
    let folder = folder(2.5);
    let path = text(folder.path());
    std::fs::write(folder.path().join("expected.json"), "{\"cases\": [").unwrap();
    let said = refused(&["verify", &path]);
    assert!(said.contains("expected.json: line 1, column 11: no JSON ("), "{said}");
    std::fs::remove_file(folder.path().join("expected.json")).unwrap();
    let said = refused(&["verify", &path]);
    assert!(said.contains("holds no case that is known; give a folder of cases ("), "{said}");
    let said = refused(&["verify", &text(&folder.path().join("four.csv"))]);
    assert!(said.contains("four.csv: a file, and cases are folders; give the folder"), "{said}");
    let said = refused(&["verify", &text(Path::new("/nowhere/at/all"))]);
    assert!(said.contains("/nowhere/at/all: cannot be read ("), "{said}");
}
