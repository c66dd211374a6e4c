//! The workspace saved as a study: its files, as the page writes them, are checked and prepared as `mimique serve`
//! does, and show the clips that the studio shows.

use std::path::Path;

use mimique_actor::{Clip, Emotion, HeadSpec, NOISE_MM, build_head, marker_sites, synthetic_take};
use mimique_mocap::write_csv;
use mimique_stimulus::{Places, built_in_capture, prepare};
use mimique_study::{Study, check};
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

/// The built-in head and actor with two expressions.
fn workspace() -> Workspace {
    let mut workspace = Workspace::new();
    workspace.built_in_avatar(1, 2_300).unwrap();
    workspace.built_in_take(1);
    let marked = json!([
        { "label": "Joy, weak", "expression": [300, 520] },
        { "label": "anger", "expression": [800, 1000] },
    ]);
    workspace.set_expressions(&marked.to_string()).unwrap();
    workspace
}

fn face(workspace: &mut Workspace, slot: &str, name: &str, method: &Value) -> Value {
    let facts = workspace.solve(slot, &method.to_string()).unwrap();
    json!({ "name": name, "settings": facts["settings"] })
}

fn asked(faces: &[Value], design: &str) -> Value {
    json!({
        "name": "My Take 2", "title": null, "design": design, "instruments": [], "languages": ["fr", "en"],
        "faces": faces, "gaze": { "held": { "azimuth": 5.0 } },
    })
}

/// Writes a study into a folder; what is copied is found by what it is.
fn write(study: &Value, folder: &Path, copied: &[(&str, &[u8])]) {
    let put = |path: &str, bytes: &[u8]| {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    };
    for file in study["made"].as_array().unwrap() {
        put(file[0].as_str().unwrap(), file[1].as_str().unwrap().as_bytes());
    }
    for file in study["copied"].as_array().unwrap() {
        let (_, bytes) = copied.iter().find(|(what, _)| file[0] == *what).unwrap();
        put(file[1].as_str().unwrap(), bytes);
    }
}

/// The study of a folder, checked, and its clips: identifiers and hashes.
fn prepared(folder: &Path) -> (Study, Vec<String>) {
    let text = std::fs::read_to_string(folder.join("study.json")).unwrap();
    let report = check(&text, &|path| {
        assert!(folder.join(path).is_file(), "{path}");
        Ok(())
    });
    assert_eq!(report.errors(), 0, "{:?}", report.issues);
    let study = report.study.unwrap().study().clone();
    let packs = folder.join("packs");
    std::fs::create_dir(&packs).unwrap();
    let places = Places { study: folder.to_owned(), data: None, packs };
    let prepared = prepare(&study, &places, &mut |_| {}).unwrap();
    (study, prepared.clips.keys().cloned().collect())
}

#[test]
fn the_built_in_performance_is_a_study_of_every_face() {
    let mut workspace = workspace();
    workspace.built_in_training(1);
    let faces = [
        face(&mut workspace, "a", "lsts, alpha 0.3", &json!({ "method": "lsts", "alpha": 0.3 })),
        face(&mut workspace, "b", "lsts, alpha 0.7", &json!({ "method": "lsts", "alpha": 0.7 })),
        face(&mut workspace, "c", "regression", &json!({ "method": "regression" })),
    ];
    let study = workspace.study(&asked(&faces, "rate-one").to_string()).unwrap();
    assert_eq!(study["id"], "my-take-2");
    assert_eq!(study["copied"], json!([]), "nothing was opened");
    let folder = tempfile::tempdir().unwrap();
    write(&study, folder.path(), &[]);
    let (study, clips) = prepared(folder.path());
    assert_eq!(study.languages, ["fr", "en"]);
    // Two segments by three methods, which the analysis tells apart.
    assert_eq!(clips.len(), 6, "{clips:?}");
    let names: Vec<&String> = study.stimuli.methods.keys().collect();
    assert_eq!(names, ["lsts-alpha-0-3", "lsts-alpha-0-7", "regression"]);
    let words: Vec<String> = (study.stimuli.methods.iter())
        .map(|(name, own)| own.factors.get("method").map_or(own.word(), |_| name.clone()))
        .collect();
    assert_eq!(words, ["lsts-alpha-0-3", "lsts-alpha-0-7", "regression"]);
    let segments: Vec<_> = study.stimuli.segments.iter().map(|s| s.id.as_str()).collect();
    assert_eq!(segments, ["Joy-weak", "anger"]);
    let gaze = study.stimuli.captures["take"].gaze.as_ref().unwrap();
    assert_eq!(gaze.held.unwrap().azimuth, 5.0);
}

