//! `mimique deposit`: the folder of the demonstration with simulated answers is whole by the rules of what it claims to be;
//! what is personal is asked about, and secrets are nowhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use mimique_test_support::repository;
use serde_json::Value;
use sha2::{Digest as _, Sha256};

use crate::support::{files, ok, refused, sample, text};

/// Simulated answers to a study: the file of the export.
fn answers(study: &Path, folder: &Path) -> PathBuf {
    let out = folder.join("answers");
    ok(&["simulate", &text(study), "-n", "8", "--seed", "1", "--out", &text(&out)]);
    let id = read_study(study)["id"].as_str().unwrap().to_owned();
    out.join(format!("{id}_responses.csv"))
}

fn read_study(study: &Path) -> Value {
    mimique_study::parse(&std::fs::read_to_string(study).unwrap()).unwrap()
}

/// The command's arguments, with what the demonstration's export is asked about answered.
fn args(study: &Path, export: &Path, out: &Path, more: &[&str]) -> Vec<String> {
    let packs = std::env::temp_dir().join("mimique-deposit-test-packs");
    let own = [
        "deposit",
        &text(study),
        &text(export),
        "--out",
        &text(out),
        "--packs",
        &text(&packs),
        "--date",
        "2026-11-27",
        "--author",
        "Carberry, Josiah; 0000-0002-1825-0097; Brown University",
    ]
    .map(str::to_owned);
    own.into_iter().chain(more.iter().map(|word| (*word).to_owned())).collect()
}

fn demo() -> PathBuf {
    repository().join("study-config/demo.json")
}

fn json(files: &BTreeMap<String, Vec<u8>>, path: &str) -> Value {
    serde_json::from_slice(files.get(path).unwrap_or_else(|| panic!("{path} is not there")))
        .unwrap()
}

fn csv_header(bytes: &[u8]) -> Vec<String> {
    let mut reader = csv::Reader::from_reader(bytes);
    reader.headers().unwrap().iter().map(str::to_owned).collect()
}

/// The deposit of the demonstration, made once for the tests that look at it.
fn made() -> &'static BTreeMap<String, Vec<u8>> {
    static MADE: std::sync::OnceLock<BTreeMap<String, Vec<u8>>> = std::sync::OnceLock::new();
    MADE.get_or_init(|| {
        let place = tempfile::tempdir().unwrap();
        let export = answers(&demo(), place.path());
        let out = place.path().join("deposit");
        ok(&args(&demo(), &export, &out, &["--drop", "start_time,end_time"]));
        files(&out)
    })
}

#[test]
fn every_file_is_in_the_manifest_with_its_hash() {
    let files = made();
    let manifest = String::from_utf8(files["manifest-sha256.txt"].clone()).unwrap();
    let listed: BTreeMap<&str, &str> = manifest
        .lines()
        .map(|line| line.split_once("  ").unwrap())
        .map(|(hash, path)| (path, hash))
        .collect();
    for (path, bytes) in files.iter().filter(|(path, _)| *path != "manifest-sha256.txt") {
        assert_eq!(
            listed.get(&**path).copied(),
            Some(&*hex::encode(Sha256::digest(bytes))),
            "{path}"
        );
    }
    assert_eq!(listed.len() + 1, files.len());
    // A pack is named by its own hash.
    let packs = files.iter().filter(|(path, _)| path.starts_with("stimuli/packs/"));
    for (path, bytes) in packs.clone() {
        assert!(path.ends_with(&hex::encode(Sha256::digest(bytes))), "{path}");
    }
    assert!(packs.count() >= 6);
}

