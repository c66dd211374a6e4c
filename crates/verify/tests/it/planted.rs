//! Folders made here: what is wrong is named, what cannot be read is refused.

use std::path::Path;

use mimique_verify::{Case, VerifyError, verify};
use serde_json::{Value, json};

fn write(folder: &Path, name: &str, text: &str) {
    let file = folder.join(name);
    std::fs::create_dir_all(file.parent().unwrap()).unwrap();
    std::fs::write(file, text).unwrap();
}

fn run(folder: &Path) -> Result<Vec<Case>, VerifyError> {
    let mut cases = Vec::new();
    verify(folder, &mut |case| cases.push(case)).map(|_| cases)
}

fn cases(files: &[(&str, Value)]) -> Vec<Case> {
    let folder = tempfile::tempdir().unwrap();
    for (name, value) in files {
        write(folder.path(), name, &text(value));
    }
    run(folder.path()).unwrap()
}

/// JSON, or a text as it is.
fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn wrong(case: &Case) -> Vec<&str> {
    case.wrong().map(|value| value.field.as_str()).collect()
}

fn said(files: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        write(folder.path(), name, text);
    }
    let error = run(folder.path()).unwrap_err().to_string();
    error.replace(&folder.path().display().to_string(), "DIR")
}

fn descriptives(id: &str, expected: Value) -> Value {
    json!({"id": id, "test": "descriptives", "file": "d.csv", "columns": {"response": "y"},
        "expected": expected})
}

#[test]
fn a_wrong_value_is_named_and_the_others_are_right() {
    let cases = cases(&[
        ("d.csv", json!("y\n1\n2\n3\n4\n")),
        (
            "expected.json",
            json!({"cases": [
                descriptives("right", json!({"n": 4, "mean": 2.5, "median": 2.5})),
                descriptives("wrong", json!({"n": 4, "mean": 2.500001, "unheard of": 1})),
                {"id": "test", "test": "no such", "file": "d.csv", "columns": {}, "expected": {}},
                {"id": "status", "test": "kruskal_wallis", "file": "d.csv",
                    "columns": {"response": "y", "group": "none"}, "expected": {"status": "ok"}},
            ]}),
        ),
    ]);
    let right: Vec<bool> = cases.iter().map(|case| case.right).collect();
    assert_eq!(right, [true, false, false, false]);
    assert_eq!(wrong(&cases[1]), ["mean", "unheard of"]);
    assert_eq!(wrong(&cases[2]), ["test"]);
    assert_eq!(wrong(&cases[3]), ["status"]);
    let mean = cases[1].wrong().next().unwrap();
    assert_eq!((&mean.expected, &mean.got), (&json!(2.500001), &json!(2.5)));
    assert!((mean.tolerance - 2.500001e-9).abs() < 1e-18, "{}", mean.tolerance);
}

#[test]
fn refused_and_undefined_are_expected_with_a_column_and_without_p() {
    let case = |status: &str, group: &str| {
        json!({"id": format!("{status} {group}"), "test": "kruskal_wallis", "file": "d.csv",
            "columns": {"response": "y", "group": group}, "expected": {"status": status}})
    };
    let cases = cases(&[
        ("d.csv", json!("y,one,two\n1,a,a\n1,a,b\n1,a,a\n1,a,b\n")),
        (
            "expected.json",
            json!({"cases": [case("refused", "one"), case("undefined", "two"), case("refused", "two")]}),
        ),
    ]);
    let right: Vec<bool> = cases.iter().map(|case| case.right).collect();
    assert_eq!(right, [true, true, false]);
    assert_eq!(wrong(&cases[2]), ["status"]);
}

#[test]
fn folders_are_found_below_the_one_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let expected = json!({"cases": [descriptives("mean", json!({"mean": 2}))]}).to_string();
    for name in ["b/open", "a"] {
        write(folder.path(), &format!("{name}/d.csv"), "y\n1\n3\n");
        write(folder.path(), &format!("{name}/expected.json"), &expected);
    }
    write(folder.path(), "c/notes.txt", "nothing");
    let names: Vec<String> =
        run(folder.path()).unwrap().into_iter().map(|case| case.case).collect();
    assert_eq!(names, ["a/mean", "b/open/mean"]);
}

