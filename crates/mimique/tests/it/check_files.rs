//! `mimique check` opens the files: what is wrong with avatar, capture, map and segments is said at the first call,
//! all at once, each at its place. The files are the sample's, made from the built-in head and actor.

use std::path::Path;

use mimique_test_support::real_file;
use serde_json::{Value, json};

use crate::support::{mimique, ok, refused, sample, text};

/// A study of a file's capture on a file's avatar, as it should be.
fn study() -> Value {
    let text = |text: &str| json!({ "en": text });
    json!({
        "id": "files",
        "studyMetadata": { "title": text("Files"), "version": "1" },
        "languages": ["en"],
        "contact": {
            "investigator": { "name": "A", "email": "a@example.org" },
            "ethicsBoard": { "name": "B", "email": "b@example.org" },
        },
        "consent": {
            "version": "1", "minimumAge": 18, "retention": "A year.",
            "sections": [{ "heading": "What you will do", "text": "You will look at faces." }],
        },
        "questions": [{
            "id": "believable", "type": "likert", "prompt": "How believable?", "numItems": 7,
            "start": 1, "leftLabel": "not at all", "rightLabel": "entirely",
        }],
        "components": { "faces": { "type": "trials", "questions": ["believable"] } },
        "sequence": { "order": "random", "components": ["faces"] },
        "stimuli": {
            "avatars": { "head": { "file": "head.glb" } },
            "captures": { "take": { "file": "take.c3d", "markers": "markers.json",
                "head": ["HEAD1", "HEAD2", "HEAD3"], "neutral": [0, 60] } },
            "segments": [
                { "id": "one", "capture": "take", "first": 100, "end": 160 },
                { "id": "two", "capture": "take", "first": 300, "end": 360 },
            ],
            "methods": { "lsts30": { "method": "lsts", "alpha": 0.3 }, "box": { "method": "box" } },
        },
    })
}

/// Writes a study beside the sample's files: its path.
fn written(folder: &Path, study: &Value) -> String {
    let file = folder.join("study.json");
    std::fs::write(&file, study.to_string()).unwrap();
    text(&file)
}

/// The labels of the head's markers in the sample's map.
fn head(folder: &Path) -> Vec<String> {
    let map = std::fs::read_to_string(folder.join("markers.json")).unwrap();
    let map: Value = serde_json::from_str(&map).unwrap();
    serde_json::from_value(map["head"].clone()).unwrap()
}

/// The errors of a check: pointers and messages.
fn faults(file: &str) -> Vec<(String, String)> {
    let out = mimique(&["check", "--json", file]);
    assert_eq!(out.status.code(), Some(2));
    let report: Value = serde_json::from_slice(&out.stdout).unwrap();
    let issues = report["issues"].as_array().unwrap().iter();
    let errors = issues.filter(|issue| issue["severity"] == "error");
    let word = |issue: &Value, key: &str| issue[key].as_str().unwrap().to_owned();
    errors.map(|issue| (word(issue, "pointer"), word(issue, "message"))).collect()
}

#[test]
fn every_fault_of_the_files_is_found_at_the_first_call() {
    let folder = sample();
    let mut study = study();
    study["stimuli"]["captures"]["take"]["head"] = json!(head(folder.path()));
    let file = written(folder.path(), &study);
    ok(&["check", "--without-clips", &file]);

    // Four faults of four kinds, beside one that needs no file.
    study["stimuli"]["captures"]["take"]["head"] =
        json!(["NOSE1", head(folder.path())[0], "NOSE2"]);
    study["stimuli"]["segments"][1]["end"] = json!(1_000_000);
    study["stimuli"]["methods"]["box"]["locked"] = json!(["jawOpen", "noSuchShape"]);
    study["stimuli"]["methods"]["lsts30"]["importance"] = json!({ "NOSUCHMARKER": 2.0 });
    study["questions"][0]["numItems"] = json!(1);
    let file = written(folder.path(), &study);
    let found = faults(&file);
    let says = |pointer: &str, word: &str| {
        let at: Vec<_> = found.iter().filter(|(place, _)| place == pointer).collect();
        assert!(at.len() == 1 && at[0].1.contains(word), "{pointer}: {found:?}");
    };
    says("/questions/0/numItems", "1");
    says("/stimuli/captures/take/head", "head markers NOSE1, NOSE2: not in the capture");
    says("/stimuli/segments/1", "frames 300:1000000 of ");
    says("/stimuli/methods/box/locked/1", "no shape 'noSuchShape'");
    // Without the head the markers cannot be joined, so that nothing is said of the names of markers.
    assert_eq!(found.len(), 4, "{found:?}");

    study["stimuli"]["captures"]["take"]["head"] = json!(head(folder.path()));
    let found = faults(&written(folder.path(), &study));
    let says = |pointer: &str, word: &str| {
        let at: Vec<_> = found.iter().filter(|(place, _)| place == pointer).collect();
        assert!(at.len() == 1 && at[0].1.contains(word), "{pointer}: {found:?}");
    };
    says("/stimuli/methods/box/locked/1", "no shape 'noSuchShape'");
    says("/stimuli/methods/lsts30/importance/NOSUCHMARKER", "no marker 'NOSUCHMARKER'");
    assert_eq!(found.len(), 4, "{found:?}");

    // As people read it: a line each, with the count in right grammar, and no clip solved.
    let err = String::from_utf8(mimique(&["check", &file]).stdout).unwrap();
    assert!(err.contains("study.json: 4 errors, 0 warnings"), "{err}");
    assert!(!err.contains("methods in millimetres"), "{err}");
}