/// The rules of RO-Crate 1.1: a descriptor about the root, a root with what it must have, flattened entities that are all
/// reached, every reference to an entity of the crate leads somewhere, every file is listed.
#[test]
fn the_crate_lists_every_file_and_no_other() {
    let files = made();
    let metadata = json(files, "ro-crate-metadata.json");
    assert_eq!(metadata["@context"][0], "https://w3id.org/ro/crate/1.1/context");
    let graph = metadata["@graph"].as_array().unwrap();
    let by_id: BTreeMap<&str, &Value> =
        graph.iter().map(|entity| (entity["@id"].as_str().unwrap(), entity)).collect();
    assert_eq!(by_id.len(), graph.len(), "an entity stands once");
    let descriptor = by_id["ro-crate-metadata.json"];
    assert_eq!(descriptor["about"]["@id"], "./");
    assert_eq!(descriptor["conformsTo"]["@id"], "https://w3id.org/ro/crate/1.1");
    let root = by_id["./"];
    assert_eq!(root["@type"], "Dataset");
    assert_eq!(root["datePublished"], "2026-11-27");
    for key in ["name", "description", "license"] {
        assert!(
            root[key].is_object() || root[key].as_str().is_some_and(|text| !text.is_empty()),
            "{key}"
        );
    }
    for entity in graph {
        assert!(entity["@type"].is_string(), "{entity}");
        for (key, value) in entity.as_object().unwrap() {
            let all = value.as_array().cloned().unwrap_or_else(|| vec![value.clone()]);
            for reference in all.iter().filter_map(|value| value["@id"].as_str()) {
                let is_elsewhere = reference.starts_with("https://w3id.org/");
                assert!(is_elsewhere || by_id.contains_key(reference), "{key}: {reference}");
                assert_eq!(all.iter().filter(|value| value["@id"] == reference).count(), 1);
            }
        }
    }
    // From the root along hasPart everything is reached that lies there.
    let (mut reached, mut next) = (BTreeSet::new(), vec!["./"]);
    while let Some(id) = next.pop() {
        for part in by_id[id]["hasPart"].as_array().into_iter().flatten() {
            let id = part["@id"].as_str().unwrap();
            assert!(reached.insert(id), "{id} is part of two");
            next.push(id);
        }
    }
    let listed: BTreeSet<&str> = reached.iter().copied().filter(|id| !id.ends_with('/')).collect();
    let there: BTreeSet<&str> =
        files.keys().map(String::as_str).filter(|path| *path != "ro-crate-metadata.json").collect();
    assert_eq!(listed, there);
    for (path, bytes) in files.iter().filter(|(path, _)| *path != "manifest-sha256.txt") {
        let Some(entity) = by_id.get(&**path).filter(|_| *path != "ro-crate-metadata.json") else {
            continue;
        };
        assert_eq!(entity["contentSize"], bytes.len().to_string(), "{path}");
        assert_eq!(entity["sha256"], hex::encode(Sha256::digest(bytes)), "{path}");
    }
    assert_eq!(by_id["https://orcid.org/0000-0002-1825-0097"]["familyName"], "Carberry");
}

#[test]
fn the_data_dictionary_has_every_column() {
    let files = made();
    let description = json(files, "psych-ds/dataset_description.json");
    let measured: Vec<&str> = description["variableMeasured"]
        .as_array()
        .unwrap()
        .iter()
        .map(|variable| variable["name"].as_str().unwrap())
        .collect();
    let columns = csv_header(&files["psych-ds/data/study-demo_data.csv"]);
    assert_eq!(measured, columns);
    assert!(!columns.contains(&"start_time".to_owned()) && columns.contains(&"rt".to_owned()));
    assert!(
        description["variableMeasured"]
            .as_array()
            .unwrap()
            .iter()
            .all(|own| own["description"] != "")
    );
}