#[test]
fn what_cannot_be_read_is_refused_with_file_place_value_and_remedy() {
    assert_eq!(
        said(&[("notes.txt", "x")]),
        "DIR: holds no case that is known; give a folder of cases (statistics, solver, annotation, exertion, layouts, psychophysics)"
    );
    let damaged = said(&[("expected.json", "{\"cases\": [")]);
    assert!(damaged.starts_with("DIR/expected.json: line 1, column 11: no JSON (EOF"), "{damaged}");
    for (expected, message) in [
        ("{}", "DIR/expected.json: /cases: nothing where a value is needed; correct the case"),
        ("{\"cases\": 3}", "DIR/expected.json: /cases: 3 where a list is needed"),
        ("{\"cases\": [{\"id\": 3}]}", "DIR/expected.json: /cases/0/id: 3 where a text is needed"),
        ("{\"cases\": []}", "DIR: holds no case that is known"),
    ] {
        let said = said(&[("expected.json", expected)]);
        assert!(said.starts_with(message), "{said}");
    }
    let expected = json!({"cases": [descriptives("mean", json!({"mean": 2}))]}).to_string();
    let missing = said(&[("expected.json", &expected)]);
    assert!(missing.starts_with("DIR/d.csv: cannot be read ("), "{missing}");
    assert!(missing.ends_with("; check the path and its permissions"), "{missing}");

    let nowhere = run(Path::new("/nowhere/at/all")).unwrap_err().to_string();
    assert!(nowhere.starts_with("/nowhere/at/all: cannot be read ("), "{nowhere}");
}

/// Two states of one component that each emit one number.
fn model() -> Value {
    json!({"start": [0.5, 0.5], "transition": [[0.9, 0.1], [0.1, 0.9]],
        "weight": [[1.0], [1.0]], "mean": [[[0.0]], [[4.0]]], "variance": [[[1.0]], [[1.0]]]})
}

fn given(path: Value, frames: Value) -> Value {
    json!([{"name": "two", "model": model(), "sequence": [[0.1], [0.2], [3.9], [4.1]],
        "path": path, "frames": frames, "posterior": []}])
}

#[test]
fn annotation_says_which_value_is_wrong() {
    let right = cases(&[("hmm/given.json", given(json!([0, 0, 1, 1]), json!([])))]);
    assert!(right[0].right, "{:?}", wrong(&right[0]));
    let cases = cases(&[("hmm/given.json", given(json!([0, 1, 1, 1]), json!([])))]);
    assert_eq!(cases[0].case, "hmm/given/two");
    assert_eq!(wrong(&cases[0]), ["path/1"]);
    let refused = given(json!([]), json!([])).to_string().replace("0.9", "0.7");
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "hmm/given.json", &refused);
    let refused = run(folder.path()).unwrap();
    assert_eq!(wrong(&refused[0]), ["computed"], "rows of a transition add up to one");
    let beyond = given(json!([0, 0, 1, 1]), json!([7])).to_string();
    assert_eq!(
        said(&[("hmm/given.json", &beyond)]),
        "DIR/hmm/given.json: /0/frames/0: 7 where a frame of the sequence is needed; correct the \
         case as its README says"
    );
}

/// A unit square of two triangles; its shapes move it as a whole.
fn toy(weights: [f64; 1]) -> Value {
    json!({
        "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
        "triangles": [[0, 1, 2], [1, 3, 2]],
        "deltas": [[[0, 0, 1], [0, 0, 0], [0, 0, 0], [0, 0, 0]]],
        "markers": [0], "d": [0, 0, 0.5], "ell2": 1.0,
        "solutions": {"box": {"c": weights}, "unknown": {"c": [0]}},
    })
}

#[test]
fn a_part_that_a_case_must_have_is_asked_for() {
    let said = said(&[("toy.json", &toy([0.5]).to_string())]);
    assert_eq!(
        said,
        "DIR/toy.json: /A_uniform: nothing where a value is needed; correct the case as its README \
         says"
    );
}
