//! Labels as the page uses them: a model's suggestions, confirmed, relabelled, moved, learnt from,
//! carried out.

use mimique_annotate::{AnnotatedTake, Decoding, Lesson, Mark, Marked, Method, Take};
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

const RATE_HZ: f64 = 25.0;
const SHAPES: [&str; 3] = ["jawOpen", "mouthSmileLeft", "browDownLeft"];

/// Two seconds each of neutral, smile, frown, smile, neutral; `strength` of the expressions.
fn weights(strength: f64) -> Vec<f64> {
    let faces = [[0.02, 0.0, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let order = [0, 1, 2, 1, 0];
    let ripple = |frame: usize, shape: usize| 0.02 * ((frame * (shape + 3)) as f64 * 0.37).sin();
    let of = |frame: usize| {
        (0..3).map(move |s| strength * faces[order[frame / 50]][s] + ripple(frame, s))
    };
    (0..250).flat_map(of).collect()
}

/// The same as a CSV of weights.
fn csv(strength: f64) -> String {
    let mut text = format!("frame,time,{}\n", SHAPES.join(","));
    for (frame, row) in weights(strength).chunks(3).enumerate() {
        let time = frame as f64 / RATE_HZ;
        text += &format!("{frame},{time},{},{},{}\n", row[0], row[1], row[2]);
    }
    text
}

/// A model that has learnt these five stretches.
fn model() -> String {
    let marked = [0, 1, 2, 1, 0]
        .into_iter()
        .enumerate()
        .map(|(i, label)| Marked { frames: 50 * i..50 * (i + 1), mark: Mark::Stable(label) });
    let annotated = AnnotatedTake {
        name: "posed".to_owned(),
        person: "p1".to_owned(),
        kind: "posed".to_owned(),
        take: Take::new(weights(1.0), 3, RATE_HZ).unwrap(),
        marked: marked.collect(),
    };
    let lesson = Lesson {
        channel: "affect".to_owned(),
        labels: ["neutral", "joy", "anger"].map(str::to_owned).to_vec(),
        shapes: SHAPES.map(str::to_owned).to_vec(),
        method: Method::Knn { k: 5 },
        thinned_to_hz: Some(10.0),
        decoding: Decoding::default(),
    };
    lesson.learn(&[annotated]).unwrap().to_json().unwrap()
}

fn take() -> Workspace {
    let mut workspace = Workspace::new();
    workspace.take_file("sentence.csv", csv(0.9).as_bytes(), None, None).unwrap();
    workspace
}

fn suggested() -> (Workspace, Value) {
    let mut workspace = take();
    workspace.label_model("model.json", &model()).unwrap();
    let state = workspace.suggest_labels("").unwrap();
    (workspace, state)
}

fn labels(state: &Value) -> Vec<(&str, u64, u64, bool)> {
    let boxes = state["boxes"].as_array().unwrap().iter();
    let frame = |own: &Value, end: usize| own["frames"][end].as_u64().unwrap();
    boxes
        .map(|own| {
            let label = own["label"].as_str().unwrap();
            (label, frame(own, 0), frame(own, 1), own["confirmed"].as_bool().unwrap())
        })
        .collect()
}

#[test]
fn a_model_suggests_boxes_with_confidence_and_second_label() {
    let (workspace, state) = suggested();
    let found = labels(&state);
    assert_eq!(found.len(), 5, "{found:?}");
    for ((label, first, end, confirmed), (i, expected)) in
        found.into_iter().zip(["neutral", "joy", "anger", "joy", "neutral"].iter().enumerate())
    {
        assert_eq!(label, *expected);
        assert!(first.abs_diff(50 * i as u64) <= 2 && end.abs_diff(50 * (i as u64 + 1)) <= 2);
        assert!(!confirmed);
    }
    let first = &state["boxes"][1];
    let (own, second) = (&first["probability"], &first["second"]["probability"]);
    assert!(own.as_f64().unwrap() > 0.6 && second.as_f64().unwrap() < own.as_f64().unwrap());
    assert_eq!(state["counts"], json!({"confirmed": 0, "relabelled": 0, "moved": 0}));
    assert_eq!(state["model"]["takes"], json!(["posed"]));
    assert_eq!(state["model"]["holdsFrames"], true, "neighbours are people's frames");
    // Every frame's probabilities add up to one.
    let shares: Vec<Vec<f32>> = (0..3).map(|label| workspace.label_probabilities(label)).collect();
    assert!(shares.iter().all(|own| own.len() == 250));
    assert!((0..250).all(|f| (shares.iter().map(|own| own[f]).sum::<f32>() - 1.0).abs() < 1e-5));
}

#[test]
fn what_is_confirmed_relabelled_or_moved_is_never_overwritten() {
    let (mut workspace, _) = suggested();
    workspace.confirm_label(0).unwrap();
    workspace.relabel(2, "fear").unwrap();
    let state = workspace.move_label(3, 160, 190).unwrap();
    assert_eq!(state["at"], 3);
    assert_eq!(state["counts"], json!({"confirmed": 3, "relabelled": 1, "moved": 1}));
    let truth = |state: &Value| -> Vec<(String, u64, u64)> {
        let own = labels(state).into_iter().filter(|own| own.3);
        own.map(|(label, first, end, _)| (label.to_owned(), first, end)).collect()
    };
    let before = truth(&state);
    assert_eq!(before[1].0, "fear");
    assert_eq!((before[2].1, before[2].2), (160, 190));
    for state in [workspace.suggest_labels("").unwrap(), workspace.learn_labels("").unwrap()] {
        assert_eq!(truth(&state), before);
        let all = labels(&state);
        assert!(all.windows(2).all(|pair| pair[0].2 <= pair[1].1), "boxes are apart: {all:?}");
        assert_eq!(state["counts"], json!({"confirmed": 3, "relabelled": 1, "moved": 1}));
    }
    // The frown is learnt as fear now; anger, of which nothing is left, is suggested nowhere.
    let state = workspace.labels_state();
    assert!(labels(&state).iter().all(|own| own.0 != "anger"), "{state}");
    // A box that is let go is a suggestion again, and goes with the next.
    let state = workspace.release_label(0).unwrap();
    assert_eq!(state["counts"]["confirmed"], 2);
}

#[test]
fn without_a_model_the_confirmed_expressions_are_learnt_from() {
    let mut workspace = take();
    let problem = workspace.suggest_labels("").unwrap_err().to_string();
    assert!(problem.starts_with("labels: no model; open one"), "{problem}");
    let problem = workspace.labels_from_expressions(true).unwrap_err().to_string();
    assert!(problem.contains("no expression; open some"), "{problem}");
    // The first smile and the frown are named by hand; the rest is unsaid.
    workspace
        .set_expressions(
            r#"[{"label": "neutral", "expression": [5, 45]}, {"label": "joy1", "expression": [55, 95]},
                {"label": "anger 1", "expression": [105, 145]}]"#,
        )
        .unwrap();
    let state = workspace.labels_from_expressions(false).unwrap();
    assert_eq!(state["names"], json!(["neutral", "joy", "anger"]));
    assert_eq!(state["counts"]["confirmed"], 3);
    let state = workspace.learn_labels("").unwrap();
    let last: Vec<&str> =
        labels(&state).into_iter().filter(|own| own.1 >= 148).map(|own| own.0).collect();
    assert_eq!(last, ["joy", "neutral"], "{state}");
    assert_eq!(state["learntFromSuggestions"], json!([]));
    // What is learnt here is a model like any other.
    let text = workspace.label_model_json().unwrap();
    let mut other = take();
    other.label_model("learnt.json", &text).unwrap();
    let again = other.suggest_labels("").unwrap();
    assert!(labels(&again).iter().any(|own| own.0 == "anger"));
    // With the rest as neutral nothing is left to suggest.
    let state = workspace.labels_from_expressions(true).unwrap();
    assert!(labels(&state).iter().all(|own| own.3));
    let covered: u64 = labels(&state).iter().map(|own| own.2 - own.1).sum();
    assert_eq!(covered, 250);
}

#[test]
fn a_refit_changes_the_suggestions_that_are_not_confirmed() {
    let (mut workspace, before) = suggested();
    // The annotator calls both smiles' kind surprise: the first is relabelled, the second follows.
    assert_eq!(labels(&before)[3].0, "joy");
    workspace.relabel(1, "surprise").unwrap();
    for confirmed in [0, 2] {
        workspace.confirm_label(confirmed).unwrap();
    }
    workspace.relabel(3, "surprise").unwrap();
    workspace.release_label(3).unwrap();
    let state = workspace.learn_labels("").unwrap();
    assert!(labels(&state).iter().all(|own| own.0 != "joy"), "{state}");
    assert!(labels(&state).iter().any(|own| own.0 == "surprise" && !own.3), "{state}");
}

#[test]
fn labels_go_into_expressions_csv_elan_and_study_segments() {
    let (mut workspace, _) = suggested();
    workspace.confirm_label(1).unwrap();
    let csv = workspace.labels_csv().unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert!(lines[0].starts_with("label,first_frame,last_frame,"), "{csv}");
    assert!(lines[0].ends_with(",end_s,probability,second,second_probability,confirmed"), "{csv}");
    assert_eq!(lines.len(), 6);
    assert!(lines[2].starts_with("joy,") && lines[2].ends_with(",1"), "{csv}");
    assert!(lines.iter().skip(1).all(|l| l.split(',').count() == lines[0].split(',').count()));
    assert!(mimique_stimulus::read_segments(&csv).is_ok(), "{csv}");

    let date = "2026-01-01T00:00:00+00:00";
    let eaf = workspace.labels_eaf(None, date).unwrap();
    let document = mimique_stimulus::EafDocument::parse(&eaf).unwrap();
    let count = |tier: &str| document.tier(tier).unwrap().annotations.len();
    assert_eq!(["labels", "labels (suggested)", "labels (confidence)"].map(count), [1, 4, 4]);
    let confidence = &document.tier("labels (confidence)").unwrap().annotations[0].value;
    assert!(confidence.len() == 4 && confidence.parse::<f64>().is_ok(), "{confidence}");
    // Written into the same document again, every tier stands once.
    let again = workspace.labels_eaf(Some(&eaf), date).unwrap();
    let document = mimique_stimulus::EafDocument::parse(&again).unwrap();
    assert_eq!(document.tiers().len(), 3 + usize::from(document.tier("default").is_some()));

    let told = workspace.labels_to_expressions(true).unwrap();
    assert_eq!(told["segments"].as_array().unwrap().len(), 1);
    let told = workspace.labels_to_expressions(false).unwrap();
    let names: Vec<&str> =
        told["segments"].as_array().unwrap().iter().map(|s| s["label"].as_str().unwrap()).collect();
    assert_eq!(names, ["joy", "anger", "joy"], "the neutral face is no expression");
    let segments: Value = serde_json::from_str(&workspace.study_segments().unwrap()).unwrap();
    let ids: Vec<&str> = segments["segments"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["id"].as_str().unwrap())
        .collect();
    assert_eq!(ids, ["joy", "anger", "joy-2"]);
    assert_eq!(segments["segments"][0]["capture"], "sentence.csv");
}

#[test]
fn another_take_or_model_begins_anew_and_truth_stays_where_it_can() {
    let (mut workspace, _) = suggested();
    workspace.relabel(2, "contempt").unwrap();
    let state = workspace.label_model("model.json", &model()).unwrap();
    assert_eq!(labels(&state).len(), 1, "suggestions go, what is confirmed stays");
    assert_eq!(labels(&state)[0].0, "contempt");
    assert_eq!(state["names"], json!(["neutral", "joy", "anger", "contempt"]));
    workspace.take_file("other.csv", csv(0.8).as_bytes(), None, None).unwrap();
    let state = workspace.labels_state();
    assert_eq!(labels(&state), []);
    assert_eq!(state["names"], json!(["neutral", "joy", "anger"]), "the model stays");
    assert_eq!(workspace.suggest_labels("").unwrap()["boxes"].as_array().unwrap().len(), 5);
}

#[test]
fn what_cannot_be_done_is_said_with_a_remedy() {
    let (mut workspace, _) = suggested();
    for (problem, part) in [
        (workspace.confirm_label(9).unwrap_err(), "labels: box 9 of 5; suggest labels anew"),
        (workspace.relabel(0, "  ").unwrap_err(), "a label without a name; type one"),
        (workspace.move_label(0, 5, 5).unwrap_err(), "frames 5:5 of 250; give a range"),
        (workspace.move_label(0, 5, 251).unwrap_err(), "frames 5:251 of 250"),
        (workspace.label_model("m.json", "{").unwrap_err(), "m.json: model: line 1, column 1"),
    ] {
        assert!(problem.to_string().contains(part), "{problem}");
    }
    workspace.confirm_label(0).unwrap();
    let problem = workspace.move_label(1, 0, 20).unwrap_err();
    assert!(problem.to_string().contains("frames 0:20 are confirmed as others"), "{problem}");
    let other = csv(1.0).replace("jawOpen", "jawLeft");
    workspace.take_file("other.csv", other.as_bytes(), None, None).unwrap();
    let problem = workspace.suggest_labels("").unwrap_err();
    assert!(problem.to_string().contains("\"jawOpen\" is missing"), "{problem}");
    let problem = Workspace::new().learn_labels("").unwrap_err();
    assert!(problem.to_string().contains("solve the capture first"), "{problem}");
}
