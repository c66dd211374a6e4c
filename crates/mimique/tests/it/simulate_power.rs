//! `mimique simulate` and `mimique power` as a researcher types them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn config(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../study-config").join(name);
    path.to_str().expect("UTF-8").to_owned()
}

fn mimique(args: &[&str], threads: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mimique"));
    command.args(args).env("RAYON_NUM_THREADS", threads).env_remove("MIMIQUE_DATA");
    command.output().expect("the binary starts")
}

fn ok(args: &[&str]) -> String {
    let out = mimique(args, "2");
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    assert!(out.stderr.is_empty(), "no progress bar but on a terminal");
    String::from_utf8(out.stdout).expect("UTF-8")
}

fn path_in(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("UTF-8").to_owned()
}

fn refused(args: &[&str]) -> String {
    let out = mimique(args, "2");
    assert_eq!(out.status.code(), Some(2));
    String::from_utf8(out.stderr).expect("UTF-8")
}

fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push((path.clone(), std::fs::read(&path).expect("a file")));
        }
    }
    found.sort();
    found
}

#[test]
fn a_simulated_export_is_the_same_on_any_number_of_threads_and_can_be_analysed() {
    let folder = tempfile::tempdir().expect("a folder");
    let study = config("demo.json");
    let out = folder.path().join("one");
    let out = out.to_str().expect("UTF-8");
    let args = ["simulate", &study, "--participants", "20", "--seed", "4", "--out", out];
    let first = mimique(&args, "1");
    assert_eq!(first.status.code(), Some(0), "{}", String::from_utf8_lossy(&first.stderr));
    let bytes = files(Path::new(out));
    assert_eq!(bytes.len(), 2);
    assert_eq!(mimique(&args, "3").status.code(), Some(0));
    assert_eq!(files(Path::new(out)), bytes);

    // The parameters that it writes give the same again.
    let parameters = Path::new(out).join("parameters.json");
    let again = folder.path().join("again");
    let again = again.to_str().expect("UTF-8");
    ok(&[
        "simulate",
        &study,
        "-n",
        "20",
        "--seed",
        "4",
        "--out",
        again,
        "--parameters",
        parameters.to_str().expect("UTF-8"),
    ]);
    let of = |folder: &str| files(Path::new(folder)).into_iter().map(|(_, bytes)| bytes);
    assert!(of(out).eq(of(again)));

    let export = Path::new(out).join("demo_responses.csv");
    let report = folder.path().join("report");
    let summary = ok(&[
        "analyze",
        export.to_str().expect("UTF-8"),
        "--study",
        &study,
        "--out",
        report.to_str().expect("UTF-8"),
        "--json",
    ]);
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert!(summary["people_used"].as_u64() > Some(10), "{summary}");

    // What is fitted to it can be simulated again.
    let fitted = path_in(folder.path(), "fitted");
    let export = export.to_str().expect("UTF-8");
    ok(&["simulate", &study, "-n", "3", "--fit", export, "--out", &fitted]);
    let read = |path: &Path| -> Value {
        serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
    };
    let times = &read(&Path::new(&fitted).join("parameters.json"))["times"]["medianMs"];
    let planted = &read(&parameters)["times"]["medianMs"];
    assert_ne!(times, planted);
    let ratio = times.as_f64().expect("a time") / planted.as_f64().expect("a time");
    assert!((0.7..1.4).contains(&ratio), "{times} for {planted}");

    for (format, count) in [("wide", 2), ("json", 2), ("events", 2), ("psych-ds", 6)] {
        let out = folder.path().join(format);
        let out = out.to_str().expect("UTF-8");
        ok(&["simulate", &study, "-n", "3", "--format", format, "--out", out]);
        assert_eq!(files(Path::new(out)).len(), count, "{format}");
    }
}

#[test]
fn power_is_written_in_every_form_with_its_preregistration() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| path_in(folder.path(), name);
    let study = config("demo.json");
    let (out, text) = (path("power"), path("text/preregistration.md"));
    let args = [
        "power",
        &study,
        "-n",
        "8,12",
        "--clips",
        "6,12",
        "--runs",
        "10",
        "--json",
        "--out",
        &out,
        "--preregistration",
        &text,
        "--language",
        "fr",
    ];
    let found: Value = serde_json::from_str(&ok(&args)).expect("JSON");
    let points = found["power"]["points"].as_array().expect("points");
    let sizes: Vec<_> = points
        .iter()
        .map(|point| (point["clips"].as_u64(), point["participants"].as_u64()))
        .collect();
    let expected = [(6, 8), (6, 12), (12, 8), (12, 12)].map(|(c, n)| (Some(c), Some(n)));
    assert_eq!(sizes, expected);
    assert_eq!(points[0]["hypotheses"].as_array().map(Vec::len), Some(4));
    let bytes = files(folder.path());
    assert_eq!(bytes.len(), 6, "power.csv, .json, .md, .svg, the text and its curve");
    let csv = std::fs::read_to_string(Path::new(&out).join("power.csv")).expect("the table");
    assert_eq!(csv.lines().count(), 1 + 4 * 4);
    let columns = csv.lines().next().map_or(0, |line| line.split(',').count());
    assert!(csv.lines().all(|line| line.split(',').count() == columns));
    let written = std::fs::read_to_string(&text).expect("the text");
    assert!(written.contains("](preregistration.svg)") && written.contains("## Plan d’analyse"));
    // Another number of threads gives the same bytes.
    assert_eq!(mimique(&args, "1").status.code(), Some(0));
    assert_eq!(files(folder.path()), bytes);
}

#[test]
fn mistakes_name_file_key_and_remedy_and_write_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| path_in(folder.path(), name);
    let (study, file, out) = (config("demo.json"), path("p.json"), path("out"));
    std::fs::write(&file, r#"{"ratings": {"believability": {"noiseSd": -2}}}"#).expect("a file");
    for command in ["simulate", "power"] {
        let error = refused(&[command, &study, "-n", "5", "--parameters", &file, "--out", &out]);
        let expected = "p.json: /ratings/believability/noiseSd: -2 is no standard deviation; give";
        assert!(error.contains(expected), "{error}");
    }
    let invalid = config("invalid/unknown-word.json");
    let error = refused(&["simulate", &invalid, "-n", "5", "--out", &out]);
    assert!(error.contains("unknown-word.json: /"), "{error}");
    let error = refused(&["power", &study, "-n", "1", "--out", &out]);
    assert!(error.contains("participants: 1 is not possible; give 2 to"), "{error}");
    assert!(!Path::new(&out).exists());
}