#[test]
fn files_that_were_opened_go_along_under_plain_names() {
    let mut first = workspace();
    let avatar = first.solve("a", r#"{"method": "lsts"}"#).map(|_| first.animated_glb("a", 0, 2));
    let avatar = avatar.unwrap().unwrap();
    let capture = built_in_take_as_a_file();
    let mut workspace = Workspace::new();
    workspace.avatar_file("Ma tête.glb", avatar.clone(), None).unwrap();
    workspace.take_file("prise n° 1.csv", capture.as_bytes(), None, None).unwrap();
    workspace.map_file("markers.json", &first.map_json()).unwrap();
    workspace
        .set_expressions(&json!([{ "label": "joy", "expression": [300, 520] }]).to_string())
        .unwrap();
    let faces = [face(&mut workspace, "a", "box", &json!({ "method": "box" }))];
    let study = workspace.study(&asked(&faces, "rate-one").to_string()).unwrap();
    assert_eq!(
        study["copied"],
        json!([["avatar", "stimuli/Ma-t-te.glb"], ["take", "stimuli/prise-n--1.csv"]])
    );
    let folder = tempfile::tempdir().unwrap();
    write(&study, folder.path(), &[("avatar", &avatar), ("take", capture.as_bytes())]);
    let (_, clips) = prepared(folder.path());
    assert_eq!(clips.len(), 1, "{clips:?}");
}

/// A take of the built-in actor as a file.
fn built_in_take_as_a_file() -> String {
    let spec = HeadSpec::actor(1);
    let clips = Emotion::ALL.map(|emotion| Clip { emotion, intensity: 2, seed: 1 });
    let take = synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, 1, NOISE_MM);
    write_csv(&built_in_capture(&take)).unwrap()
}

#[test]
fn recorded_weights_are_a_study_too() {
    let mut workspace = workspace();
    workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    let csv = workspace.weights_csv("a").unwrap();
    workspace.take_file("weights.csv", csv.as_bytes(), None, None).unwrap();
    workspace
        .set_expressions(&json!([{ "label": "joy", "expression": [300, 520] }]).to_string())
        .unwrap();
    let faces = [face(&mut workspace, "a", "recorded", &json!({ "method": "recorded" }))];
    let study = workspace.study(&asked(&faces, "rate-one").to_string()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    write(&study, folder.path(), &[("take", csv.as_bytes())]);
    assert_eq!(prepared(folder.path()).1.len(), 1);
}

#[test]
fn what_is_missing_is_said() {
    let mut workspace = workspace();
    let faces = [face(&mut workspace, "a", "lsts", &json!({ "method": "lsts" }))];
    let refused = |workspace: &Workspace, asked: &Value| {
        workspace.study(&asked.to_string()).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&workspace, &asked(&[], "rate-one")),
        "no face is solved yet; solve one first"
    );
    assert!(refused(&workspace, &asked(&faces, "rate-two")).contains("take one of rate-one"));
    let mut unnamed = asked(&faces, "rate-one");
    unnamed["name"] = "…".into();
    assert_eq!(refused(&workspace, &unnamed), "name: no letter in it; name the study");
    let mut beside = asked(&faces, "compare-two");
    beside["instruments"] = json!(["affect-grid"]);
    assert!(refused(&workspace, &beside).contains("it is asked of one clip"));
    workspace.set_expressions("[]").unwrap();
    let words = "expressions: none is marked; mark what is to be shown in the tab Expressions";
    assert_eq!(refused(&workspace, &asked(&faces, "rate-one")), words);
    assert_eq!(
        refused(&Workspace::new(), &asked(&faces, "rate-one")),
        "no avatar yet; open one first"
    );
    let library = Workspace::study_library().unwrap();
    let designs = ["rate-one", "compare-two", "all-pairs", "identify-emotion"];
    assert_eq!(library["designs"], json!(designs));
    assert!(library["instruments"].as_array().unwrap().iter().any(|own| own["id"] == "sus"));
}
