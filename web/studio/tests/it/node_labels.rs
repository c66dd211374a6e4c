//! The studio's module gives the labels, the models and the borders that the native program gives, to the
//! last bit, whatever method has learnt.
//!
//! Needs node and the module built by `cargo xtask web` (in `target/web-dist`, or where
//! `MIMIQUE_WEB_DIST` says).

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use mimique_annotate::{
    AnnotatedTake, BaumWelch, Decoding, ForestOptions, HmmOptions, Kernel, Lesson, LogisticOptions,
    Mark, Marked, Method, SvmOptions, Take, Topology,
};
use mimique_test_support::{Random, repository, web_module};
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

const RATE_HZ: f64 = 50.0;
const SHAPES: [&str; 6] =
    ["jawOpen", "mouthSmileLeft", "browDownLeft", "browInnerUp", "eyeBlinkLeft", "noseSneerLeft"];

/// Eight stretches of two seconds of four faces, with ways between them and noise.
fn weights(seed: u64) -> Vec<f64> {
    let faces = [
        [0.0, 0.0, 0.0, 0.0, 0.1, 0.0],
        [0.2, 0.8, 0.0, 0.1, 0.2, 0.0],
        [0.0, 0.0, 0.7, 0.0, 0.1, 0.5],
        [0.6, 0.0, 0.0, 0.8, 0.0, 0.0],
    ];
    let mut random = Random::new(seed);
    let of = |f: usize, s: usize| {
        let (part, way) = (f / 100, ((f % 100) as f64 / 20.0 - 4.0).max(0.0));
        let face = |part: usize| faces[label(part.min(7))][s];
        face(part) * (1.0 - way) + face(part + 1) * way
    };
    let values = (0..800).flat_map(|f| (0..6).map(move |s| (f, s)));
    values.map(|(f, s)| of(f, s) + 0.05 * random.normal()).collect()
}

fn label(part: usize) -> usize {
    [0, 1, 0, 2, 0, 3, 1, 0][part]
}

fn csv(values: &[f64]) -> String {
    let mut csv = format!("frame,time,{}\n", SHAPES.join(","));
    for (f, row) in values.chunks_exact(6).enumerate() {
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        let _ = writeln!(csv, "{f},{},{}", f as f64 / RATE_HZ, cells.join(","));
    }
    csv
}

fn methods() -> Vec<(&'static str, Method)> {
    let svm = |kernel| Method::Svm(SvmOptions { kernel, ..SvmOptions::default() });
    let learning = BaumWelch { steps: 8, ..BaumWelch::default() };
    let hmm = HmmOptions { states: 2, components: 3, learning, ..HmmOptions::default() };
    vec![
        ("forest", Method::Forest(ForestOptions { trees: 40, ..ForestOptions::default() })),
        ("knn", Method::Knn { k: 5 }),
        ("svm-linear", svm(Kernel::Linear)),
        ("svm-rbf", svm(Kernel::Rbf { gamma: 0.7 })),
        ("logistic", Method::Logistic(LogisticOptions::default())),
        ("hmm", Method::Hmm(hmm)),
        (
            "hmm-left-right",
            Method::Hmm(HmmOptions { topology: Topology::LeftRight, temper: 0.5, ..hmm }),
        ),
    ]
}

/// A model of two takes, its temperature from one held out by the other.
fn model(method: Method) -> String {
    let annotated = |seed: u64| AnnotatedTake {
        name: format!("take {seed}"),
        person: "p".to_owned(),
        kind: "posed".to_owned(),
        take: Take::new(weights(seed), 6, RATE_HZ).unwrap(),
        marked: (0..8)
            .map(|part| Marked {
                frames: 100 * part..100 * part + 80,
                mark: Mark::Stable(label(part)),
            })
            .collect(),
    };
    let lesson = Lesson {
        channel: "affect".to_owned(),
        labels: ["neutral", "joy", "anger", "surprise"].map(str::to_owned).to_vec(),
        shapes: SHAPES.map(str::to_owned).to_vec(),
        method,
        thinned_to_hz: Some(10.0),
        decoding: Decoding::default(),
    };
    lesson.learn_calibrated(&[annotated(1), annotated(2)]).unwrap().to_json().unwrap()
}

/// What the native workspace says, beside what it was asked.
fn write_cases(folder: &Path) {
    let take = csv(&weights(3));
    std::fs::write(folder.join("take.csv"), &take).unwrap();
    let mut cases: Vec<Value> = Vec::new();
    for (name, method) in methods() {
        let model = model(method);
        let file = format!("{name}.json");
        std::fs::write(folder.join(&file), &model).unwrap();
        let mut workspace = Workspace::new();
        workspace.label_model(&file, &model).unwrap();
        workspace.take_file("take.csv", take.as_bytes(), None, None).unwrap();
        let suggested = workspace.suggest_labels("").unwrap();
        let boxes = suggested["boxes"].as_array().unwrap().len();
        assert!(boxes >= 6, "{name}: {suggested}");
        for index in (0..boxes).step_by(2) {
            workspace.confirm_label(index).unwrap();
        }
        let state = workspace.learn_labels("").unwrap();
        cases.push(json!({
            "name": name,
            "model": file,
            "take": "take.csv",
            "suggested": suggested.to_string(),
            "state": state.to_string(),
            "learnt": workspace.label_model_json().unwrap(),
            "csv": workspace.labels_csv().unwrap(),
            "timeline": workspace.suggest_expressions("", "", 1.0).unwrap().to_string(),
        }));
    }
    std::fs::write(folder.join("cases.json"), serde_json::to_string(&cases).unwrap()).unwrap();
}

#[test]
fn the_studio_s_module_learns_and_suggests_the_native_bits() {
    let folder = tempfile::tempdir().unwrap();
    write_cases(folder.path());
    let test = "the_studio_s_module_learns_and_suggests_the_native_bits";
    let Some(dist) = web_module(test, "studio") else { return };
    let output = Command::new("node")
        .arg(repository().join("tests/wasm/label_bits.mjs"))
        .args([&dist, folder.path()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    eprintln!("{said}");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "run cargo xtask web if it is old\n{said}{errors}");
}