#[test]
fn a_file_that_is_another_is_named_in_one_line() {
    let folder = sample();
    let mut own = study();
    own["stimuli"]["captures"]["take"]["head"] = json!(head(folder.path()));
    let cases = [
        ("markers", "take.c3d", "the file is a capture (C3D), no marker map; name the file that"),
        ("markers", "weights.csv", "the file is a capture ("),
        ("markers", "head.glb", "the file is an avatar (GLB), no marker map; name the file that"),
        ("file", "markers.json", "markers.json: "),
    ];
    for (key, other, says) in cases {
        let mut study = own.clone();
        study["stimuli"]["captures"]["take"][key] = json!(other);
        let file = written(folder.path(), &study);
        let found = faults(&file);
        assert_eq!(found.len(), 1, "{key} {other}: {found:?}");
        let (pointer, message) = &found[0];
        assert_eq!(*pointer, format!("/stimuli/captures/take/{key}"));
        assert!(message.contains(says) && message.contains(other), "{message}");
        assert!(!message.contains('\n') && message.len() < 700, "{message}");
        // The server says the same.
        let err = refused(&["serve", &file, "--listen", "127.0.0.1:0"]);
        assert!(err.contains(message), "{err}");
    }
    // An avatar that is none, and a map of another avatar.
    let mut other = own.clone();
    other["stimuli"]["avatars"]["head"]["file"] = json!("take.c3d");
    let found = faults(&written(folder.path(), &other));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "/stimuli/avatars/head/file");
    let mut map: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("markers.json")).unwrap())
            .unwrap();
    let labels: Vec<String> = map["markers"].as_object().unwrap().keys().cloned().collect();
    map["markers"][&labels[0]] = json!({ "position": [0.5, 0.5, 0.5] });
    std::fs::write(folder.path().join("markers.json"), map.to_string()).unwrap();
    own["stimuli"]["segments"][0]["end"] = json!(999_999);
    let found = faults(&written(folder.path(), &own));
    assert_eq!(found.len(), 2, "{found:?}");
    let map = found.iter().find(|(pointer, _)| pointer == "/stimuli/captures/take/markers");
    let (_, message) = map.expect("the map is at fault");
    assert!(message.contains(&labels[0]) && message.contains("off the skin"), "{message}");
}

#[test]
fn a_real_take_past_its_end_is_said_with_its_frames() {
    let topic = "a_real_take_past_its_end_is_said_with_its_frames";
    let Some(data) = real_file(topic, "animface") else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut study = study();
    study["stimuli"]["avatars"]["head"]["file"] =
        json!(data.join("../ict-facekit/ict-facekit.glb"));
    study["stimuli"]["captures"]["take"] = json!({
        "file": data.join("JawMoCap.c3d"), "markers": data.join("markers-ict-facekit.json"),
        "head": ["ForeHead_M", "ForeHead_L", "Forehead_R"], "neutral": [0, 60],
    });
    study["stimuli"]["segments"][1]["end"] = json!(5000);
    let found = faults(&written(folder.path(), &study));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().any(|(_, message)| message.starts_with("head marker Forehead_R: not in")));
    assert!(found.iter().any(|(_, message)| message.starts_with("frames 300:5000 of ")));
}