/// The rules of BIDS for behaviour without recordings: names, required columns first, `n/a` and no empty cell, onsets that
/// do not go back, a sidecar for every column, participants as the folders are called.
#[test]
fn the_events_are_as_bids_wants_them() {
    let files = made();
    let description = json(files, "bids/dataset_description.json");
    assert!(description["Name"].is_string() && description["BIDSVersion"].is_string());
    let sidecar = json(files, "bids/task-demo_events.json");
    let people = table(&files["bids/participants.tsv"]);
    assert_eq!(people[0][0], "participant_id");
    let named: BTreeSet<&str> = people[1..].iter().map(|row| &*row[0]).collect();
    let of_people = json(files, "bids/participants.json");
    assert!(
        people[0].iter().all(|column| of_people[column]["Description"].is_string()),
        "{of_people}"
    );
    let mut subjects = BTreeSet::new();
    let data = String::from_utf8(files["psych-ds/data/study-demo_data.csv"].clone()).unwrap();
    let mut answers = 0;
    for (path, bytes) in files.iter().filter(|(path, _)| path.starts_with("bids/sub-")) {
        let subject = path.split('/').nth(1).unwrap();
        assert_eq!(*path, format!("bids/{subject}/beh/{subject}_task-demo_events.tsv"));
        assert!(subject[4..].bytes().all(|byte| byte.is_ascii_alphanumeric()), "{subject}");
        subjects.insert(subject);
        let rows = table(bytes);
        assert_eq!(rows[0][..3], ["onset", "duration", "trial_type"]);
        assert!(
            rows[0].iter().all(|column| sidecar[column]["Description"].is_string()),
            "{:?}",
            rows[0]
        );
        assert!(
            rows.iter()
                .all(|row| row.len() == rows[0].len() && row.iter().all(|cell| !cell.is_empty()))
        );
        let onsets: Vec<f64> = rows[1..].iter().map(|row| row[0].parse().unwrap()).collect();
        assert!(onsets.is_sorted() && onsets[0] >= 0.0, "{subject}: {onsets:?}");
        let of = |kind: &str| rows[1..].iter().filter(|row| row[2] == kind).count();
        assert!(of("stimulus") > 0 && of("page") > 0, "{subject}");
        for row in rows[1..].iter().filter(|row| row[2] == "stimulus") {
            assert!(row[1].parse::<f64>().unwrap() > 0.5, "a clip has its duration: {row:?}");
        }
        for row in rows[1..].iter().filter(|row| row[2] == "response") {
            assert!(row[3].parse::<f64>().unwrap() > 0.0, "an answer has its time: {row:?}");
        }
        answers += of("response");
    }
    assert_eq!(subjects, named);
    assert_eq!(answers + 1, data.lines().count(), "every row of the export is an answer");
}

