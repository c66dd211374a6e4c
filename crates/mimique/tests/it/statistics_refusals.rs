//! Files that are absent, empty, or of another kind: `test`, `analyze`, `simulate` and `power` name the
//! file and the remedy, exit with 2 and write nothing.

use std::path::Path;

use crate::support::refused;

fn study() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../study-config/demo.json");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn statistics_name_the_file_and_the_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    for (name, text) in [
        ("empty.csv", ""),
        ("header.csv", "a,b\n"),
        ("table.csv", "a,b\n1,2\n3,x\n"),
        ("ragged.csv", "a,b\n1,2\n1,2,3\n"),
        ("empty.json", ""),
        ("broken.json", "{"),
    ] {
        std::fs::write(path(name), text).expect("written");
    }
    let (absent_csv, absent_json) = (path("absent.csv"), path("absent.json"));
    let [empty, header, table, ragged] =
        ["empty.csv", "header.csv", "table.csv", "ragged.csv"].map(path);
    let [empty_json, broken_json] = ["empty.json", "broken.json"].map(path);
    let (study, out) = (study(), path("out"));
    let here = folder.path().to_str().expect("UTF-8").to_owned();

    let describe = |file: &str, column: &str| {
        ["test", "describe", file, "--response", column].map(str::to_owned).to_vec()
    };
    let analyze = |file: &str, study: &str| {
        ["analyze", file, "--study", study, "--out", &out].map(str::to_owned).to_vec()
    };
    let simulate = |file: &str, more: &[&str]| {
        let mut arguments = vec!["simulate", file, "-n", "3", "--out", &out];
        arguments.extend(more);
        arguments.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let power = |file: &str| ["power", file, "--out", &out].map(str::to_owned).to_vec();
    let no_file = "check the path";
    let no_column = "there is no such column";
    for (arguments, file, words) in [
        (describe(&absent_csv, "a"), &absent_csv, no_file),
        (describe(&here, "a"), &here, no_file),
        (describe(&empty, "a"), &empty, "line 1: the file is empty; give a CSV file"),
        (
            describe(&header, "a"),
            &header,
            "line 2: no rows below the header; give at least one row",
        ),
        (describe(&ragged, "a"), &ragged, "line 3: 3 cells, the header has 2; check quotes"),
        (describe(&table, "c"), &table, "the columns are \"a\" and \"b\""),
        (describe(&table, "b"), &table, "line 3: \"x\" is not a number; give a number"),
        (analyze(&absent_csv, &study), &absent_csv, no_file),
        (analyze(&empty, &study), &empty, "the file is empty"),
        (analyze(&header, &study), &header, "no rows below the header"),
        (analyze(&table, &study), &table, no_column),
        (analyze(&table, &absent_json), &absent_json, no_file),
        (analyze(&table, &empty_json), &empty_json, "write JSON"),
        (analyze(&table, &broken_json), &broken_json, "write JSON"),
        (simulate(&absent_json, &[]), &absent_json, no_file),
        (simulate(&empty_json, &[]), &empty_json, "write JSON"),
        (simulate(&broken_json, &[]), &broken_json, "write JSON"),
        (simulate(&here, &[]), &here, no_file),
        (simulate(&study, &["--parameters", &absent_json]), &absent_json, no_file),
        (simulate(&study, &["--fit", &absent_csv]), &absent_csv, no_file),
        (simulate(&study, &["--fit", &table]), &table, no_column),
        (power(&absent_json), &absent_json, no_file),
        (power(&empty_json), &empty_json, "write JSON"),
    ] {
        let error = refused(&arguments);
        assert!(error.starts_with(&format!("error: {file}: ")), "{error}");
        assert!(error.contains(words), "{error}");
        assert!(!Path::new(&out).exists(), "{arguments:?} left something behind");
    }
}