fn table(bytes: &[u8]) -> Vec<Vec<String>> {
    let text = std::str::from_utf8(bytes).unwrap();
    text.lines().map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

/// The rules of the Citation File Format 1.2.0: keys that it knows, those that must be there, values of their forms.
#[test]
fn the_citation_is_as_its_schema_wants_it() {
    let text = String::from_utf8(made()["CITATION.cff"].clone()).unwrap();
    let known = [
        "cff-version",
        "message",
        "type",
        "title",
        "abstract",
        "version",
        "date-released",
        "license",
        "authors",
        "keywords",
        "references",
    ];
    let top: Vec<(&str, &str)> = (text.lines())
        .filter(|line| !line.starts_with(' '))
        .map(|line| line.split_once(':').unwrap())
        .collect();
    assert!(top.iter().all(|(key, _)| known.contains(key)), "{top:?}");
    let value = |key: &str| top.iter().find(|(own, _)| *own == key).unwrap().1.trim();
    assert_eq!(value("cff-version"), "1.2.0");
    assert_eq!(value("type"), "dataset");
    assert_eq!(value("date-released"), "\"2026-11-27\"");
    assert_eq!(value("license"), "CC-BY-4.0");
    assert!(value("message").len() > 2 && value("title").len() > 2);
    assert!(text.contains("  - family-names: \"Carberry\"\n    given-names: \"Josiah\"\n    orcid: \"https://orcid.org/0000-0002-1825-0097\"\n"));
}

#[test]
fn the_deposit_gives_its_report_again_and_no_secret() {
    let files = made();
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    std::fs::write(at("data.csv"), &files["psych-ds/data/study-demo_data.csv"]).unwrap();
    std::fs::write(at("study.json"), &files["study/study.json"]).unwrap();
    ok(&["check", "--without-clips", &text(&at("study.json"))]);
    let report = at("report");
    ok(&[
        "analyze",
        &text(&at("data.csv")),
        "--study",
        &text(&at("study.json")),
        "--out",
        &text(&report),
    ]);
    for name in ["results.json", "report.html"] {
        let again = std::fs::read(report.join(name)).unwrap();
        assert_eq!(again, files[&format!("report/{name}")], "{name}");
    }
    for (path, bytes) in files {
        let text = String::from_utf8_lossy(bytes);
        assert!(!text.contains("MIMIQUE-DEMO"), "{path} has the completion code");
    }
    let about = json(files, "study/provenance.json");
    assert_eq!(about["versions"][0]["removed"][0], "/recruitment/completionCode");
    let served = about["versions"][0]["config_hash_served"].as_str().unwrap();
    let data = std::str::from_utf8(&files["psych-ds/data/study-demo_data.csv"]).unwrap();
    assert!(data.contains(served), "it is that of the answers");
    let readme = std::str::from_utf8(&files["README.md"]).unwrap();
    assert!(readme.contains("`start_time`") && readme.contains(served), "{readme}");
    let bill = json(files, "software/sbom.cdx.json");
    assert!(bill["components"].as_array().unwrap().len() > 100);
}

#[test]
fn the_same_input_gives_the_same_bytes_and_without_stimuli_hashes_alone() {
    let place = tempfile::tempdir().unwrap();
    let export = answers(&demo(), place.path());
    let out = place.path().join("again");
    ok(&args(&demo(), &export, &out, &["--drop", "end_time,start_time"]));
    let again = files(&out);
    for (path, bytes) in made() {
        assert_eq!(again.get(path), Some(bytes), "{path}");
    }
    assert_eq!(again.len(), made().len());
    // In the same place: an earlier deposit is replaced.
    ok(&args(&demo(), &export, &out, &["--drop", "start_time,end_time", "--no-stimuli"]));
    let without = files(&out);
    assert!(without.keys().all(|path| !path.starts_with("stimuli/packs/")));
    assert_eq!(without["stimuli/stimuli.csv"], made()["stimuli/stimuli.csv"]);
    assert!(
        std::str::from_utf8(&without["README.md"]).unwrap().contains("not part of the deposit")
    );
}

#[test]
fn what_is_personal_is_named_and_nothing_is_written_before_it_is_answered() {
    let place = tempfile::tempdir().unwrap();
    let export = answers(&demo(), place.path());
    let out = place.path().join("deposit");
    let err = refused(&args(&demo(), &export, &out, &[]));
    for words in [
        "start_time: ",
        "end_time: ",
        " of 8 participants, first in line 2: time of the clock",
        "--drop",
    ] {
        assert!(err.contains(words), "{words}: {err}");
    }
    // Planted: an identifier in a column of its own, an address in an answer.
    let csv = std::fs::read_to_string(&export).unwrap();
    let planted: String = csv
        .lines()
        .enumerate()
        .map(|(place, line)| match place {
            0 => format!("{line},PROLIFIC_PID,seat\n"),
            _ => format!("{line},5f2b1c9e8a7d6c5b4a392817,call 06 12 34 56 78\n"),
        })
        .collect();
    let with = place.path().join("planted.csv");
    std::fs::write(&with, planted).unwrap();
    let err = refused(&args(&demo(), &with, &out, &["--drop", "start_time,end_time"]));
    assert!(err.contains("seat: ") && err.contains("telephone number"), "{err}");
    assert!(!err.contains("PROLIFIC_PID:"), "it is left out without being asked about: {err}");
    let err = refused(&args(
        &demo(),
        &with,
        &out,
        &["--keep", "PROLIFIC_PID,seat", "--drop", "start_time,end_time"],
    ));
    assert!(err.contains("never deposited"), "{err}");
    assert!(!out.exists(), "nothing was written");
    let told = ok(&args(&demo(), &with, &out, &["--drop", "start_time,end_time,seat"]));
    assert!(told.contains("left out: PROLIFIC_PID: "), "{told}");
    for (path, bytes) in files(&out) {
        let text = String::from_utf8_lossy(&bytes);
        assert!(!text.contains("5f2b1c9e8a7d6c5b4a392817") && !text.contains("06 12 34"), "{path}");
    }
    let other = place.path().join("taken");
    std::fs::create_dir(&other).unwrap();
    std::fs::write(other.join("mine.txt"), "mine").unwrap();
    let err = refused(&args(&demo(), &export, &other, &["--drop", "start_time,end_time"]));
    assert!(err.contains("something else than a deposit"), "{err}");
    // Answers of another study.
    let err = refused(&args(&repository().join("study-config/pairs.json"), &export, &out, &[]));
    assert!(err.contains("config_hash") && err.contains("another version of the study"), "{err}");
}

#[test]
fn a_study_with_files_of_its_own_runs_again_from_the_deposit() {
    let own = sample();
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&own.path().join(name));
    let folder = place.path().join("mine");
    let (there, avatar, capture, map) =
        (text(&folder), at("head.glb"), at("take.c3d"), at("markers.json"));
    let options = [
        "new",
        &there,
        "--design",
        "identify-emotion",
        "--avatar",
        &avatar,
        "--capture",
        &capture,
        "--map",
        &map,
        "--cut",
        "100:160:anger",
        "--cut",
        "300:360:disgust",
        "--reference",
    ];
    ok(&options);
    let study = folder.join("study.json");
    let export = answers(&study, place.path());
    let out = place.path().join("deposit");
    ok(&args(&study, &export, &out, &["--drop", "start_time,end_time", "--no-stimuli"]));
    let listed = json(&files(&out), "study/provenance.json");
    let hash = hex::encode(Sha256::digest(std::fs::read(&capture).unwrap()));
    let sources = listed["sources"].as_array().unwrap();
    assert!(sources.iter().any(|source| source["sha256"] == hash), "{listed}");
    assert!(files(&out).keys().all(|path| !path.ends_with(".c3d")));
    ok(&args(&study, &export, &out, &["--drop", "start_time,end_time"]));
    assert!(
        files(&out)
            .keys()
            .any(|path| path.starts_with("study/files/") && path.ends_with("/take.c3d"))
    );
    let moved = place.path().join("elsewhere");
    std::fs::rename(&out, &moved).unwrap();
    // The originals are gone: what is in the deposit is enough.
    drop(own);
    let said = ok(&["check", &text(&moved.join("study/study.json"))]);
    assert!(said.contains("no errors, "), "{said}");
}

#[test]
fn a_psych_ds_folder_is_taken_too() {
    let place = tempfile::tempdir().unwrap();
    let set = place.path().join("set");
    ok(&["simulate", &text(&demo()), "-n", "3", "--format", "psych-ds", "--out", &text(&set)]);
    let out = place.path().join("deposit");
    ok(&args(&demo(), &set, &out, &["--drop", "start_time,end_time", "--no-stimuli"]));
    let made = files(&out);
    let rows =
        made["psych-ds/data/study-demo_data.csv"].iter().filter(|byte| **byte == b'\n').count();
    let given = std::fs::read(set.join("data/study-demo_data.csv")).unwrap();
    assert_eq!(rows, given.iter().filter(|byte| **byte == b'\n').count());
    assert!(!made.contains_key("study/earlier"));
}
